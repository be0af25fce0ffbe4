#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/search/particle_sort.hpp"

#include <algorithm>
#include <type_traits>

namespace treacle {

/// Who is whose neighbour: owns the cells, the lists and the constants that the pair sums of a step read.
template <int D, class Backend = Cpu>
class MphNeighbourhood {
 public:
  explicit MphNeighbourhood(const Case& c)
      : pairs_(makeMphPairs<D>(c)),
        useLists_(std::is_same_v<Backend, Cpu> || c.solver.neighbours == NeighbourKind::Lists) {}
  MphNeighbourhood(const MphNeighbourhood&) = delete;

  /// Sorts the particles into cells; of several processes each its own ones, and ghosts of others.
  void sort(Context<Backend>& context, Particles<D, Backend>& particles) {
    sort_.sort(context, pairs_.grid, particles);
  }

  /// Neighbour lists of the sorted particles; pairs() then looks at them until the next sort. On a device the case
  /// may do without lists: pair sums then walk the cell ranges, and the views have clusters but no entries.
  /// `wholeRows`: lists of fluid reach as far as A couples, which only assembling A needs, and not only as far as
  /// pairs act on each other.
  void buildLists(Context<Backend>& context, const Particles<D, Backend>& particles, bool wholeRows = true) {
    sort_.place(particles, pairs_);
    const std::uint32_t fluid = pairs_.fluidCount, ownFluid = pairs_.ownFluid(), ownEnd = pairs_.ownEnd();
    if (!useLists_) {
      pairs_.fluidList = {0, ownFluid};
      pairs_.wallList = {fluid, ownEnd};
      return;
    }
    const double hp = pairs_.terms.pressureRadius, hn = pairs_.terms.densityRadius;
    const double far = std::max({pairs_.terms.viscosityRadius, hn, wholeRows ? 2 * hp : hp});
    buildClusterList<D>(context, pairs_.grid, ranges(), pairs_.position,
                        {0, ownFluid, {hp, far}, false, pairs_.side}, fluidList_);
    buildClusterList<D>(context, pairs_.grid, ranges(), pairs_.position,
                        {fluid, ownEnd, {hp, hn > hp ? hn : 0}, true, pairs_.side}, wallList_);
    pairs_.fluidList = fluidList_.view();
    pairs_.wallList = wallList_.view();
  }

  /// Of the active wall particles, as they are; must outlive the sums of the step. Empty: none is known.
  void setWallSurfaces(std::span<const WallSurface<D>> surfaces) {
    pairs_.wallSurface = surfaces.empty() ? nullptr : surfaces.data();
  }
  /// How walls move in the step, per body, and the body of each particle; must outlive the sums of the step.
  /// Empty: no wall changes its velocity.
  void setWallMotion(std::span<const WallMotion<D>> motion, const std::uint8_t* body) {
    pairs_.wallMotion = motion.empty() ? nullptr : motion.data();
    pairs_.body = body;
  }

  /// slipSides() of all fluid; must outlive the sums of the step.
  void setSlipSides(std::span<const SlipSide<D>> sides) { pairs_.slipSide = sides.data(); }

  /// B per fluid particle; must outlive the sums of the step. Empty: B = I everywhere.
  void setRenormalisation(std::span<const SymmetricBlock<D>> b) {
    pairs_.renormalisation = b.empty() ? nullptr : b.data();
  }

  /// The share of lambda that walls have, per active particle and read for walls alone; must outlive the sums of
  /// the step. Empty: all.
  void setWallShares(std::span<const double> share) { pairs_.wallShare = share.empty() ? nullptr : share.data(); }

  /// Per fluid particle; must outlive the sums of the step. Empty: 1 everywhere.
  void setViscosityScale(std::span<const double> scale) {
    pairs_.viscosityScale = scale.empty() ? nullptr : scale.data();
  }

  /// Viscosities of the particles' own: s_i mu_i per fluid particle, and its class per active particle; must
  /// outlive the sums of the step.
  void setViscosities(std::span<const double> scaled, std::span<const std::uint8_t> classes) {
    setViscosityScale(scaled);
    setViscosityClasses(classes);
  }
  /// The latter; empty: those of the materials.
  void setViscosityClasses(std::span<const std::uint8_t> classes) { pairs_.viscosityClass = classes.data(); }

  /// Of the step at hand [s].
  void setTimeStep(double dt) { pairs_.materials.setTimeStep(dt); }
  /// Bulk constants that the case leaves open (MaterialTable).
  void raiseBulk(const Case& c, const BulkMemory& raised) { pairs_.materials.raiseBulk(c, raised); }

  const MphPairs<D>& pairs() const { return pairs_; }
  const CellGrid<D>& grid() const { return pairs_.grid; }
  const CellRanges<Backend>& ranges() const { return sort_.ranges(); }
  const CellOwners<D>& owners() const { return sort_.owners(); }
  std::size_t bytes() const { return sort_.bytes() + fluidList_.bytes() + wallList_.bytes(); }

 private:
  MphPairs<D> pairs_;
  bool useLists_;
  ParticleSort<D, Backend> sort_;
  ClusterList<Backend> fluidList_, wallList_;
};

}  // namespace treacle
