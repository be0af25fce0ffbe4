#include "treacle/step/any_simulation.hpp"

#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/checks.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

namespace treacle {

struct AnySimulation::Held {
#ifdef TREACLE_HAS_CUDA
  std::variant<Simulation<2, Cpu>, Simulation<3, Cpu>, Simulation<2, Cuda>, Simulation<3, Cuda>> simulation;
#else
  std::variant<Simulation<2, Cpu>, Simulation<3, Cpu>> simulation;
#endif

  template <class F>
  decltype(auto) visit(F&& f) {
    return std::visit(f, simulation);
  }

  /// The one place where a case becomes a simulation of some dimensions on some backend.
  static Held of(const Case& c, AnyParticles& particles, [[maybe_unused]] BackendKind backend, std::int64_t step,
                 double time) {
    return particles.visit([&]<int D>(Particles<D>& p) -> Held {
#ifdef TREACLE_HAS_CUDA
      if (backend == BackendKind::Cuda) return {Simulation<D, Cuda>(c, std::move(p), step, time)};
#endif
      return {Simulation<D, Cpu>(c, std::move(p), step, time)};
    });
  }
};

AnySimulation::AnySimulation(const Case& c, AnyParticles particles, BackendKind backend, std::int64_t step,
                             double time) {
  requireValid(c);
  if (particles.dimensions() != c.dimensions)
    throw InputError(
        fmt::format("the case has {} dimensions, its particles {}", c.dimensions, particles.dimensions()));
  if (backend == BackendKind::Cuda && !cudaCompiled)
    throw InputError("this program was built without CUDA; expected the CPU as backend");
  held_ = std::make_unique<Held>(Held::of(c, particles, backend, step, time));
}

AnySimulation::~AnySimulation() = default;
AnySimulation::AnySimulation(AnySimulation&&) noexcept = default;

StepReport AnySimulation::advance() {
  return held_->visit([](auto& s) { return s.advance(); });
}

std::vector<SolverTrial> AnySimulation::convergence(std::span<const SolverSettings> solvers) {
  return held_->visit([&](auto& s) { return s.convergence(solvers); });
}

void AnySimulation::copyParticles(AnyParticles& host) const {
  held_->visit([&]<int D, class Backend>(Simulation<D, Backend>& s) {
    if (host.dimensions() != D) host = AnyParticles(D);
    s.copyParticles(host.of<D>());
  });
}

ParticleNumbers AnySimulation::numbers() const {
  return held_->visit([](auto& s) { return s.numbers(); });
}

double AnySimulation::time() const {
  return held_->visit([](auto& s) { return s.time(); });
}
std::int64_t AnySimulation::step() const {
  return held_->visit([](auto& s) { return s.step(); });
}
std::size_t AnySimulation::bytes() const {
  return held_->visit([](auto& s) { return s.bytes(); });
}
std::size_t AnySimulation::peakBytes() const {
  return held_->visit([](auto& s) { return s.peakBytes(); });
}

}  // namespace treacle
