#include "core/launch.hpp"
#include "core/scan.hpp"
#include "search/cluster_candidates.cuh"

namespace treacle {
namespace {

template <int D>
struct BuildArguments {
  CellGrid<D> grid;
  CellRangesView cells;
  const Vec<D>* position;
  ListScope scope;
  std::uint32_t clusters;
  std::uint64_t* offset;
  std::uint32_t* entry;
  std::uint8_t* special;
};

constexpr int warpsPerBlock = 4;

/// One warp per cluster: counts the entries of its four segments into offset[4 c + 1 …], or, with Fill, writes
/// them in the order of the walk. No atomics.
template <int D, bool Fill>
__global__ void __launch_bounds__(32 * warpsPerBlock, 6) buildKernel(const __grid_constant__ BuildArguments<D> a) {
  const std::uint32_t cluster = blockIdx.x * warpsPerBlock + threadIdx.x / 32;
  if (cluster >= a.clusters) return;
  std::uint64_t* offset = a.offset + std::size_t{listSegments} * cluster;
  if (Fill && offset[0] == offset[listSegments]) return;
  const std::uint32_t first = a.scope.first + clusterSize * cluster;
  const unsigned lane = threadIdx.x % 32, before = (1u << lane) - 1;

  std::uint64_t next[listSegments] = {};
  if (Fill)
    for (int s = 0; s < listSegments; ++s) next[s] = offset[s];
  __shared__ typename ClusterCandidates<D>::Shared shared[warpsPerBlock];
  const ClusterCandidates<D> candidates(a.grid, a.cells, a.position, a.scope.side, first,
                                        min(clusterSize, a.scope.last - first), shared[threadIdx.x / 32]);
  const bool special =
      candidates.forEach(a.scope.radii, true, true, [&](std::uint32_t j, bool near, bool far, bool wall) {
        const auto append = [&](ListSegment segment, bool mine) {
          const unsigned lanes = __ballot_sync(~0u, mine);
          std::uint64_t& end = next[static_cast<int>(segment)];
          if (Fill && mine) a.entry[end + __popc(lanes & before)] = j;
          end += __popc(lanes);
        };
        append(ListSegment::NearFluid, near && !wall);
        append(ListSegment::FarFluid, far && !wall);
        append(ListSegment::NearWall, near && wall);
        append(ListSegment::FarWall, far && wall);
      });
  if (Fill || lane != 0) return;
  const bool fluid =
      next[static_cast<int>(ListSegment::NearFluid)] + next[static_cast<int>(ListSegment::FarFluid)] > 0;
  const bool empty = a.scope.onlyNextToFluid && !fluid;
  for (int s = 0; s < listSegments; ++s) offset[s + 1] = empty ? 0 : next[s];
  a.special[cluster] = special;
  if (cluster == 0) a.offset[0] = 0;
}

}  // namespace

template <int D>
void buildClusterList(Context<Cuda>& context, const CellGrid<D>& grid, const CellRanges<Cuda>& ranges,
                      std::span<const Vec<D>> position, const ListScope& scope, ClusterList<Cuda>& list) {
  list.first = scope.first;
  list.last = scope.last;
  const std::uint32_t clusters = list.clusterCount();
  const std::size_t offsets = std::size_t{listSegments} * clusters + 1;
  list.offset.resize(context, offsets);
  list.special.resize(context, clusters);
  if (clusters == 0) {
    clearBytes(context, list.offset.data(), sizeof(std::uint64_t));
    list.entry.resize(context, 0);
    return;
  }
  BuildArguments<D> arguments{grid,     viewOf(ranges),     position.data(), scope,
                              clusters, list.offset.data(), nullptr,         list.special.data()};
  const unsigned blocks = blocksFor(clusters, warpsPerBlock);
  launch(context, blocks, 32 * warpsPerBlock, 0, buildKernel<D, false>, arguments);

  sumUpTo(context, list.offset.span());
  list.entry.resize(context, valueOnHost(context, list.offset.data() + offsets - 1));
  arguments.entry = list.entry.data();
  launch(context, blocks, 32 * warpsPerBlock, 0, buildKernel<D, true>, arguments);
}

template void buildClusterList<2>(Context<Cuda>&, const CellGrid<2>&, const CellRanges<Cuda>&,
                                  std::span<const Vec<2>>, const ListScope&, ClusterList<Cuda>&);
template void buildClusterList<3>(Context<Cuda>&, const CellGrid<3>&, const CellRanges<Cuda>&,
                                  std::span<const Vec<3>>, const ListScope&, ClusterList<Cuda>&);

}  // namespace treacle
