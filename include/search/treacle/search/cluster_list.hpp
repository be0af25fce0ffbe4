#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Eight particles that are consecutive in the sort, hence close together, form a cluster and share one list of
/// neighbours: all particles within reach of at least one of them. The lanes of a vector register are the
/// cluster's particles, a neighbour is broadcast to them, and no index is gathered; who is out of reach of a
/// single lane gets the weight zero there. Of each pair the nearest periodic images are meant (CellGrid::nearest):
/// a domain is longer than twice any reach, so there are no others.
inline constexpr std::uint32_t clusterSize = 8;

/// The parts of a cluster's list, in this order.
enum class ListSegment { NearFluid, FarFluid, NearWall, FarWall };
inline constexpr int listSegments = 4;
inline constexpr ListSegment allSegments[] = {ListSegment::NearFluid, ListSegment::FarFluid, ListSegment::NearWall,
                                              ListSegment::FarWall};
inline constexpr ListSegment nearSegments[] = {ListSegment::NearFluid, ListSegment::NearWall};
inline constexpr ListSegment fluidSegments[] = {ListSegment::NearFluid, ListSegment::FarFluid};
inline constexpr ListSegment wallSegments[] = {ListSegment::NearWall, ListSegment::FarWall};

/// What pair sums read of the lists; host or device memory.
struct ClusterListView {
  std::uint32_t first = 0, last = 0;  // particles [first, last); cluster c holds particles first + 8 c …
  const std::uint64_t* offset = nullptr;
  const std::uint32_t* entry = nullptr;
  const std::uint8_t* special = nullptr;

  TREACLE_HD std::uint32_t clusterCount() const { return (last - first + clusterSize - 1) / clusterSize; }
  std::span<const std::uint32_t> segment(std::uint32_t cluster, ListSegment s) const {
    const std::size_t k = std::size_t{listSegments} * cluster + static_cast<int>(s);
    return {entry + offset[k], offset[k + 1] - offset[k]};
  }
};

/// Lists of the clusters of particles [first, last); the last cluster may be short. "Near": some lane lies within
/// the near radius; "far": the others within the far radius.
template <class Backend = Cpu>
struct ClusterList {
  std::uint32_t first = 0, last = 0;
  Buffer<std::uint64_t, Backend> offset;  // 4 clusterCount() + 1: start of every segment
  Buffer<std::uint32_t, Backend> entry;   // indices of particles
  // Per cluster: its reach crosses a periodic end, or thin sheets part some of its particles from their
  // neighbours.
  Buffer<std::uint8_t, Backend> special;

  ClusterListView view() const { return {first, last, offset.data(), entry.data(), special.data()}; }
  operator ClusterListView() const { return view(); }
  std::uint32_t clusterCount() const { return view().clusterCount(); }
  std::span<const std::uint32_t> segment(std::uint32_t cluster, ListSegment s) const {
    return view().segment(cluster, s);
  }
  std::size_t bytes() const { return offset.bytes() + entry.bytes() + special.bytes(); }
};

struct ListRadii {
  double near = 0;  // [m]
  double far = 0;   // [m], >= near; 0: no far parts
};

/// The particles [first, last) that get lists, and how far these reach. A list leaves out particles that thin
/// sheets part from all particles of its cluster.
struct ListScope {
  std::uint32_t first = 0, last = 0;
  ListRadii radii;
  bool onlyNextToFluid = false;         // clusters without fluid within reach get empty lists
  const std::uint32_t* side = nullptr;  // of all particles (sides); null: there are no thin sheets
};

/// Builds the lists of the particles of `scope`; `position` [m] is that of all particles.
template <int D>
void buildClusterList(Context<Cpu>&, const CellGrid<D>& grid, const CellRanges<>& ranges,
                      std::span<const Vec<D>> position, const ListScope& scope, ClusterList<>& list);
template <int D>
void buildClusterList(Context<Cuda>&, const CellGrid<D>& grid, const CellRanges<Cuda>& ranges,
                      std::span<const Vec<D>> position, const ListScope& scope, ClusterList<Cuda>& list);

}  // namespace treacle
