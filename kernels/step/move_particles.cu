#include "treacle/step/method/move_particles.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per particle; reads x and u, writes its new place; an atomic maximum for each one that left the
/// domain, of the complement of its index: zero means nobody, and the largest is the first particle.
template <int D>
std::uint32_t moveParticles(Context<Cuda>& context, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved) {
  auto* firstOut = static_cast<std::uint32_t*>(context.scratch(sizeof(std::uint32_t)));
  clearBytes(context, firstOut, sizeof(std::uint32_t));
  forEach(context, moved.size(), [grid, dt, x, u, moved, firstOut] __device__(std::size_t i) {
    Vec<D> place;
    if (!moveParticle(grid, dt, x[i], u[i], place)) atomicMax(firstOut, ~static_cast<std::uint32_t>(i));
    moved[i] = place;
  });
  return ~valueOnHost(context, firstOut);
}

template std::uint32_t moveParticles<2>(Context<Cuda>&, const CellGrid<2>&, double, std::span<const Vec<2>>,
                                        std::span<const Vec<2>>, std::span<Vec<2>>);
template std::uint32_t moveParticles<3>(Context<Cuda>&, const CellGrid<3>&, double, std::span<const Vec<3>>,
                                        std::span<const Vec<3>>, std::span<Vec<3>>);

}  // namespace treacle
