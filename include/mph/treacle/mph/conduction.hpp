#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Conduction of heat, by the pairs and the weight of the viscosity. In a full neighbourhood the pairs'
/// coefficients c_ij of d d^T have the sum 2 D (D + 2) of c_ij r^4, and so (c_ij r^2) / (D + 2) has that of a
/// Laplacian,
///   div(k grad T)_i = sum_j kappa_ij (T_j - T_i),   kappa_ij = k_ij (s_i + s_j)/2 c_ij r^2 / (D + 2),
/// symmetric, so that heat is conserved to rounding. k_ij is the harmonic mean, as of two layers. Within a
/// material that freezes it is the mean of k(T) between both temperatures, with which a flux through layers of
/// solid and liquid is what it is by Kirchhoff's transformation. s_i makes up for neighbours that are missing or
/// do not conduct (viscosity_scale.hpp). A wall has its temperature where its surface is, or that far behind it
/// through which its conductance would let the fluid's conductivity conduct; the pair's coefficient is multiplied
/// by wallFactor(), as its viscosity is.

/// What the heat of the fluid meets in a wall body.
struct WallHeat {
  double temperature = 0;  // [K]; 0: adiabatic
  double resistance = 0;   // of the wall, 1 over its conductance [m2 K/W]
};
/// Of the bodies of a case; of those that are fluid nothing is said.
std::vector<WallHeat> wallHeat(const Case& c);

/// Constants of the materials.
struct HeatTable {
  double conductivity[maxMaterials];                    // k [W/(m K)]
  double pairConductivity[maxMaterials][maxMaterials];  // their harmonic means [W/(m K)]
  double capacity[maxMaterials];                        // rho c_p [J/(m3 K)]
  double emissivity[maxMaterials];                      // [-]

  static HeatTable make(const Case& c);
};

/// Where some material freezes: what particles of fluid conduct by their temperatures, those of ghosts included,
/// and the same at walls. Pointers are to the backend's memory.
struct OwnConduction {
  const double* temperature = nullptr;   // T [K]; null: nothing freezes
  const double* conductivity = nullptr;  // k(T) [W/(m K)]
  const double* conducted = nullptr;     // its integral over the temperature [W/m]
  const double* atWalls = nullptr;       // that of material m at the temperature of body b: [b * maxMaterials + m]
  static constexpr double close = 1e-3;  // below this difference of temperatures k is that of one of them [K]
};

/// What the sums of conduction read besides the pairs. Pointers are to the backend's memory.
struct Conduction {
  HeatTable table;
  const WallHeat* walls;     // per body
  const std::uint8_t* body;  // per particle
  const double* scale;       // s per fluid particle, those of ghosts included; null: not made yet
  OwnConduction own{};

  /// Whether a wall particle conducts.
  TREACLE_HD bool conducts(std::uint32_t wall) const { return walls[body[wall]].temperature > 0; }
  /// Over c_ij r^2, of a fluid and a wall particle [W/(m K)]; d = x_wall - x_fluid [m].
  template <int D>
  TREACLE_HD double ofWall(const MphPairs<D>& pairs, std::uint32_t fluid, std::uint32_t wall,
                           const Vec<D>& d) const {
    if (!conducts(wall)) return 0;
    const double k = own.temperature ? ofFreezing(fluid, wall, pairs.material[fluid])
                                     : table.conductivity[pairs.material[fluid]];
    const double behind = k * walls[body[wall]].resistance;
    // Walls without surfaces end where their particles are.
    const double factor = pairs.wallSurface ? treacle::wallFactor(pairs.wallSurface[wall - pairs.fluidCount], d,
                                                                  pairs.spacing, behind)
                                            : norm(d) / (norm(d) + behind);
    return scale[fluid] * k * factor;
  }

 private:
  /// The mean of k between the temperatures of a fluid and a wall particle.
  TREACLE_HD double ofFreezing(std::uint32_t fluid, std::uint32_t wall, std::uint8_t material) const {
    const double difference = walls[body[wall]].temperature - own.temperature[fluid];
    if (std::abs(difference) < OwnConduction::close) return own.conductivity[fluid];
    return (own.atWalls[body[wall] * maxMaterials + material] - own.conducted[fluid]) / difference;
  }
};

/// s_i per own fluid particle, with neighbours that conduct.
template <int D, class Backend>
void conductionScale(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double> scale);

/// What a particle gets per volume is gain - coefficient T.
struct HeatExchange {
  double coefficient;  // [W/(m3 K)]
  double gain;         // [W/m3]
};

/// Per own fluid particle: the sum of kappa over fluid neighbours [W/(m3 K)], and what the walls are to it.
template <int D, class Backend>
void conductionDiagonal(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double> ofFluid,
                        std::span<HeatExchange> ofWalls);

/// y_i = extra_i T_i + sum_j kappa_ij (T_i - T_j) per own fluid particle; T of ghosts, too.
template <int D, class Backend>
void conduct(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<const double> extra,
             std::span<const double> T, std::span<double> y);

}  // namespace treacle
