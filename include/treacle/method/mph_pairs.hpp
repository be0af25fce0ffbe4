#pragma once

#include "treacle/method/sorted_particles.hpp"
#include "treacle/method/weight.hpp"
#include "treacle/model/case.hpp"
#include "treacle/search/cluster_list.hpp"

#include <cstdint>

namespace treacle {

/// Material constants as the pair sums look them up, by material index.
struct MaterialTable {
  int count = 0;
  double density[maxMaterials];                      // rho [kg/m3]
  double inertia[maxMaterials];                      // rho / dt [kg/(m3 s)]
  double bulkViscosity[maxMaterials];                // lambda [Pa s]
  double bulkModulus[maxMaterials];                  // kappa [Pa]
  double pairViscosity[maxMaterials][maxMaterials];  // mu_ij = 2 mu_i mu_j / (mu_i + mu_j) [Pa s]
  double pairMobility[maxMaterials][maxMaterials];   // 4 / (rho_i + rho_j) [m3/kg], of ISPH's pressure equation

  static MaterialTable make(const Case& c);
  void setTimeStep(double dt) {
    for (int m = 0; m < count; ++m) inertia[m] = density[m] / dt;
  }
};

/// What every pair sum of a step reads.
template <int D>
struct MphPairs : SortedParticles<D> {
  ClusterListView fluidList;  // near h_p, far max(h_v, 2 h_p)
  ClusterListView wallList;   // near h_p only
  PeriodicImages<D> images;
  Weight<D> pressureWeight{}, viscosityWeight{};
  PairTerm pressure{}, viscosity{};
  MaterialTable materials;

  TREACLE_HD Vec<D> positionOf(ListEntry e) const { return this->position[e.index()] + images.shift[e.image()]; }
};

/// The constants of a case, without particles.
template <int D>
MphPairs<D> makePairs(const Case& c);

}  // namespace treacle
