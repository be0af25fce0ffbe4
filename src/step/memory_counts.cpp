#include "treacle/step/memory_counts.hpp"

#include "grid_counts.hpp"
#include "starting_part.hpp"
#include "treacle/isph/isph_pairs.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbours.hpp"
#include "treacle/mph/near_products.hpp"
#include "treacle/search/neighbour_rows.hpp"
#include "treacle/search/shared_buckets.hpp"

#include <algorithm>

namespace treacle {
namespace {

/// Neighbours are counted in so many windows at most, of so many particles that follow each other.
constexpr std::uint32_t windows = 128, windowSize = 16 * nearSlice;
static_assert(windowSize % clusterSize == 0);

/// Calls f(first, last) for windows of [begin, end); returns by what counts in them are to be multiplied.
template <class F>
double forEachWindow(std::uint32_t begin, std::uint32_t end, F&& f) {
  const std::uint32_t all = (end - begin + windowSize - 1) / windowSize, step = all / windows + 1;
  std::uint64_t counted = 0;
  for (std::uint32_t w = step / 2; w < all; w += step) {
    const std::uint32_t first = begin + w * windowSize, last = first + std::min(windowSize, end - first);
    f(first, last);
    counted += last - first;
  }
  return counted > 0 ? static_cast<double>(end - begin) / static_cast<double>(counted) : 0;
}

std::uint64_t scaled(std::uint64_t count, double by) {
  return static_cast<std::uint64_t>(static_cast<double>(count) * by);
}

/// What is counted around the particles of a step.
template <int D>
class Counter {
 public:
  Counter(const CellGrid<D>& grid, StartingPart<D>& part) : part_(part), context_(part.context()) {
    part.count(counts_);
    counts_.cells = grid.cellCount();
  }

  MemoryCounts mph(const Case& c, bool wholeRows) {
    MphPairs<D> pairs = makeMphPairs<D>(c);
    part_.place(pairs);
    const double hp = pairs.terms.pressureRadius, hn = pairs.terms.densityRadius, hv = pairs.terms.viscosityRadius;
    const double far = std::max({hv, hn, wholeRows ? 2 * hp : hp});
    const std::uint32_t fluid = pairs.fluidCount, ownFluid = pairs.ownFluid(), ownEnd = pairs.ownEnd();
    Sliced slicedFluid, slicedWalls;
    std::uint64_t gradients = 0, gradientsOfWalls = 0, rows = 0;
    const double ofFluid =
        countLists(pairs, 0, ownFluid, {hp, far}, counts_.fluidLists, [&](const ClusterList<>& list) {
          pairs.fluidList = list.view();
          slicedFluid.add(pairs, list.first, list.last);
          if (wholeRows) gradients += nearEntries(pairs, list.first, list.last);
          if (wholeRows) rows += coupledEntries(pairs, list.first, list.last);
        });
    const double ofWalls = countLists(pairs, fluid, ownEnd, {hp, hn > hp ? hn : 0}, counts_.wallLists,
                                      [&](const ClusterList<>& list) {
                                        pairs.wallList = list.view();
                                        slicedWalls.add(pairs, list.first, list.last);
                                        if (wholeRows)
                                          gradientsOfWalls += nearEntries(pairs, list.first, list.last);
                                      });
    if (c.needsWallNeighbours())
      countLists(pairs, fluid, ownEnd, {std::max(hn, hv), 0}, counts_.wallForceLists, [](const ClusterList<>&) {});
    counts_.nearEntries = scaled(slicedFluid.near, ofFluid) + scaled(slicedWalls.near, ofWalls);
    counts_.stagedEntries = scaled(slicedFluid.staged, ofFluid) + scaled(slicedWalls.staged, ofWalls);
    counts_.gradientEntries = scaled(gradients, ofFluid) + scaled(gradientsOfWalls, ofWalls);
    counts_.rowEntries = scaled(rows, ofFluid);
    const GridCounts<D> grids(c, pairs, part_);
    counts_.pressureGrids = grids.levels(HatsOn::Active, hatReach, 1);
    counts_.fluidGrids = grids.levels(HatsOn::Fluid, 1, D);
    countBuckets(pairs);
    return counts_;
  }

  MemoryCounts isph(const Case& c) {
    IsphPairs<D> pairs = makeIsphPairs<D>(c);
    part_.place(pairs);
    const RowRadii radii{pairs.kernel.radius(), pairs.kernel.radius()};
    const auto count = [&](RowKind kind) {
      const RowSearch search = RowSearch::make<D>(kind, pairs);
      std::uint64_t entries = 0;
      const double by = forEachWindow(search.first, search.first + search.count, [&](auto first, auto last) {
        for (std::uint32_t i = first; i < last; ++i)
          forEachNeighbour<D>(pairs, i, radii, search.walls, [&](std::uint32_t, bool) { ++entries; });
      });
      return scaled(entries, by);
    };
    counts_.fluidOfFluid = count(RowKind::FluidOfFluid);
    counts_.wallsOfFluid = count(RowKind::WallsOfFluid);
    counts_.fluidOfWalls = count(RowKind::FluidOfWalls);
    counts_.fluidGrids = GridCounts<D>(c, pairs, part_).levels(HatsOn::Fluid, 1, 1);
    countBuckets(pairs);
    return counts_;
  }

 private:
  /// Of particles [first, last); `counted` gets the list of each window. Returns by what its counts are to be
  /// multiplied.
  template <class F>
  double countLists(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t last, ListRadii radii,
                    MemoryCounts::Lists& lists, F&& counted) {
    lists.clusters = (last - first + clusterSize - 1) / clusterSize;
    std::array<std::uint64_t, listSegments> entries{};
    const bool walls = first >= pairs.fluidCount;
    const double by = forEachWindow(first, last, [&](std::uint32_t begin, std::uint32_t end) {
      ClusterList<> list;
      buildClusterList<D>(context_, pairs.grid, part_.ranges(), pairs.position, begin, end, radii, walls, list);
      for (std::uint32_t c = 0; c < list.clusterCount(); ++c)
        for (int s = 0; s < listSegments; ++s) entries[s] += list.segment(c, static_cast<ListSegment>(s)).size();
      counted(list);
    });
    for (int s = 0; s < listSegments; ++s) lists.entries[s] = scaled(entries[s], by);
    return by;
  }

  /// Of NearProducts and StagedLists: slices are as long as the longest list in them; walls list fluid alone.
  struct Sliced {
    std::uint64_t near = 0, staged = 0;

    void add(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t last) {
      const double reach = slopeReach(pairs.terms.scheme.kind) * pairs.terms.pressureRadius;
      for (std::uint32_t slice = first; slice < last; slice += nearSlice) {
        Sliced longest;
        for (std::uint32_t i = slice; i < std::min(last, slice + nearSlice); ++i) {
          Sliced own;
          forEachNear(pairs, i, [&](std::uint32_t j, const Vec<D>& d, const Vec<D>&) {
            if (i >= pairs.fluidCount && j >= pairs.fluidCount) return;
            ++own.near;
            own.staged += norm2(d) < reach * reach;
          });
          longest.near = std::max(longest.near, own.near);
          longest.staged = std::max(longest.staged, own.staged);
        }
        near += nearSlice * longest.near;
        staged += nearSlice * ((longest.staged + 3) / 4 * 4);  // in fours
      }
    }
  };
  static std::uint64_t nearEntries(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t last) {
    std::uint64_t entries = 0;
    for (std::uint32_t i = first; i < last; ++i)
      forEachNear(pairs, i, [&](std::uint32_t, const Vec<D>&, const Vec<D>&) { ++entries; });
    return entries;
  }
  static std::uint64_t coupledEntries(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t last) {
    std::uint64_t entries = 0;
    for (std::uint32_t i = first; i < last; ++i)
      for (const ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
        forEachEntry(pairs, i, s,
                     [&](std::uint32_t, const Vec<D>& d) { entries += norm2(d) <= couplingRadius2(pairs); });
    return entries;
  }

  void countBuckets(const SortedParticles<D>& particles) {
    constexpr int cellShift = D * CellGrid<D>::subBits;
    const CellRanges<>& all = part_.rangesOfAll();
    BucketLevels<> levels;
    SharedBuckets<> shared;
    if (context_.communicator)
      findSharedBuckets(context_, particles, part_.ranges().key, shared);
    else
      findBuckets(context_, all.key, cellShift, D, levels);
    const BucketLevels<>& ofAll = context_.communicator ? shared.all : levels;
    for (std::size_t l = 0; l < ofAll.begin.size(); ++l) counts_.buckets.push_back(ofAll.count(l));
    std::vector<std::uint8_t> occupied = occupiedCells(all);
    if (context_.communicator) context_.communicator->anyOf(occupied);
    counts_.bucketEntries = adjacentPairs(particles.grid, occupied);
    if (!counts_.isShared()) return;
    const std::vector<std::uint8_t> held = occupiedCells(part_.ranges());
    counts_.sharing.buckets = static_cast<std::uint64_t>(std::ranges::count(held, 1));
    counts_.sharing.bucketEntries = adjacentPairs(particles.grid, held);
  }

  /// Per cell: whether it has fluid.
  static std::vector<std::uint8_t> occupiedCells(const CellRanges<>& ranges) {
    std::vector<std::uint8_t> occupied(ranges.fluidEnd.size());
    for (std::size_t c = 0; c < occupied.size(); ++c) occupied[c] = ranges.fluidEnd[c] > ranges.fluidBegin[c];
    return occupied;
  }
  static std::uint64_t adjacentPairs(const CellGrid<D>& grid, const std::vector<std::uint8_t>& occupied) {
    std::uint64_t pairs = 0;
    for (std::size_t c = 0; c < occupied.size(); ++c)
      if (occupied[c])
        forEachAdjacentCell(grid, grid.cellAt(c),
                            [&](const Vec<D, int>& cell) { pairs += occupied[grid.linear(cell)]; });
    return pairs;
  }

  StartingPart<D>& part_;
  Context<Cpu>& context_;
  MemoryCounts counts_;
};

template <int D>
CellGrid<D> gridOf(const Case& c) {
  return c.method.kind == MethodKind::Isph ? makeIsphPairs<D>(c).grid : makeMphPairs<D>(c).grid;
}

template <int D>
MemoryCounts countPart(const Case& c, const CellGrid<D>& grid, StartingPart<D>&& part, bool wholeRows) {
  Counter<D> counter(grid, part);
  return c.method.kind == MethodKind::Isph ? counter.isph(c) : counter.mph(c, wholeRows);
}

}  // namespace

std::uint64_t searchCells(const Case& c) {
  return c.dimensions == 2 ? gridOf<2>(c).cellCount() : gridOf<3>(c).cellCount();
}

MemoryCounts countForMemory(const Case& c, const AnyParticles& particles, bool wholeRows) {
  return particles.visit([&]<int D>(const Particles<D>& all) {
    const CellGrid<D> grid = gridOf<D>(c);
    return countPart<D>(c, grid, StartingPart<D>(c, grid, all), wholeRows);
  });
}

MemoryCounts countForMemory(const Case& c, const AnyParticles& part, bool wholeRows,
                            const Communicator& processes) {
  if (processes.size() == 1) return countForMemory(c, part, wholeRows);
  return part.visit([&]<int D>(const Particles<D>& some) {
    const CellGrid<D> grid = gridOf<D>(c);
    return countPart<D>(c, grid, StartingPart<D>(c, grid, some, processes), wholeRows);
  });
}

std::vector<MemoryCounts> countForProcesses(const Case& c, const AnyParticles& particles, bool wholeRows,
                                            int processes, std::size_t most) {
  return particles.visit([&]<int D>(const Particles<D>& all) {
    const CellGrid<D> grid = gridOf<D>(c);
    const StartingPart<D> whole(c, grid, all);
    const StartingWork<D> work(c, grid, whole.ranges(), processes);
    std::vector<MemoryCounts> counts;
    for (const int rank : work.fullest(grid, whole.ranges(), most))
      counts.push_back(countPart<D>(c, grid, StartingPart<D>(whole, grid, work, rank), wholeRows));
    return counts;
  });
}

}  // namespace treacle
