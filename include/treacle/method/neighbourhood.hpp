#pragma once

#include "treacle/method/mph_pairs.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/search/cell_sort.hpp"

namespace treacle {

/// Who is whose neighbour: owns the cells, the lists and the constants that the pair sums of a step read.
template <int D>
class Neighbourhood {
 public:
  explicit Neighbourhood(const Case& c);
  Neighbourhood(const Neighbourhood&) = delete;

  /// Sorts the particles into cells.
  void sort(Context<Cpu>&, Particles<D>& particles);
  /// Neighbour lists of the sorted particles; pairs() then looks at them until the next sort.
  void buildLists(Context<Cpu>&, const Particles<D>& particles);

  const MphPairs<D>& pairs() const { return pairs_; }
  const CellGrid<D>& grid() const { return pairs_.grid; }
  const CellRanges<>& ranges() const { return ranges_; }
  std::size_t bytes() const;

 private:
  MphPairs<D> pairs_;
  CellRanges<> ranges_;
  SortWorkspace<> workspace_;
  ClusterList<> fluidList_, wallList_;
};

}  // namespace treacle
