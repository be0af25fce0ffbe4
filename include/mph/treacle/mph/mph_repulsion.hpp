#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// What keeps close particles apart (docs/solver.md): pairs nearer than r_0 bear the viscous force of a pair that
/// parts to r_0 within a step, along e, equal and opposite. Of the places of the step, so it stands on the
/// right-hand side alone. `rate`: 1/dt [1/s].

/// y_i += force of the repulsion per fluid particle [N/m3], that of walls included.
template <int D, class Backend>
void addRepulsion(Context<Backend>&, const MphPairs<D>&, double rate, std::span<Vec<D>> y);

/// The same per active wall particle: what the fluid does there.
template <int D, class Backend>
void addRepulsionOnWalls(Context<Backend>&, const MphPairs<D>&, double rate, std::span<Vec<D>> y);

/// What it gives to the motion per fluid particle [W/m3], pairs of fluid shared by halves: the sum over the
/// particles has each pair once, but those of walls. u per active particle, walls included.
template <int D, class Backend>
void repulsionPower(Context<Backend>&, const MphPairs<D>&, double rate, std::span<const Vec<D>> u,
                    std::span<double> power);

}  // namespace treacle
