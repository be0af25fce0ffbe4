#include "treacle/core/parallel.hpp"
#include "treacle/step/method/move_particles.hpp"

#include <atomic>

namespace treacle {

template <int D>
std::uint32_t moveParticles(Context<Cpu>&, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved) {
  std::atomic<std::uint32_t> firstOut = noParticle;
  parallelFor(moved.size(), parallelGrain, [&](std::size_t i) {
    if (moveParticle(grid, dt, x[i], u[i], moved[i])) return;
    const auto self = static_cast<std::uint32_t>(i);
    std::uint32_t first = firstOut;
    while (self < first && !firstOut.compare_exchange_weak(first, self)) {
    }
  });
  return firstOut;
}

template std::uint32_t moveParticles<2>(Context<Cpu>&, const CellGrid<2>&, double, std::span<const Vec<2>>,
                                        std::span<const Vec<2>>, std::span<Vec<2>>);
template std::uint32_t moveParticles<3>(Context<Cpu>&, const CellGrid<3>&, double, std::span<const Vec<3>>,
                                        std::span<const Vec<3>>, std::span<Vec<3>>);

}  // namespace treacle
