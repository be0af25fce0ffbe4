#pragma once

#include "support/matrices.hpp"
#include "support/scene.hpp"
#include "treacle/core/cuda.hpp"

namespace treacle::test {

/// The same list in device memory.
inline ClusterList<Cuda> onDevice(const Context<Cuda>& context, const ClusterListView& list) {
  const std::size_t offsets = std::size_t{listSegments} * list.clusterCount() + 1;
  ClusterList<Cuda> copy;
  copy.first = list.first;
  copy.last = list.last;
  copyToDevice<std::uint64_t>(context, {list.offset, offsets}, copy.offset);
  copyToDevice<std::uint32_t>(context, {list.entry, list.offset[offsets - 1]}, copy.entry);
  copyToDevice<std::uint8_t>(context, {list.special, list.clusterCount()}, copy.special);
  return copy;
}

inline CellRanges<Cuda> onDevice(const Context<Cuda>& context, const CellRanges<>& ranges) {
  CellRanges<Cuda> copy;
  copy.activeCount = ranges.activeCount;
  copyToDevice<std::uint32_t>(context, ranges.fluidBegin, copy.fluidBegin);
  copyToDevice<std::uint32_t>(context, ranges.fluidEnd, copy.fluidEnd);
  copyToDevice<std::uint32_t>(context, ranges.wallBegin, copy.wallBegin);
  copyToDevice<std::uint32_t>(context, ranges.wallEnd, copy.wallEnd);
  copyToDevice<std::uint64_t>(context, ranges.key, copy.key);
  return copy;
}

inline BucketLevels<Cuda> onDevice(const Context<Cuda>& context, const BucketLevels<>& levels) {
  BucketLevels<Cuda> copy;
  for (const auto& begin : levels.begin) copy.begin.push_back(copyToDevice<std::uint32_t>(context, begin));
  copyToDevice<std::uint32_t>(context, levels.bucketOf, copy.bucketOf);
  return copy;
}

/// More than enough fluid for every way in which kernels share work: above 24000 particles, on a floor.
template <int D>
Scene<D> makeLargeScene(SchemeKind scheme, int across = D == 2 ? 170 : 32) {
  Scene<D> s;
  s.c = sceneCase(D, true, scheme);
  const double l = s.c.spacing, size = across * l, top = size - 2 * l;
  for (int k = 0; k < D; ++k) s.c.domain.max[k] = size;
  const auto inWall = [&](const Vec<D>& x) { return x[D - 1] < 4 * l; };
  const auto inFluid = [&](const Vec<D>& x) { return x[D - 1] >= 4 * l && x[D - 1] < top; };
  s.particles = jitteredLattice<D>(s.c, 0.2, 3, inFluid, inWall);
  knowSurface(s.c, 4 * l, s.particles);
  prepare(s);
  return s;
}

/// What the kernels of a step read, as the CPU prepared it for the scene, in device memory.
template <int D>
struct DeviceScene {
  Context<Cuda> context;
  Buffer<Vec<D>, Cuda> position;
  Buffer<std::uint8_t, Cuda> material;
  ClusterList<Cuda> fluidList, wallList;
  CellRanges<Cuda> ranges;
  BucketLevels<> hostLevels;
  BucketLevels<Cuda> levels;
  Buffer<WallSurface<D>, Cuda> wallSurface;
  Buffer<SymmetricBlock<D>, Cuda> renormalisation;
  Buffer<double, Cuda> viscosityScale, wallShare;
  Buffer<Block<D>, Cuda> wallBlock;
  Buffer<Vec<D>, Cuda> wallGradient;
  MphPairs<D> pairs;  // looks at the members above

  explicit DeviceScene(Scene<D>& s) : pairs(s.pairs()) {
    copyToDevice<Vec<D>>(context, s.pairs().position, position);
    copyToDevice<std::uint8_t>(context, s.pairs().material, material);
    fluidList = onDevice(context, s.pairs().fluidList);
    wallList = onDevice(context, s.pairs().wallList);
    ranges = onDevice(context, s.ranges());
    findBuckets(s.context, s.ranges().key, D * CellGrid<D>::subBits, D, hostLevels);
    levels = onDevice(context, hostLevels);
    copyToDevice<Block<D>>(context, s.wallBlock, wallBlock);
    copyToDevice<Vec<D>>(context, s.wallGradient, wallGradient);
    if (!s.wallSurface.empty()) {
      copyToDevice<WallSurface<D>>(context, s.wallSurface, wallSurface);
      pairs.wallSurface = wallSurface.data();
    }
    if (!s.renormalisation.empty()) {
      copyToDevice<SymmetricBlock<D>>(context, s.renormalisation, renormalisation);
      pairs.renormalisation = renormalisation.data();
    }
    if (!s.viscosityScale.empty()) {
      copyToDevice<double>(context, s.viscosityScale, viscosityScale);
      pairs.viscosityScale = viscosityScale.data();
    }
    if (!s.wallShare.empty()) {
      copyToDevice<double>(context, s.wallShare, wallShare);
      pairs.wallShare = wallShare.data();
    }
    pairs.position = position;
    pairs.material = material;
    pairs.fluidList = fluidList.view();
    pairs.wallList = wallList.view();
    pairs.cells = viewOf(ranges);
  }
  DeviceScene(const DeviceScene&) = delete;

  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }
};

}  // namespace treacle::test
