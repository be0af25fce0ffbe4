#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/isph/isph_pairs.hpp"
#include "treacle/isph/isph_particles.hpp"

namespace treacle {

// isph_particles.hpp for the sources of both backends, which instantiate it. A thread of a device has one
// particle; there are no atomics but those of the reductions.

template <class Backend>
void addPressures(Context<Backend>& context, std::span<const double> p, std::span<const double> q,
                  std::span<double> sum) {
  forEach(context, sum.size(), [=] TREACLE_HD(std::size_t i) { sum[i] = p[i] + q[i]; });
}

template <class Backend>
void settlePressure(Context<Backend>& context, std::span<const std::uint8_t> surface, const double* outside,
                    bool cut, std::span<double> p) {
  forEach(context, p.size(), [=] TREACLE_HD(std::size_t i) {
    const double around = outside ? outside[i] : 0;
    if (surface[i] == Place::Free)
      p[i] = around;
    else if (cut && p[i] < 0 && p[i] < around)
      p[i] = 0;
  });
}

template <int D, class Backend>
void shiftedVelocity(Context<Backend>& context, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport) {
  forEach(context, transport.size(), [=] TREACLE_HD(std::size_t i) {
    transport[i] = surface[i] ? velocity[i] : shiftedVelocity(shifting, deficit[i], velocity[i]);
  });
}

template <int D, class Backend>
void limitTransport(Context<Backend>& context, double spacing, double timeStep, std::span<const Vec<D>> velocity,
                    std::span<Vec<D>> transport) {
  forEach(context, transport.size(), [=] TREACLE_HD(std::size_t i) {
    const Vec<D> way = timeStep * (transport[i] - velocity[i]);
    transport[i] = velocity[i] + (1 / timeStep) * limitedShift(way, spacing);
  });
}

template <int D, class Backend>
void takeComponent(Context<Backend>& context, std::span<const Vec<D>> v, int k, std::span<double> x) {
  forEach(context, x.size(), [=] TREACLE_HD(std::size_t i) { x[i] = v[i][k]; });
}

template <int D, class Backend>
void putComponent(Context<Backend>& context, std::span<const double> x, int k, std::span<Vec<D>> v) {
  forEach(context, x.size(), [=] TREACLE_HD(std::size_t i) { v[i][k] = x[i]; });
}

#define TREACLE_EACH_NUMBER(Backend)                                                                  \
  template void addPressures(Context<Backend>&, std::span<const double>, std::span<const double>,     \
                             std::span<double>);                                                      \
  template void settlePressure(Context<Backend>&, std::span<const std::uint8_t>, const double*, bool, \
                               std::span<double>);
#define TREACLE_EACH_VECTOR(D, Backend)                                                                        \
  template void shiftedVelocity(Context<Backend>&, const Shifting&, std::span<const Vec<D>>,                   \
                                std::span<const std::uint8_t>, std::span<const Vec<D>>, std::span<Vec<D>>);    \
  template void limitTransport(Context<Backend>&, double, double, std::span<const Vec<D>>, std::span<Vec<D>>); \
  template void takeComponent(Context<Backend>&, std::span<const Vec<D>>, int, std::span<double>);             \
  template void putComponent(Context<Backend>&, std::span<const double>, int, std::span<Vec<D>>);

}  // namespace treacle
