#include "treacle/search/buckets.hpp"

namespace treacle {
namespace {

/// Starts of the runs of equal keys, and the end; `keys` are reduced to one per run.
void findRuns(std::vector<std::uint64_t>& keys, Buffer<std::uint32_t>& begin) {
  std::vector<std::uint32_t> starts;
  std::vector<std::uint64_t> distinct;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!distinct.empty() && distinct.back() == keys[i]) continue;
    starts.push_back(static_cast<std::uint32_t>(i));
    distinct.push_back(keys[i]);
  }
  starts.push_back(static_cast<std::uint32_t>(keys.size()));
  begin.resize(starts.size());
  std::copy(starts.begin(), starts.end(), begin.begin());
  keys = std::move(distinct);
}

}  // namespace

void findBuckets(Context<Cpu>&, std::span<const std::uint64_t> key, int cellShift, int dimensions,
                 BucketLevels<>& levels, std::size_t mostLevels) {
  std::vector<std::uint64_t> keys(key.begin(), key.end());
  levels.begin.clear();
  for (int shift = cellShift; levels.begin.empty() || (keys.size() > 1 && levels.begin.size() < mostLevels);
       shift = dimensions) {
    for (std::uint64_t& k : keys) k >>= shift;
    findRuns(keys, levels.begin.emplace_back());
  }

  const Buffer<std::uint32_t>& begin = levels.begin.front();
  levels.bucketOf.resize(key.size());
  for (std::uint32_t b = 0; b < levels.count(0); ++b)
    std::fill(levels.bucketOf.begin() + begin[b], levels.bucketOf.begin() + begin[b + 1], b);
}

}  // namespace treacle
