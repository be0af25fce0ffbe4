#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/materials/material_table.hpp"
#include "treacle/search/sorted_particles.hpp"

namespace treacle {

/// What of a particle's material takes part in a pair: today the index of the material.
using Substance = std::uint8_t;

/// Sorted particles with the constants of their materials. Loops ask here, not in the table, what a particle has.
template <int D>
struct MaterialParticles : SortedParticles<D> {
  MaterialTable materials;

  TREACLE_HD double density(std::uint32_t i) const { return materials.density[this->material[i]]; }
  TREACLE_HD double inertia(std::uint32_t i) const { return materials.inertia[this->material[i]]; }
  TREACLE_HD double bulkModulus(std::uint32_t i) const { return materials.bulkModulus[this->material[i]]; }

  TREACLE_HD Substance substance(std::uint32_t i) const { return this->material[i]; }
  /// mu_ij of a pair whose particles have the viscosities of their materials [Pa s]
  TREACLE_HD double viscosity(Substance a, Substance b) const { return materials.pairViscosity[a][b]; }
  TREACLE_HD double pairViscosity(std::uint32_t i, std::uint32_t j) const {
    return viscosity(substance(i), substance(j));
  }

  /// Whether all pairs have the same viscosity, and which.
  TREACLE_HD bool isOneSubstance() const { return materials.count == 1; }
  TREACLE_HD double onlyViscosity() const { return materials.pairViscosity[0][0]; }
};

}  // namespace treacle
