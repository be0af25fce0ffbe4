#pragma once

#include "treacle/method/weight.hpp"
#include "treacle/model/case.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/cluster_list.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Material constants as the pair sums look them up, by material index.
struct MaterialTable {
  int count = 0;
  double density[maxMaterials];                      // rho [kg/m3]
  double inertia[maxMaterials];                      // rho / dt [kg/(m3 s)]
  double bulkViscosity[maxMaterials];                // lambda [Pa s]
  double bulkModulus[maxMaterials];                  // kappa [Pa]
  double pairViscosity[maxMaterials][maxMaterials];  // mu_ij = 2 mu_i mu_j / (mu_i + mu_j) [Pa s]

  static MaterialTable make(const Case& c);
};

/// What every pair sum of a step reads, in host or device memory. Particles [0, fluidCount) are fluid,
/// [fluidCount, activeCount) the walls near it. Spans and pointers belong to the step's owner.
template <int D>
struct MphPairs {
  std::uint32_t fluidCount = 0, activeCount = 0;
  std::span<const Vec<D>> position;  // [m]
  std::span<const std::uint8_t> material;
  ClusterListView fluidList;  // near h_p, far max(h_v, 2 h_p)
  ClusterListView wallList;   // near h_p only
  CellRangesView cells;
  CellGrid<D> grid;
  PeriodicImages<D> images;
  double spacing = 0;  // l [m]
  Weight<D> pressureWeight{}, viscosityWeight{};
  PairTerm pressure{}, viscosity{};
  MaterialTable materials;

  TREACLE_HD Vec<D> positionOf(ListEntry e) const { return position[e.index()] + images.shift[e.image()]; }
};

/// The constants of a case, without particles.
template <int D>
MphPairs<D> makePairs(const Case& c);

}  // namespace treacle
