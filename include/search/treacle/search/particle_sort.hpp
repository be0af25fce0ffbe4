#pragma once

#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/decomposition.hpp"
#include "treacle/search/sorted_particles.hpp"

#include <cstddef>

namespace treacle {

/// Makes `sorted` look at particles and the ranges that they were sorted into.
template <int D, class Backend>
void placeSorted(const Particles<D, Backend>& particles, const CellRanges<Backend>& ranges,
                 SortedParticles<D>& sorted) {
  sorted.fluidCount = particles.wallBegin();
  sorted.activeCount = ranges.activeCount;
  sorted.ghostFluid = particles.ghostCount;
  sorted.ghostWalls = ranges.ghostWalls;
  sorted.position = particles.position;
  sorted.material = particles.material;
  sorted.side = particles.has.sides ? particles.side.data() : nullptr;
  sorted.cells = viewOf(ranges);
}

/// The sort of a step: of a simulation that is alone, or of its part where processes share it.
template <int D, class Backend = Cpu>
class ParticleSort {
 public:
  /// Sorts the particles into cells; of several processes each its own ones, and ghosts of others. Errors: those
  /// of sortByCell and Decomposition::sort.
  void sort(Context<Backend>& context, const CellGrid<D>& grid, Particles<D, Backend>& particles) {
    if (context.communicator) return decomposition_.sort(context, grid, particles, ranges_, workspace_);
    sortByCell(context, grid, particles, ranges_, workspace_);
  }

  /// Makes `sorted` look at the particles of the last sort, until the next one.
  void place(const Particles<D, Backend>& particles, SortedParticles<D>& sorted) const {
    placeSorted(particles, ranges_, sorted);
    sorted.owner = decomposition_.cellOwners();
  }

  const CellRanges<Backend>& ranges() const { return ranges_; }
  /// Where processes share the particles.
  const CellOwners<D>& owners() const { return decomposition_.owners(); }
  std::size_t bytes() const { return ranges_.bytes() + workspace_.bytes() + decomposition_.bytes(); }

 private:
  CellRanges<Backend> ranges_;
  SortWorkspace<Backend> workspace_;
  Decomposition<D, Backend> decomposition_;
};

}  // namespace treacle
