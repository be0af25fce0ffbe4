#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/state/bulk_memory.hpp"

#include <cstddef>

namespace treacle {

/// Material constants as the pair sums look them up, by material index.
struct MaterialTable {
  int count = 0;
  double density[maxMaterials];                      // rho [kg/m3]
  double inertia[maxMaterials];                      // rho / dt [kg/(m3 s)]
  double bulkViscosity[maxMaterials];                // lambda [Pa s]
  double bulkModulus[maxMaterials];                  // kappa [Pa]
  double slipLength[maxMaterials];                   // [m]
  double pairViscosity[maxMaterials][maxMaterials];  // mu_ij = 2 mu_i mu_j / (mu_i + mu_j) [Pa s]
  double pairMobility[maxMaterials][maxMaterials];   // 4 / (rho_i + rho_j) [m3/kg], of ISPH's pressure equation

  double viscosity(int m) const { return pairViscosity[m][m]; }  // mu [Pa s]

  static MaterialTable make(const Case& c);
  void setTimeStep(double dt) {
    for (int m = 0; m < count; ++m) inertia[m] = density[m] / dt;
  }
  /// Of the materials of which the case leaves lambda and kappa open.
  void raiseBulk(const Case& c, const BulkMemory& raised) {
    for (int m = 0; m < count; ++m) {
      const Material& material = c.materials[static_cast<std::size_t>(m)];
      if (!material.hasOpenBulk()) continue;
      bulkViscosity[m] = raised.viscosity * material.bulkViscosity;
      bulkModulus[m] = raised.modulusOfAll() * material.bulkModulus;
    }
  }
};

}  // namespace treacle
