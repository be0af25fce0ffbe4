#pragma once

#include "treacle/core/symmetric_block.hpp"
#include "treacle/model/case.hpp"
#include "treacle/mph/mph_terms.hpp"
#include "treacle/mph/wall_surfaces.hpp"
#include "treacle/search/cluster_list.hpp"
#include "treacle/search/material_particles.hpp"

#include <cstdint>

namespace treacle {

/// What every pair sum of a step reads.
template <int D>
struct MphPairs : MaterialParticles<D> {
  ClusterListView fluidList;  // near h_p, far h_v or, to assemble A, 2 h_p if that is more
  ClusterListView wallList;   // near h_p only
  PeriodicImages<D> images;
  MphTerms<D> terms{};     // lengths in metres
  double restDensity = 0;  // n_0 [-]
  const WallSurface<D>* wallSurface =
      nullptr;  // of the first wall particle; null: the fluid meets walls as they are
  const SymmetricBlock<D>* renormalisation = nullptr;  // B per fluid particle (renormalisation.hpp); null: I

  TREACLE_HD Vec<D> positionOf(ListEntry e) const { return this->position[e.index()] + images.shift[e.image()]; }

  /// B_k v: by B the k-th column of C and row of C^T are multiplied, G_k to B_k G_k, wherever they are needed. A
  /// wall's is the unit matrix.
  TREACLE_HD Vec<D> corrected(std::uint32_t k, const Vec<D>& v) const {
    return renormalisation && k < this->fluidCount ? renormalisation[k] * v : v;
  }

  /// By what the viscosity of fluid particle i with wall particle j is multiplied; d = x_j - x_i [m].
  TREACLE_HD double wallFactor(std::uint32_t i, std::uint32_t j, const Vec<D>& d) const {
    if (!wallSurface) return 1;
    return treacle::wallFactor(wallSurface[j - this->fluidCount], d, this->spacing,
                               this->materials.slipLength[this->material[i]]);
  }
};

/// f.operator()<Renormalised>(), for loops that would have to ask for B pair by pair, and whose roundings depend
/// on what else they could compute.
template <int D, class F>
void withRenormalisation(const MphPairs<D>& pairs, F&& f) {
  pairs.renormalisation ? f.template operator()<true>() : f.template operator()<false>();
}

/// The constants of a case, without particles.
template <int D>
MphPairs<D> makeMphPairs(const Case& c);

}  // namespace treacle
