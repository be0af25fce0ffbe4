#pragma once

#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <utility>
#include <variant>

namespace treacle {

/// Particles on the host, in two or three dimensions as the case has it.
class AnyParticles {
 public:
  AnyParticles(Particles<2> particles) : held_(std::move(particles)) {}
  AnyParticles(Particles<3> particles) : held_(std::move(particles)) {}
  explicit AnyParticles(int dimensions) {
    if (dimensions == 3) held_.emplace<Particles<3>>();
  }

  int dimensions() const { return held_.index() == 0 ? 2 : 3; }

  /// f(Particles<D>).
  template <class F>
  decltype(auto) visit(F&& f) {
    return std::visit(f, held_);
  }
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit(f, held_);
  }

  ParticleNumbers numbers() const {
    return visit([](const auto& p) { return p.numbers(); });
  }

  /// Errors: std::bad_variant_access for other dimensions.
  template <int D>
  Particles<D>& of() {
    return std::get<Particles<D>>(held_);
  }
  template <int D>
  const Particles<D>& of() const {
    return std::get<Particles<D>>(held_);
  }

 private:
  std::variant<Particles<2>, Particles<3>> held_;
};

}  // namespace treacle
