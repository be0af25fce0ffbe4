#include "treacle/core/parallel.hpp"
#include "treacle/linear/hat_nodes.hpp"

#include <utility>
#include <vector>

namespace treacle {

template <int D, class Backend>
void divideNodes(Context<Backend>& context, const HatLattice<D>& lattice, Buffer<std::int32_t, Backend> owner,
                 Buffer<std::uint8_t, Backend> active, std::span<const std::uint8_t> carried,
                 HatNodes<D, Backend>& nodes) {
  const Communicator& job = *context.communicator;
  const DividedLattice<D> divided{lattice, owner.data(), active.data(), job.rank()};
  Buffer<NodePlace> place(lattice.points());
  parallelFor(place.size(), parallelGrain,
              [&](std::size_t p) { place[p] = nodePlace(divided, p, !carried.empty() && carried[p] != 0); });

  nodes.nodeAt.resize(place.size());
  std::fill(nodes.nodeAt.begin(), nodes.nodeAt.end(), noNode);
  std::vector<std::uint32_t> points;
  std::vector<std::vector<std::uint32_t>> wanted(job.size());
  for (std::uint32_t p = 0; p < place.size(); ++p) {
    if (place[p] == NodePlace::Own) points.push_back(p);
    if (place[p] == NodePlace::Ghost) wanted[owner[p]].push_back(p);
  }
  auto division = std::make_unique<HatDivision<Cpu>>();
  Halo<Cpu>& halo = division->halo;
  halo.ownFluid = static_cast<std::uint32_t>(points.size());
  for (const auto& ofRank : wanted) points.insert(points.end(), ofRank.begin(), ofRank.end());
  halo.fluid = static_cast<std::uint32_t>(points.size());
  nodes.point.resize(points.size());
  for (std::uint32_t n = 0; n < points.size(); ++n) nodes.nodeAt[nodes.point[n] = points[n]] = n;

  const std::vector<std::vector<std::uint32_t>> asked = job.swap(wanted);
  std::vector<std::uint32_t> sent;
  for (int r = 0; r < job.size(); ++r) {
    for (std::uint32_t p : asked[r]) sent.push_back(nodes.nodeAt[p]);
    if (asked[r].empty() && wanted[r].empty()) continue;
    halo.neighbours.push_back({.rank = r,
                               .sentFluid = static_cast<std::uint32_t>(asked[r].size()),
                               .fluid = static_cast<std::uint32_t>(wanted[r].size())});
  }
  halo.sentFluid.resize(sent.size());
  std::copy(sent.begin(), sent.end(), halo.sentFluid.begin());
  for (std::uint32_t own : job.all(halo.ownFluid)) halo.fluidOfAll += own;
  halo.reserve(context, D * sizeof(double));
  division->owner = std::move(owner);
  division->active = std::move(active);
  nodes.lattice = lattice;
  nodes.division = std::move(division);
}

namespace {

/// A row by where its columns stand around its point (HatBox), the other elements being zero.
template <int D, int B>
class SpreadRows {
 public:
  SpreadRows(const HatNodesView<D>& nodes, int reach, std::size_t rows)
      : nodes_(nodes), reach_(reach), size_(1), block_(0) {
    for (int k = 0; k < D; ++k) size_ *= 2 * reach + 1;
    block_.resize(rows * size_);
    std::fill(block_.begin(), block_.end(), Block<B>{});
  }

  Block<B>* row(std::size_t k) { return &block_[k * size_]; }
  std::size_t bytesOfRow() const { return size_ * sizeof(Block<B>); }

  /// f(element, its place) for the row of a node.
  template <class F>
  void forEachElement(BlockCsr<B>& a, std::uint32_t node, F&& f) const {
    const HatBox<D> box = HatBox<D>::around(nodes_.lattice, nodes_.pointOf(node), reach_);
    for (std::uint64_t k = a.rowStart[node]; k < a.rowStart[node + 1]; ++k)
      f(a.value[k], box.placeOf(nodes_.pointOf(a.column[k])));
  }

 private:
  HatNodesView<D> nodes_;
  int reach_;
  std::size_t size_;
  Buffer<Block<B>> block_;
};

}  // namespace

template <int D, int B, class Backend>
void sumRows(Context<Backend>& context, const HatNodes<D, Backend>& nodes, int reach,
             BlockCsr<B, double, Backend>& a) {
  if (!nodes.division) return sumOverProcesses(context, a.value.span());
  Halo<Cpu>& halo = nodes.division->halo;
  const std::uint32_t own = nodes.own(), ghosts = nodes.count() - own;
  SpreadRows<D, B> leaving(nodes.view(), reach, ghosts), arrived(nodes.view(), reach, halo.sentFluid.size());
  parallelFor(ghosts, parallelGrain / 8, [&](std::size_t k) {
    Block<B>* row = leaving.row(k);
    leaving.forEachElement(a, static_cast<std::uint32_t>(own + k),
                           [&](const Block<B>& element, int place) { row[place] = element; });
  });
  halo.returnGhosts(context, leaving.row(0), leaving.bytesOfRow(), arrived.row(0));
  for (std::size_t k = 0; k < halo.sentFluid.size(); ++k) {
    const Block<B>* row = arrived.row(k);
    arrived.forEachElement(a, halo.sentFluid[k], [&](Block<B>& element, int place) { element += row[place]; });
  }
}

TREACLE_HAT_DIVISION(2, Cpu)
TREACLE_HAT_DIVISION(3, Cpu)

}  // namespace treacle
