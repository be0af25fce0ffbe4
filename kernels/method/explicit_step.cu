#include "treacle/method/explicit_step.hpp"

#include "core/launch.hpp"

#include <algorithm>

namespace treacle {

/// One thread per particle; reads n and material, writes its pressure; atomics no.
template <int D>
void elasticPressure(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> n,
                     double restDensity, std::span<double> elastic) {
  forEach(context, elastic.size(),
          [n, restDensity, elastic, table = pairs.materials, material = pairs.material] __device__(std::size_t i) {
            elastic[i] = table.bulkModulus[material[i]] * std::max(n[i] - restDensity, 0.0);
          });
}

/// One thread per fluid particle; reads u and material, writes b; atomics no.
template <int D>
void inertiaAndGravity(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                       const Vec<D>& gravity, std::span<Vec<D>> b) {
  forEach(context, b.size(),
          [u, gravity, b, table = pairs.materials, material = pairs.material] __device__(std::size_t i) {
            const int m = material[i];
            b[i] = table.inertia[m] * u[i] + table.density[m] * gravity;
          });
}

/// One thread per particle; reads div, elastic and material, writes its pressure; atomics no.
template <int D>
void bulkPressure(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure) {
  forEach(context, pressure.size(),
          [div, elastic, pressure, table = pairs.materials, material = pairs.material] __device__(std::size_t i) {
            pressure[i] = table.bulkViscosity[material[i]] * div[i] + (elastic.empty() ? 0.0 : elastic[i]);
          });
}

/// One thread per particle; reads x and u, writes its new place; an atomic maximum for each one that left the
/// domain, of the complement of its index: zero means nobody, and the largest is the first particle.
template <int D>
std::uint32_t moveParticles(Context<Cuda>& context, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved) {
  auto* firstOut = static_cast<std::uint32_t*>(context.scratch(sizeof(std::uint32_t)));
  clearBytes(context, firstOut, sizeof(std::uint32_t));
  forEach(context, moved.size(), [grid, dt, x, u, moved, firstOut] __device__(std::size_t i) {
    Vec<D> place = x[i] + dt * u[i];
    if (!grid.wrap(place)) atomicMax(firstOut, ~static_cast<std::uint32_t>(i));
    moved[i] = place;
  });
  return ~valueOnHost(context, firstOut);
}

template void elasticPressure<2>(Context<Cuda>&, const MphPairs<2>&, std::span<const double>, double,
                                 std::span<double>);
template void elasticPressure<3>(Context<Cuda>&, const MphPairs<3>&, std::span<const double>, double,
                                 std::span<double>);
template void inertiaAndGravity<2>(Context<Cuda>&, const MphPairs<2>&, std::span<const Vec<2>>, const Vec<2>&,
                                   std::span<Vec<2>>);
template void inertiaAndGravity<3>(Context<Cuda>&, const MphPairs<3>&, std::span<const Vec<3>>, const Vec<3>&,
                                   std::span<Vec<3>>);
template void bulkPressure<2>(Context<Cuda>&, const MphPairs<2>&, std::span<const double>, std::span<const double>,
                              std::span<double>);
template void bulkPressure<3>(Context<Cuda>&, const MphPairs<3>&, std::span<const double>, std::span<const double>,
                              std::span<double>);
template std::uint32_t moveParticles<2>(Context<Cuda>&, const CellGrid<2>&, double, std::span<const Vec<2>>,
                                        std::span<const Vec<2>>, std::span<Vec<2>>);
template std::uint32_t moveParticles<3>(Context<Cuda>&, const CellGrid<3>&, double, std::span<const Vec<3>>,
                                        std::span<const Vec<3>>, std::span<Vec<3>>);

}  // namespace treacle
