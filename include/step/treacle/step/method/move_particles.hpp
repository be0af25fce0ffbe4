#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What moveParticles returns where all stay inside.
inline constexpr std::uint32_t noParticle = ~std::uint32_t{0};

/// moved_i = x_i + dt u_i [K23 eq. (15)] for all particles of the span, brought back into periodic domains.
/// Returns the first particle that left an open one (or is not finite), or `noParticle`.
template <int D, class Backend>
std::uint32_t moveParticles(Context<Backend>&, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved);

/// The formula, for one particle: whether it is still inside.
template <int D>
TREACLE_HD bool moveParticle(const CellGrid<D>& grid, double dt, const Vec<D>& x, const Vec<D>& u, Vec<D>& moved) {
  moved = x + dt * u;
  return grid.wrap(moved);
}

}  // namespace treacle
