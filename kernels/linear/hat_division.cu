#include "core/cuda_check.hpp"
#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/linear/hat_nodes.hpp"

#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// One thread per lattice point; reads owners and which points are nodes, around points of others, too; writes
/// whether this process has the point as a node of its own, and whether as a ghost. No atomics.
template <int D>
void markPlaces(Context<Cuda>& context, const DividedLattice<D>& divided, std::span<const std::uint8_t> carried,
                std::uint32_t* own, std::uint32_t* ghost) {
  forEach(context, divided.lattice.points(),
          [divided, carried = carried.empty() ? nullptr : carried.data(), own, ghost] __device__(std::size_t p) {
            const NodePlace place = nodePlace(divided, p, carried && carried[p] != 0);
            own[p] = place == NodePlace::Own;
            ghost[p] = place == NodePlace::Ghost;
          });
}

/// Ghosts, those of one process after the other, either in the order of the lattice.
struct Ghosts {
  Buffer<std::uint32_t, Cuda> point, owner;
  std::vector<std::uint32_t> of;  // how many are each rank's
};

void sortByOwner(Context<Cuda>& context, int ranks, Ghosts& ghosts) {
  Ghosts sorted;
  const std::size_t count = ghosts.point.size();
  sorted.point.resize(context, count);
  sorted.owner.resize(context, count);
  std::size_t bytes = 0;
  void* temporary = nullptr;
  const auto sort = [&] {
    TREACLE_CUDA_CHECK(cub::DeviceRadixSort::SortPairs(
        temporary, bytes, ghosts.owner.data(), sorted.owner.data(), ghosts.point.data(), sorted.point.data(),
        count, 0, std::bit_width(static_cast<unsigned>(ranks)), context.stream()));
  };
  sort();  // asks for the size
  temporary = context.scratch(std::max<std::size_t>(bytes, 1));
  sort();
  std::swap(ghosts.point, sorted.point);
  std::swap(ghosts.owner, sorted.owner);
}

/// `start`: per point the number of ghosts before it.
Ghosts listGhosts(Context<Cuda>& context, const Buffer<std::uint32_t, Cuda>& start, std::uint32_t count,
                  const std::int32_t* owner, int ranks) {
  Ghosts ghosts;
  ghosts.of.resize(ranks);
  if (count == 0) return ghosts;
  ghosts.point.resize(context, count);
  ghosts.owner.resize(context, count);
  Buffer<std::uint32_t, Cuda> of(context, ranks);
  clearBytes(context, of.data(), ranks * sizeof(std::uint32_t));
  // One thread per point; atomic sums of whole numbers per rank.
  forEach(context, start.size() - 1,
          [start = start.data(), owner, point = ghosts.point.data(), rank = ghosts.owner.data(),
           of = of.data()] __device__(std::size_t p) {
            if (start[p + 1] == start[p]) return;
            point[start[p]] = static_cast<std::uint32_t>(p);
            rank[start[p]] = static_cast<std::uint32_t>(owner[p]);
            atomicAdd(&of[owner[p]], 1u);
          });
  copyBytesToHost(context, of.data(), ghosts.of.data(), ranks * sizeof(std::uint32_t));
  sortByOwner(context, ranks, ghosts);
  return ghosts;
}

/// Everybody asks the owners for its ghosts: what is asked of this process becomes what it sends.
void listSent(Context<Cuda>& context, const Ghosts& ghosts, const std::uint32_t* nodeAt, Halo<Cuda>& halo) {
  const Communicator& job = *context.communicator;
  const std::vector<std::uint32_t> counts = job.table(ghosts.of);
  std::size_t sent = 0;
  for (int r = 0; r < job.size(); ++r) {
    const std::uint32_t asked = counts[r * job.size() + job.rank()];
    sent += asked;
    if (asked > 0 || ghosts.of[r] > 0)
      halo.neighbours.push_back({.rank = r, .sentFluid = asked, .fluid = ghosts.of[r]});
  }
  halo.sentFluid.resize(context, sent);
  Buffer<std::uint32_t, Cuda> asked(context, sent);
  std::vector<Communicator::Message> out, in;
  std::uint32_t *from = const_cast<std::uint32_t*>(ghosts.point.data()), *to = asked.data();
  for (const auto& n : halo.neighbours) {
    out.push_back({n.rank, from, n.fluid * sizeof(std::uint32_t)});
    in.push_back({n.rank, to, n.sentFluid * sizeof(std::uint32_t)});
    from += n.fluid, to += n.sentFluid;
  }
  context.link->exchange(out, in);
  forEach(context, sent, [nodeAt, point = asked.data(), node = halo.sentFluid.data()] __device__(std::size_t k) {
    node[k] = nodeAt[point[k]];
  });
}

}  // namespace

template <int D, class Backend>
void divideNodes(Context<Backend>& context, const HatLattice<D>& lattice, Buffer<std::int32_t, Backend> owner,
                 Buffer<std::uint8_t, Backend> active, std::span<const std::uint8_t> carried,
                 HatNodes<D, Backend>& nodes) {
  const Communicator& job = *context.communicator;
  const std::size_t points = lattice.points();
  Buffer<std::uint32_t, Cuda> ownStart(context, points + 1), ghostStart(context, points + 1);
  markPlaces<D>(context, {lattice, owner.data(), active.data(), job.rank()}, carried, ownStart.data(),
                ghostStart.data());
  const std::uint32_t own = startRows(context, ownStart), ghosts = startRows(context, ghostStart);
  const Ghosts list = listGhosts(context, ghostStart, ghosts, owner.data(), job.size());

  nodes.lattice = lattice;
  nodes.nodeAt.resize(context, points);
  nodes.point.resize(context, std::size_t{own} + ghosts);
  forEach(
      context, points,
      [start = ownStart.data(), at = nodes.nodeAt.data(), point = nodes.point.data()] __device__(std::size_t p) {
        const bool isOwn = start[p + 1] > start[p];
        at[p] = isOwn ? start[p] : noNode;
        if (isOwn) point[start[p]] = static_cast<std::uint32_t>(p);
      });
  forEach(context, ghosts,
          [own, list = list.point.data(), at = nodes.nodeAt.data(),
           point = nodes.point.data()] __device__(std::size_t k) {
            at[list[k]] = static_cast<std::uint32_t>(own + k);
            point[own + k] = list[k];
          });

  auto division = std::make_unique<HatDivision<Cuda>>();
  Halo<Cuda>& halo = division->halo;
  halo.ownFluid = own;
  halo.fluid = own + ghosts;
  for (std::uint32_t ofRank : job.all(own)) halo.fluidOfAll += ofRank;
  listSent(context, list, nodes.nodeAt.data(), halo);
  halo.reserve(context, D * sizeof(double));
  division->owner = std::move(owner);
  division->active = std::move(active);
  nodes.division = std::move(division);
}

namespace {

/// A row by where its columns stand around its point (HatBox). One warp per row: for each of the numbers of its
/// blocks f(number of the matrix, number of the spread row); no atomics.
template <int D, int B, class NodeOf, class F>
__global__ void __launch_bounds__(128)
    spreadRowsKernel(HatNodesView<D> nodes, BlockCsrView<B> a, int reach, std::uint32_t rows, NodeOf nodeOf, F f) {
  constexpr unsigned elements = B * B;
  const std::uint32_t k = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (k >= rows) return;
  const std::uint32_t node = nodeOf(k);
  const HatBox<D> box = HatBox<D>::around(nodes.lattice, nodes.pointOf(node), reach);
  const std::uint64_t begin = a.rowStart[node];
  const auto numbers = static_cast<std::uint32_t>(a.rowStart[node + 1] - begin) * elements;
  for (std::uint32_t n = threadIdx.x % 32; n < numbers; n += 32) {
    const int place = box.placeOf(nodes.pointOf(a.column[begin + n / elements]));
    f(begin * elements + n, k, place * elements + n % elements);
  }
}

template <int D, int B, class NodeOf, class F>
void spreadRows(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes, const BlockCsr<B, double, Cuda>& a,
                int reach, std::uint32_t rows, NodeOf nodeOf, F f) {
  launch(context, blocksFor(rows, 4), 128, 0, spreadRowsKernel<D, B, NodeOf, F>, nodes.view(), viewOf(a), reach,
         rows, nodeOf, f);
}

}  // namespace

/// What arrived is added for one neighbour after the other, because several may have a ghost of the same node.
template <int D, int B, class Backend>
void sumRows(Context<Backend>& context, const HatNodes<D, Backend>& nodes, int reach,
             BlockCsr<B, double, Backend>& a) {
  if (!nodes.division) return sumOverDevices(context, a.value.span());
  Halo<Cuda>& halo = nodes.division->halo;
  const std::uint32_t own = nodes.own(), ghosts = nodes.count() - own;
  std::size_t size = B * B;
  for (int k = 0; k < D; ++k) size *= 2 * reach + 1;
  Buffer<double, Cuda> leaving(context, ghosts * size), arrived(context, halo.sentFluid.size() * size);
  clearBytes(context, leaving.data(), leaving.size() * sizeof(double));
  double* const value = reinterpret_cast<double*>(a.value.data());
  spreadRows(
      context, nodes, a, reach, ghosts, [own] __device__(std::uint32_t k) { return own + k; },
      [value, size, to = leaving.data()] __device__(std::uint64_t n, std::uint32_t row, unsigned place) {
        to[row * size + place] = value[n];
      });
  halo.returnGhosts(context, leaving.data(), size * sizeof(double), arrived.data());
  const std::uint32_t* node = halo.sentFluid.data();
  const double* from = arrived.data();
  for (const auto& n : halo.neighbours) {
    spreadRows(
        context, nodes, a, reach, n.sentFluid, [node] __device__(std::uint32_t k) { return node[k]; },
        [value, size, from] __device__(std::uint64_t k, std::uint32_t row, unsigned place) {
          value[k] += from[row * size + place];
        });
    node += n.sentFluid;
    from += n.sentFluid * size;
  }
}

TREACLE_HAT_DIVISION(2, Cuda)
TREACLE_HAT_DIVISION(3, Cuda)

}  // namespace treacle
