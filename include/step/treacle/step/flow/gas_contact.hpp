#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/vec.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What a particle near a pocket has to do with its gas.
template <int D>
struct GasContact {
  std::uint32_t particle, pocket;
  Vec<D> area;   // force on the particle over the pressure of the pocket, away from the gas [m2; m in 2D]
  double share;  // I of docs/gas.md where it is: 1 at the surface of the pocket

  /// Whether it is within some three spacings of the surface.
  TREACLE_HD bool isNear() const { return share > 0.05; }
};

/// force_i += p area / volume of the contacts, whose particles are fluid and stand there once [N/m3]. `pressure`:
/// of pockets [Pa]; `volume`: of a particle. All spans in the backend's memory.
template <int D, class Backend>
void addGasForces(Context<Backend>&, std::span<const GasContact<D>> contacts, std::span<const double> pressure,
                  double volume, std::span<Vec<D>> force);

/// outside_i = pressure of the pocket, for particles of the contacts that are near [Pa].
template <int D, class Backend>
void setOutside(Context<Backend>&, std::span<const GasContact<D>> contacts, std::span<const double> pressure,
                std::span<double> outside);

/// Sum of area . u over the contacts of a pocket, those of all processes: the rate of its volume [m3/s; m2/s in
/// 2D].
template <int D, class Backend>
double gasRate(Context<Backend>&, std::span<const GasContact<D>> contacts, std::uint32_t pocket,
               std::span<const Vec<D>> u);

}  // namespace treacle
