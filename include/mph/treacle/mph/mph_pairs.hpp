#pragma once

#include "treacle/core/symmetric_block.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/seen_face.hpp"
#include "treacle/mph/mph_terms.hpp"
#include "treacle/mph/slip_side.hpp"
#include "treacle/mph/viscosity_classes.hpp"
#include "treacle/search/cluster_list.hpp"
#include "treacle/search/material_particles.hpp"

#include <cstdint>
#include <stdexcept>

namespace treacle {

/// What of a particle decides on the viscosity of a pair. Of walls the scale is 0: they have what the fluid has.
struct ViscousSide {
  Substance substance;
  double scale;
};

/// The share of its lambda that a particle has: fluid all, which B leaves out next to gaps, and walls what
/// letWallsYield() left them.
struct BulkShare {
  const double* ofWalls = nullptr;  // per active particle, and read for walls alone; null: all
  std::uint32_t fluidCount = 0;

  TREACLE_HD double of(std::size_t i) const { return ofWalls && i >= fluidCount ? ofWalls[i] : 1; }
};

/// What every pair sum of a step reads.
template <int D>
struct MphPairs : MaterialParticles<D> {
  ClusterListView fluidList;  // near h_p, far h_v, h_n or, to assemble A, 2 h_p, whichever is most
  ClusterListView wallList;   // near h_p, far h_n if that is more
  MphTerms<D> terms{};        // lengths in metres
  double restDensity = 0;     // n_0 [-]
  double wideScale = 0;       // of sums of MphTerms::openness, to be 1 in a full lattice
  double background = 0;      // pressure of fluid of density n_0 [Pa]
  double tensionLimit = 0;    // elastic pressures are never below minus this [Pa]
  const SymmetricBlock<D>* renormalisation = nullptr;  // B per fluid particle (renormalisation.hpp); null: I
  const double* wallShare = nullptr;                   // BulkShare::ofWalls
  const double* viscosityScale = nullptr;              // per fluid particle (viscosity_scale.hpp); null: 1
  // Whether particles have viscosities of their own (particle_viscosity.hpp): the scale is then times mu [Pa s],
  // and the viscosities of the materials are all 1.
  bool ownViscosities = false;
  bool smoothWalls = false;               // Case::hasSmoothWalls
  const SlipSide<D>* slipSide = nullptr;  // per fluid particle (slipSides()); null: each pair by its face
  ViscosityClasses classes;
  const std::uint8_t* viscosityClass = nullptr;  // per particle; null: the materials

  /// lambda [Pa s]
  TREACLE_HD double bulkViscosity(std::uint32_t i) const {
    return this->materials.bulkViscosity[this->material[i]] * bulkShare().of(i);
  }
  TREACLE_HD BulkShare bulkShare() const { return {wallShare, this->fluidCount}; }

  /// n where the pressure of particle i is zero [-].
  TREACLE_HD double densityWithoutPressure(std::uint32_t i) const {
    return background > 0 ? restDensity - background / this->bulkModulus(i) : restDensity;
  }

  /// By what sums of MphTerms::openness are multiplied.
  TREACLE_HD double opennessFactor() const { return terms.densityFactor / (restDensity * this->spacing); }

  /// x_j - x_i at the nearest images [m].
  TREACLE_HD Vec<D> difference(std::uint32_t i, std::uint32_t j) const {
    return this->grid.difference(this->position[i], this->position[j]);
  }

  /// B_k v: by B the k-th column of C and row of C^T are multiplied, G_k to B_k G_k, wherever they are needed. A
  /// wall's is the unit matrix.
  TREACLE_HD Vec<D> corrected(std::uint32_t k, const Vec<D>& v) const {
    return renormalisation && k < this->fluidCount ? renormalisation[k] * v : v;
  }

  TREACLE_HD ViscousSide viscousSide(std::uint32_t i) const {
    return {this->substance(i), !viscosityScale ? 1.0 : i < this->fluidCount ? viscosityScale[i] : 0.0};
  }
  /// The mean of two scales, of a wall and a fluid particle the latter's.
  template <class T>
  TREACLE_HD static T meanScale(T a, T b) {
    const T share = a > 0 && b > 0 ? T(0.5) : T(1);
    return share * (a + b);
  }
  /// mu_ij of a pair with the mean of both scales [Pa s]. Particles with viscosities of their own meet as two
  /// layers do where their materials are others, and with the mean inside of one (docs/rheology.md).
  template <class T = double>
  TREACLE_HD T viscosityOf(const ViscousSide& a, const ViscousSide& b) const {
    if (ownViscosities && a.substance != b.substance && a.scale > 0 && b.scale > 0)
      return static_cast<T>(2 * a.scale * b.scale / (a.scale + b.scale));
    return static_cast<T>(this->viscosity(a.substance, b.substance)) *
           meanScale(static_cast<T>(a.scale), static_cast<T>(b.scale));
  }
  TREACLE_HD double viscosityOf(std::uint32_t i, std::uint32_t j) const {
    return viscosityOf(viscousSide(i), viscousSide(j));
  }
  /// Whether all pairs have the viscosity onlyViscosity().
  TREACLE_HD bool hasOneViscosity() const { return this->isOneSubstance() && !viscosityScale; }

  /// Of the preconditioner's constants, per particle: viscosityClass, or the index of the material.
  TREACLE_HD const std::uint8_t* classOf() const {
    return viscosityClass ? viscosityClass : this->material.data();
  }
  /// Whether all particles have those of class 0.
  TREACLE_HD bool isOneClass() const { return this->isOneSubstance() && !viscosityClass; }

  /// By what the viscosity of fluid particle i with wall particle j is multiplied; d = x_j - x_i [m].
  TREACLE_HD double wallFactor(std::uint32_t i, std::uint32_t j, const Vec<D>& d) const {
    if (!this->wallSurface) return 1;
    return ownShareAtWall(i, j) * treacle::wallFactor(this->surfaceOf(j), d, this->spacing,
                                                      this->materials.slipLength[this->material[i]]);
  }
  /// The part of it that is not the walls' places: a surface holds each fluid by the viscosity of this fluid,
  /// whatever the wall is made of.
  TREACLE_HD double ownShareAtWall(std::uint32_t i, std::uint32_t j) const {
    const Substance fluid = this->substance(i), wall = this->substance(j);
    if (!this->wallSurface || ownViscosities || fluid == wall) return 1;
    const double mean = this->viscosity(fluid, wall);
    return mean > 0 ? this->viscosity(fluid, fluid) / mean : 1;
  }

  /// Whether some pair may have a part that alongWall() takes out.
  TREACLE_HD bool slips() const { return smoothWalls && this->wallSurface; }
  /// What does not act of a vector v of fluid particle i and wall particle j, d = x_j - x_i [m], in products with
  /// C and C^T: the part along the wall's surface, where the fluid has a slip length. A wall presses across its
  /// surface, and along it fluid flows freely, but its particles are points, on which fluid that slips would rub
  /// as on a rough plate. Fluid that does not slip stands still there.
  TREACLE_HD Vec<D> alongWall(std::uint32_t i, std::uint32_t j, const Vec<D>& d, const Vec<D>& v) const {
    if (!(this->materials.slipLength[this->material[i]] > 0)) return {};
    const SeenFace<D> face = seenFace(this->surfaceOf(j), d);
    if (!face.exists()) return {};
    return slipSide ? slipSide[i].along(v) : v - face.across(v);
  }
};

/// f.operator()<Renormalised>(), for loops that would have to ask for B pair by pair, and whose roundings depend
/// on what else they could compute.
template <int D, class F>
void withRenormalisation(const MphPairs<D>& pairs, F&& f) {
  pairs.renormalisation ? f.template operator()<true>() : f.template operator()<false>();
}

/// f(terms, whether they have B) for sums whose compiler knows both: B belongs to the accurate scheme. Errors:
/// std::logic_error for pairs of the accurate scheme whose B is not known yet.
template <int D, class F>
void withSchemeTerms(const MphPairs<D>& pairs, F&& f) {
  const bool published = pairs.terms.scheme.kind == SchemeKind::Published;
  if (published == (pairs.renormalisation != nullptr)) throw std::logic_error("B is not that of the scheme");
  published ? f(pairs.terms.with(PublishedScheme{}), std::false_type{})
            : f(pairs.terms.with(AccurateScheme{}), std::true_type{});
}

/// The constants of a case, without particles.
template <int D>
MphPairs<D> makeMphPairs(const Case& c);

}  // namespace treacle
