#include "treacle/search/shared_buckets.hpp"

#include "treacle/core/copy_values.hpp"
#include "treacle/core/processes.hpp"

#include <algorithm>
#include <vector>

namespace treacle {
namespace {

template <class T, class Backend>
std::vector<T> onHost(const Context<Backend>& context, const Buffer<T, Backend>& values) {
  std::vector<T> host(values.size());
  copyToHost(context, values.span(), host.data());
  return host;
}

/// What each process has `own` of, together and ascending.
std::vector<std::uint64_t> ofAllProcesses(const Communicator& job, const std::vector<std::uint64_t>& own) {
  std::vector<std::uint64_t> all;
  for (const auto& part : job.swap(std::vector(job.size(), own))) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

template <int D, class Backend>
void findSharedBuckets(Context<Backend>& context, const SortedParticles<D>& particles,
                       std::span<const std::uint64_t> key, SharedBuckets<Backend>& buckets) {
  const int cellShift = D * CellGrid<D>::subBits;
  const std::uint32_t ownFluid = particles.ownFluid();
  Buffer<std::uint64_t, Backend> localKey;
  localKey.resize(context, particles.fluidCount);
  copyValues(context, key.first(ownFluid), localKey.data());
  sortKeys<D>(context, particles.grid, particles.position.subspan(ownFluid, particles.ghostFluid),
              localKey.span().subspan(ownFluid));
  BucketLevels<Backend>& local = buckets.local;
  findBuckets(context, localKey, cellShift, D, local, 1);

  Buffer<std::uint64_t, Backend> cellBuffer;
  cellBuffer.resize(context, local.count(0));
  bucketCells(context, localKey, local.begin[0], cellShift, cellBuffer);
  const std::vector<std::uint64_t> cells = onHost(context, cellBuffer);
  const std::vector<std::uint32_t> begin = onHost(context, local.begin[0]);
  buckets.own = static_cast<std::uint32_t>(std::ranges::lower_bound(begin, ownFluid) - begin.begin());
  const std::vector<std::uint64_t> all =
      ofAllProcesses(*context.communicator, {cells.begin(), cells.begin() + buckets.own});

  std::vector<std::uint32_t> number(cells.size()), members(all.size() + 1, ownFluid);
  for (std::size_t b = 0; b < cells.size(); ++b)
    number[b] = static_cast<std::uint32_t>(std::ranges::lower_bound(all, cells[b]) - all.begin());
  for (std::uint32_t b = buckets.own; b-- > 0;) {  // buckets of others between two own ones: none of the particles
    const std::uint32_t behindBefore = b > 0 ? number[b - 1] + 1 : 0;
    std::fill(members.begin() + behindBefore, members.begin() + number[b] + 1, begin[b]);
  }
  fromHost(context, std::span<const std::uint32_t>(number), buckets.number);
  Buffer<std::uint64_t, Backend> allCells;
  fromHost(context, std::span<const std::uint64_t>(all), allCells);
  findBuckets(context, allCells, 0, D, buckets.all);  // level 0: each cell by itself
  fromHost(context, std::span<const std::uint32_t>(members), buckets.all.begin[0]);
}

#define TREACLE_INSTANTIATE(Backend)                                                           \
  template void findSharedBuckets<2>(Context<Backend>&, const SortedParticles<2>&,             \
                                     std::span<const std::uint64_t>, SharedBuckets<Backend>&); \
  template void findSharedBuckets<3>(Context<Backend>&, const SortedParticles<3>&,             \
                                     std::span<const std::uint64_t>, SharedBuckets<Backend>&);
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
