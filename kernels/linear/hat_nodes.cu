#include "core/launch.hpp"
#include "core/scan.hpp"
#include "linear/row_sums.cuh"
#include "treacle/linear/each_node.hpp"

#include <algorithm>
#include <utility>

namespace treacle {
namespace {

constexpr int nodeWarpsPerBlock = 4;
/// What a block gets without asking.
constexpr std::size_t sharedBytes = 48 << 10;
static_assert(hatGatherPlaces<3>(hatReach) * sizeof(Block<3>) <= sharedBytes, "not even one warp would fit");

/// One warp per node; reads which points around it are nodes; writes their number to rowStart, or, with Fill, the
/// nodes in the order of the points. No atomics.
template <int D, bool Fill>
__global__ void __launch_bounds__(32 * nodeWarpsPerBlock)
    patternKernel(HatNodesView<D> nodes, int reach, std::uint64_t* rowStart, std::uint32_t* column) {
  const std::uint32_t row = blockIdx.x * nodeWarpsPerBlock + threadIdx.x / 32;
  if (row >= nodes.count) return;
  const unsigned lane = threadIdx.x % 32;
  const HatBox<D> box = HatBox<D>::around(nodes.lattice, nodes.pointOf(row), reach);
  const int places = box.size();
  const std::uint64_t start = Fill ? rowStart[row] : 0;
  std::uint32_t found = 0;
  for (int first = 0; first < places; first += 32) {
    const int place = first + static_cast<int>(lane);
    const std::uint32_t node = place < places ? nodes.at(box.at(place)) : noNode;
    const unsigned present = __ballot_sync(~0u, node != noNode);
    if (Fill && node != noNode) column[start + found + __popc(present & ((1u << lane) - 1))] = node;
    found += __popc(present);
  }
  if (!Fill && lane == 0) rowStart[row] = found;
}

/// One warp per coarse row: first P^T A by fine point around the coarse one, in shared memory (`places` blocks per
/// warp), fine row after fine row; then the hats of each column summed over it. A lane has a number of a block at
/// a time. Reads A and both sets of nodes; writes the coarse values. No atomics: the columns of a row are
/// distinct.
template <int D, int B>
__global__ void __launch_bounds__(32 * nodeWarpsPerBlock)
    coarsenKernel(HatNodesView<D> fine, BlockCsrView<B, double> a, HatNodesView<D> coarse,
                  BlockCsrView<B, double> coarsePattern, double* coarseValue, int reach, unsigned places) {
  constexpr unsigned elements = B * B;
  extern __shared__ double ofWarp[];
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= coarse.count) return;
  const unsigned lane = threadIdx.x % 32;
  double* sums = ofWarp + threadIdx.x / 32 * places * elements;
  for (unsigned k = lane; k < places * elements; k += 32) sums[k] = 0;
  __syncwarp();

  const Vec<D, int> point = coarse.pointOf(row);
  const HatBox<D> box = HatBox<D>::around(fine.lattice, point * 2, reach + 1);
  forEachFine(fine.lattice, point, [&](const Vec<D, int>& p, double weight) {
    const std::uint32_t i = fine.at(p);  // the same in all lanes
    if (i >= fine.own) return;           // other processes have the rows of ghosts, and noNode is no row
    const std::uint64_t begin = a.rowStart[i];
    const double* value = a.value[begin].a;
    const auto numbers = static_cast<std::uint32_t>(a.rowStart[i + 1] - begin) * elements;
    for (std::uint32_t k = lane; k < numbers; k += 32) {
      const int place = box.placeOf(fine.pointOf(a.column[begin + k / elements]));
      if (place >= 0) sums[place * elements + k % elements] += weight * value[k];
    }
    __syncwarp();
  });

  const std::uint64_t begin = coarsePattern.rowStart[row];
  const auto numbers = static_cast<std::uint32_t>(coarsePattern.rowStart[row + 1] - begin) * elements;
  for (std::uint32_t k = lane; k < numbers; k += 32) {
    const Vec<D, int> column = coarse.pointOf(coarsePattern.column[begin + k / elements]);
    double sum = 0;
    forEachFine(fine.lattice, column, [&](const Vec<D, int>& p, double weight) {
      const int place = box.placeOf(p);
      if (place >= 0) sum += weight * sums[place * elements + k % elements];
    });
    coarseValue[begin * elements + k] = sum;
  }
}

}  // namespace

template <int D, int B, class Backend>
void hatPattern(Context<Backend>& context, const HatNodes<D, Backend>& nodes, BlockCsr<B, double, Backend>& a,
                int reach) {
  const unsigned blocks = blocksFor(nodes.count(), nodeWarpsPerBlock), threads = 32 * nodeWarpsPerBlock;
  a.rowStart.resize(context, std::size_t{nodes.count()} + 1);
  std::uint32_t* none = nullptr;
  launch(context, blocks, threads, 0, patternKernel<D, false>, nodes.view(), reach, a.rowStart.data(), none);
  const std::uint64_t entries = startRows(context, a.rowStart);
  a.column.resize(context, entries);
  a.value.resize(context, entries);
  launch(context, blocks, threads, 0, patternKernel<D, true>, nodes.view(), reach, a.rowStart.data(),
         a.column.data());
}

template <int D, int B, class Backend>
void coarsenHats(Context<Backend>& context, const HatNodes<D, Backend>& fine,
                 const BlockCsr<B, double, Backend>& a, const HatNodes<D, Backend>& coarse,
                 BlockCsr<B, double, Backend>& coarseA, int reach) {
  hatPattern<D>(context, coarse, coarseA, reach);
  const unsigned places = hatGatherPlaces<D>(reach);
  const std::size_t bytesPerWarp = places * sizeof(Block<B>);
  const auto warps = static_cast<unsigned>(std::min<std::size_t>(nodeWarpsPerBlock, sharedBytes / bytesPerWarp));
  launch(context, blocksFor(coarse.count(), warps), 32 * warps, warps * bytesPerWarp, coarsenKernel<D, B>,
         fine.view(), viewOf(a), coarse.view(), viewOf(coarseA), reinterpret_cast<double*>(coarseA.value.data()),
         reach, places);
  if (fine.division) sumRows<D>(context, coarse, reach, coarseA);
}

template std::uint32_t countNodes(Context<Cuda>&, std::span<const std::uint8_t>);
TREACLE_HAT_NODES(2, Cuda)
TREACLE_HAT_NODES(3, Cuda)

}  // namespace treacle
