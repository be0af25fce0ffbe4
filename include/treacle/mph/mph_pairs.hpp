#pragma once

#include "treacle/model/case.hpp"
#include "treacle/mph/mph_terms.hpp"
#include "treacle/search/cluster_list.hpp"
#include "treacle/search/material_particles.hpp"

#include <cstdint>

namespace treacle {

/// What every pair sum of a step reads.
template <int D>
struct MphPairs : MaterialParticles<D> {
  ClusterListView fluidList;  // near h_p, far max(h_v, 2 h_p)
  ClusterListView wallList;   // near h_p only
  PeriodicImages<D> images;
  MphTerms<D> terms{};     // lengths in metres
  double restDensity = 0;  // n_0 [-]

  TREACLE_HD Vec<D> positionOf(ListEntry e) const { return this->position[e.index()] + images.shift[e.image()]; }
};

/// The constants of a case, without particles.
template <int D>
MphPairs<D> makeMphPairs(const Case& c);

}  // namespace treacle
