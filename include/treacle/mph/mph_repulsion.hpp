#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// What keeps close particles apart (docs/solver.md): pairs nearer than r_0 bear the viscous force of a pair that
/// parts to r_0 within a step, along e, equal and opposite. Pairs that hold pressures below zero, tensions t, bear
/// besides that (t_i + t_j) MphTerms::tensionShape, for the particles of a fluid that is pulled gather otherwise
/// [J. J. Monaghan, J. Comput. Phys. 159, 2000]; of the tensions that counts which parts a pair by some hundredths
/// of its distance in a step. Of the places of the step, so it stands on the right-hand side alone.
struct PairsApart {
  double rate;                        // 1/dt [1/s]
  std::span<const double> held = {};  // pressures per active particle [Pa]; empty: they hold none

  /// Of the viscosity, times the rate, the most that tensions count.
  static constexpr double mostTension = 0.2;

  TREACLE_HD double tension(std::uint32_t i) const { return held.empty() || held[i] > 0 ? 0 : -held[i]; }
};

/// y_i += force of the repulsion per fluid particle [N/m3], that of walls included.
template <int D>
void addRepulsion(Context<Cpu>&, const MphPairs<D>&, const PairsApart& apart, std::span<Vec<D>> y);
template <int D>
void addRepulsion(Context<Cuda>&, const MphPairs<D>&, const PairsApart& apart, std::span<Vec<D>> y);

/// The same per active wall particle: what the fluid does there.
template <int D>
void addRepulsionOnWalls(Context<Cpu>&, const MphPairs<D>&, const PairsApart& apart, std::span<Vec<D>> y);
template <int D>
void addRepulsionOnWalls(Context<Cuda>&, const MphPairs<D>&, const PairsApart& apart, std::span<Vec<D>> y);

/// What it gives to the motion per fluid particle [W/m3], pairs of fluid shared by halves: the sum over the
/// particles has each pair once, but those of walls. u per active particle, walls included.
template <int D>
void repulsionPower(Context<Cpu>&, const MphPairs<D>&, const PairsApart& apart, std::span<const Vec<D>> u,
                    std::span<double> power);
template <int D>
void repulsionPower(Context<Cuda>&, const MphPairs<D>&, const PairsApart& apart, std::span<const Vec<D>> u,
                    std::span<double> power);

}  // namespace treacle
