#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/decomposition.hpp"

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
    if (context.communicator) return decomposition_.sort(context, pairs_.grid, particles, ranges_, workspace_);
    sortByCell(context, pairs_.grid, particles, ranges_, workspace_);
  }

  /// Neighbour lists of the sorted particles; pairs() then looks at them until the next sort. On a device the case
  /// may do without lists: pair sums then walk the cell ranges, and the views have clusters but no entries.
  /// `wholeRows`: lists of fluid reach as far as A couples, which only assembling A needs, and not only as far as
  /// pairs act on each other.
  void buildLists(Context<Backend>& context, const Particles<D, Backend>& particles, bool wholeRows = true) {
    const std::uint32_t fluid = particles.wallBegin();
    pairs_.fluidCount = fluid;
    pairs_.activeCount = ranges_.activeCount;
    pairs_.ghostFluid = particles.ghostCount;
    pairs_.ghostWalls = ranges_.ghostWalls;
    const std::uint32_t ownFluid = pairs_.ownFluid(), ownEnd = pairs_.ownEnd();
    pairs_.position = particles.position;
    pairs_.material = particles.material;
    pairs_.cells = viewOf(ranges_);
    if (!useLists_) {
      pairs_.fluidList = {0, ownFluid};
      pairs_.wallList = {fluid, ownEnd};
      return;
    }
    const double hp = pairs_.terms.pressureRadius, hn = pairs_.terms.densityRadius;
    const double far = std::max({pairs_.terms.viscosityRadius, hn, wholeRows ? 2 * hp : hp});
    buildClusterList<D>(context, pairs_.grid, ranges_, pairs_.position, 0, ownFluid, {hp, far}, false, fluidList_);
    buildClusterList<D>(context, pairs_.grid, ranges_, pairs_.position, fluid, ownEnd, {hp, hn > hp ? hn : 0},
                        true, wallList_);
    pairs_.fluidList = fluidList_.view();
    pairs_.wallList = wallList_.view();
  }

  /// Of the active wall particles, as they are; must outlive the sums of the step. Empty: none is known.
  void setWallSurfaces(std::span<const WallSurface<D>> surfaces) {
    pairs_.wallSurface = surfaces.empty() ? nullptr : surfaces.data();
  }

  /// B per fluid particle; must outlive the sums of the step. Empty: B = I everywhere.
  void setRenormalisation(std::span<const SymmetricBlock<D>> b) {
    pairs_.renormalisation = b.empty() ? nullptr : b.data();
  }

  /// Per fluid particle; must outlive the sums of the step. Empty: 1 everywhere.
  void setViscosityScale(std::span<const double> scale) {
    pairs_.viscosityScale = scale.empty() ? nullptr : scale.data();
  }

  /// Of the step at hand [s].
  void setTimeStep(double dt) { pairs_.materials.setTimeStep(dt); }

  const MphPairs<D>& pairs() const { return pairs_; }
  const CellGrid<D>& grid() const { return pairs_.grid; }
  const CellRanges<Backend>& ranges() const { return ranges_; }
  std::size_t bytes() const {
    return ranges_.bytes() + workspace_.bytes() + decomposition_.bytes() + fluidList_.bytes() + wallList_.bytes();
  }

 private:
  MphPairs<D> pairs_;
  bool useLists_;
  CellRanges<Backend> ranges_;
  SortWorkspace<Backend> workspace_;
  Decomposition<D, Backend> decomposition_;
  ClusterList<Backend> fluidList_, wallList_;
};

}  // namespace treacle
