#include "treacle/step/memory_counts.hpp"

#include "moving_bodies.hpp"
#include "treacle/isph/isph_pairs.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbours.hpp"
#include "treacle/mph/near_products.hpp"
#include "treacle/precondition/hat_grid.hpp"
#include "treacle/search/buckets.hpp"
#include "treacle/search/neighbour_rows.hpp"
#include "treacle/step/near_blocks.hpp"

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

/// Sorted particles of a case, and what is counted around them.
template <int D>
class Counter {
 public:
  Counter(const Case& c, const CellGrid<D>& grid, const Particles<D>& particles)
      : particles_(startingParticles(c, grid, particles)) {
    sortByCell(context_, grid, particles_, ranges_, workspace_);
    counts_.particles = particles.numbers();
    counts_.nearWalls = particles_.wallCount();
    counts_.active = ranges_.activeCount;
    counts_.cells = grid.cellCount();
    counts_.wallsMove = someWallMoves(c, particles_);
  }

  MemoryCounts mph(const Case& c, bool wholeRows) {
    MphPairs<D> pairs = makeMphPairs<D>(c);
    describe(pairs);
    const double hp = pairs.terms.pressureRadius, hn = pairs.terms.densityRadius, hv = pairs.terms.viscosityRadius;
    const double far = std::max({hv, hn, wholeRows ? 2 * hp : hp});
    const std::uint32_t fluid = pairs.fluidCount, active = pairs.activeCount;
    Sliced slicedFluid, slicedWalls;
    std::uint64_t gradients = 0, gradientsOfWalls = 0, rows = 0;
    const double ofFluid =
        countLists(pairs, 0, fluid, {hp, far}, counts_.fluidLists, [&](const ClusterList<>& list) {
          pairs.fluidList = list.view();
          slicedFluid.add(pairs, list.first, list.last);
          if (wholeRows) gradients += nearEntries(pairs, list.first, list.last);
          if (wholeRows) rows += coupledEntries(pairs, list.first, list.last);
        });
    const double ofWalls = countLists(pairs, fluid, active, {hp, hn > hp ? hn : 0}, counts_.wallLists,
                                      [&](const ClusterList<>& list) {
                                        pairs.wallList = list.view();
                                        slicedWalls.add(pairs, list.first, list.last);
                                        if (wholeRows)
                                          gradientsOfWalls += nearEntries(pairs, list.first, list.last);
                                      });
    if (c.needsBalance())
      countLists(pairs, fluid, active, {std::max(hn, hv), 0}, counts_.balanceLists, [](const ClusterList<>&) {});
    counts_.nearEntries = scaled(slicedFluid.near, ofFluid) + scaled(slicedWalls.near, ofWalls);
    counts_.stagedEntries = scaled(slicedFluid.staged, ofFluid) + scaled(slicedWalls.staged, ofWalls);
    counts_.gradientEntries = scaled(gradients, ofFluid) + scaled(gradientsOfWalls, ofWalls);
    counts_.rowEntries = scaled(rows, ofFluid);
    counts_.pressureGrids = grids(pairs, HatsOn::Active, hatReach, 1);
    counts_.fluidGrids = grids(pairs, HatsOn::Fluid, 1, D);
    countBuckets(pairs.grid);
    return counts_;
  }

  MemoryCounts isph(const Case& c) {
    IsphPairs<D> pairs = makeIsphPairs<D>(c);
    describe(pairs);
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
    counts_.fluidGrids = grids(pairs, HatsOn::Fluid, 1, 1);
    countBuckets(pairs.grid);
    return counts_;
  }

 private:
  static Particles<D> startingParticles(const Case& c, const CellGrid<D>& grid, const Particles<D>& all) {
    NearBlocks<D> near(c, grid);
    near.add(all);
    return nearParticles(near, all);
  }

  template <class Pairs>
  void describe(Pairs& pairs) {
    pairs.fluidCount = particles_.fluidCount;
    pairs.activeCount = ranges_.activeCount;
    pairs.position = particles_.position;
    pairs.material = particles_.material;
    pairs.cells = viewOf(ranges_);
  }

  /// Of particles [first, last); `counted` gets the list of each window. Returns by what its counts are to be
  /// multiplied.
  template <class F>
  double countLists(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t last, ListRadii radii,
                    MemoryCounts::Lists& lists, F&& counted) {
    lists.clusters = (last - first + clusterSize - 1) / clusterSize;
    std::array<std::uint64_t, listSegments> entries{};
    const bool walls = first >= particles_.fluidCount;
    const double by = forEachWindow(first, last, [&](std::uint32_t begin, std::uint32_t end) {
      ClusterList<> list;
      buildClusterList<D>(context_, pairs.grid, ranges_, pairs.position, begin, end, radii, walls, list);
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
      const double reach = slopeReach(pairs.terms.weights.pressure) * pairs.terms.pressureRadius;
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

  /// Those of HatMultigrid, down to the smallest level that a backend may take; `numbers` per node.
  std::vector<MemoryCounts::Grid> grids(const SortedParticles<D>& particles, HatsOn what, int reach, int numbers) {
    SortedParticles<D> on = particles;
    HatNodes<D> nodes;
    findHatNodes(context_, on, what, nodes);
    std::vector<MemoryCounts::Grid> levels;
    while (true) {
      BlockCsr<1> a;
      hatPattern(context_, nodes, a, reach);
      levels.push_back({nodes.count(), nodes.nodeAt.size(), a.column.size()});
      if (static_cast<std::uint32_t>(numbers) * nodes.count() <= leastUnknowns) return levels;
      HatNodes<D> coarse;
      coarserNodes<D>(context_, nodes, coarse);
      // As HatMultigrid does.
      if (static_cast<std::uint32_t>(numbers) * coarse.count() > leastUnknowns &&
          coarse.count() > 0.9 * nodes.count())
        return levels;
      nodes = std::move(coarse);
    }
  }
  static constexpr std::uint32_t leastUnknowns = 200;

  void countBuckets(const CellGrid<D>& grid) {
    BucketLevels<> levels;
    findBuckets(context_, ranges_.key, D * CellGrid<D>::subBits, D, levels);
    for (std::size_t l = 0; l < levels.begin.size(); ++l) counts_.buckets.push_back(levels.count(l));
    const auto occupied = [&](std::size_t c) { return ranges_.fluidEnd[c] > ranges_.fluidBegin[c]; };
    for (std::size_t c = 0; c < grid.cellCount(); ++c)
      if (occupied(c))
        forEachAdjacentCell(grid, grid.cellAt(c), [&](const Vec<D, int>& cell) {
          counts_.bucketEntries += occupied(grid.linear(cell));
        });
  }

  Context<Cpu> context_;
  Particles<D> particles_;
  CellRanges<> ranges_;
  SortWorkspace<> workspace_;
  MemoryCounts counts_;
};

template <int D>
MemoryCounts countParticles(const Case& c, const Particles<D>& particles, bool wholeRows) {
  if (c.method.kind == MethodKind::Isph) return Counter<D>(c, makeIsphPairs<D>(c).grid, particles).isph(c);
  return Counter<D>(c, makeMphPairs<D>(c).grid, particles).mph(c, wholeRows);
}

}  // namespace

std::uint64_t searchCells(const Case& c) {
  const auto cells = [&]<int D>(std::integral_constant<int, D>) {
    return c.method.kind == MethodKind::Isph ? makeIsphPairs<D>(c).grid.cellCount()
                                             : makeMphPairs<D>(c).grid.cellCount();
  };
  return c.dimensions == 2 ? cells(std::integral_constant<int, 2>{}) : cells(std::integral_constant<int, 3>{});
}

MemoryCounts countForMemory(const Case& c, const AnyParticles& particles, bool wholeRows) {
  return particles.visit([&](const auto& p) { return countParticles(c, p, wholeRows); });
}

}  // namespace treacle
