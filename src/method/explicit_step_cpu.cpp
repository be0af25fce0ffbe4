#include "treacle/core/parallel.hpp"
#include "treacle/method/explicit_step.hpp"

#include <algorithm>
#include <atomic>

namespace treacle {

template <int D>
void elasticPressure(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const double> n, double restDensity,
                     std::span<double> elastic) {
  parallelFor(elastic.size(), parallelGrain, [&](std::size_t i) {
    elastic[i] = pairs.materials.bulkModulus[pairs.material[i]] * std::max(n[i] - restDensity, 0.0);
  });
}

template <int D>
void inertiaAndGravity(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u, const Vec<D>& gravity,
                       std::span<Vec<D>> b) {
  parallelFor(b.size(), parallelGrain, [&](std::size_t i) {
    const int m = pairs.material[i];
    b[i] = pairs.materials.inertia[m] * u[i] + pairs.materials.density[m] * gravity;
  });
}

template <int D>
void bulkPressure(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure) {
  parallelFor(pressure.size(), parallelGrain, [&](std::size_t i) {
    pressure[i] = pairs.materials.bulkViscosity[pairs.material[i]] * div[i] + (elastic.empty() ? 0.0 : elastic[i]);
  });
}

template <int D>
std::uint32_t moveParticles(Context<Cpu>&, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved) {
  std::atomic<std::uint32_t> firstOut = nobody;
  parallelFor(moved.size(), parallelGrain, [&](std::size_t i) {
    moved[i] = x[i] + dt * u[i];
    if (grid.wrap(moved[i])) return;
    const auto self = static_cast<std::uint32_t>(i);
    std::uint32_t first = firstOut;
    while (self < first && !firstOut.compare_exchange_weak(first, self)) {
    }
  });
  return firstOut;
}

template void elasticPressure<2>(Context<Cpu>&, const MphPairs<2>&, std::span<const double>, double,
                                 std::span<double>);
template void elasticPressure<3>(Context<Cpu>&, const MphPairs<3>&, std::span<const double>, double,
                                 std::span<double>);
template void inertiaAndGravity<2>(Context<Cpu>&, const MphPairs<2>&, std::span<const Vec<2>>, const Vec<2>&,
                                   std::span<Vec<2>>);
template void inertiaAndGravity<3>(Context<Cpu>&, const MphPairs<3>&, std::span<const Vec<3>>, const Vec<3>&,
                                   std::span<Vec<3>>);
template void bulkPressure<2>(Context<Cpu>&, const MphPairs<2>&, std::span<const double>, std::span<const double>,
                              std::span<double>);
template void bulkPressure<3>(Context<Cpu>&, const MphPairs<3>&, std::span<const double>, std::span<const double>,
                              std::span<double>);
template std::uint32_t moveParticles<2>(Context<Cpu>&, const CellGrid<2>&, double, std::span<const Vec<2>>,
                                        std::span<const Vec<2>>, std::span<Vec<2>>);
template std::uint32_t moveParticles<3>(Context<Cpu>&, const CellGrid<3>&, double, std::span<const Vec<3>>,
                                        std::span<const Vec<3>>, std::span<Vec<3>>);

}  // namespace treacle
