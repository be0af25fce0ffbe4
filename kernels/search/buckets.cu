#include "treacle/search/buckets.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace treacle {
namespace {

constexpr int maxLevels = 65;  // a key has 64 bits
constexpr unsigned blockSize = 256;

/// Whether entry i starts a run of keys that are equal above the lowest `shift` bits.
__device__ inline bool startsRun(const std::uint64_t* key, std::size_t i, int shift) {
  return i == 0 || (key[i] ^ key[i - 1]) >> shift != 0;
}

/// One thread per particle, grid-stride; reads its key and the one before, adds to starts[l], where l is the last
/// level at which it starts a bucket; integer atomics, one per block and level.
__global__ void __launch_bounds__(blockSize)
    countStarts(const std::uint64_t* key, std::uint32_t n, int cellShift, int dimensions, std::uint32_t* starts) {
  __shared__ std::uint32_t ofBlock[maxLevels];
  for (int l = threadIdx.x; l < maxLevels; l += blockSize) ofBlock[l] = 0;
  __syncthreads();
  for (std::size_t i = 1 + blockIdx.x * std::size_t{blockSize} + threadIdx.x; i < n;
       i += gridDim.x * std::size_t{blockSize}) {
    const std::uint64_t differing = (key[i] ^ key[i - 1]) >> cellShift;
    if (differing) atomicAdd(&ofBlock[(63 - __clzll(static_cast<long long>(differing))) / dimensions], 1u);
  }
  __syncthreads();
  for (int l = threadIdx.x; l < maxLevels; l += blockSize)
    if (ofBlock[l] > 0) atomicAdd(&starts[l], ofBlock[l]);
}

/// Number of buckets of each level, up to the first that has one at most.
std::vector<std::uint32_t> countBuckets(Context<Cuda>& context, std::span<const std::uint64_t> key, int cellShift,
                                        int dimensions) {
  if (key.empty()) return {0};
  const auto n = static_cast<std::uint32_t>(key.size());
  std::array<std::uint32_t, maxLevels> starts;
  auto* onDevice = static_cast<std::uint32_t*>(context.scratch(sizeof starts));
  clearBytes(context, onDevice, sizeof starts);
  constexpr unsigned maxBlocks = 132 * 8;
  const unsigned blocks = std::min(blocksFor(n, 8 * blockSize), maxBlocks);
  launch(context, blocks, blockSize, 0, countStarts, key.data(), n, cellShift, dimensions, onDevice);
  copyBytesToHost(context, onDevice, starts.data(), sizeof starts);

  std::uint32_t last = 1;  // the first particle starts a bucket at all levels
  for (std::uint32_t s : starts) last += s;
  std::vector<std::uint32_t> counts{last};
  for (int l = 0; counts.back() > 1; ++l) counts.push_back(counts.back() - starts[l]);
  return counts;
}

/// begin = indices of the keys that start a run above the lowest `shift` bits. One thread per key in each of two
/// loops, a sum over all between them; atomics no. `number`: workspace.
void findRuns(Context<Cuda>& context, std::span<const std::uint64_t> key, int shift,
              Buffer<std::uint32_t, Cuda>& number, Buffer<std::uint32_t, Cuda>& begin) {
  number.resize(context, key.size());
  forEach(context, key.size(), [key = key.data(), shift, number = number.data()] __device__(std::size_t i) {
    number[i] = startsRun(key, i, shift);
  });
  sumBefore(context, number.span());
  forEach(context, key.size(),
          [key = key.data(), shift, number = number.data(), begin = begin.data()] __device__(std::size_t i) {
            if (startsRun(key, i, shift)) begin[number[i]] = static_cast<std::uint32_t>(i);
          });
}

/// One thread per bucket; reads its begin and the key there, writes its key; the first writes the end of the level
/// below; atomics no.
void closeLevel(Context<Cuda>& context, std::span<const std::uint64_t> keyBelow,
                Buffer<std::uint32_t, Cuda>& begin, std::uint64_t* key) {
  const std::size_t count = begin.size() - 1;
  const auto below = static_cast<std::uint32_t>(keyBelow.size());
  forEach(context, std::max<std::size_t>(count, 1),
          [count, below, key, keyBelow = keyBelow.data(), begin = begin.data()] __device__(std::size_t b) {
            if (b == 0) begin[count] = below;
            if (b < count) key[b] = keyBelow[begin[b]];
          });
}

/// One warp per bucket; reads the bucket's range, writes its number for each of its particles; atomics no.
__global__ void __launch_bounds__(blockSize)
    fillBucketOf(const std::uint32_t* begin, std::uint32_t count, std::uint32_t* bucketOf) {
  const std::uint32_t b = blockIdx.x * (blockSize / 32) + threadIdx.x / 32;
  if (b >= count) return;
  const std::uint32_t end = begin[b + 1];
  for (std::uint32_t i = begin[b] + threadIdx.x % 32; i < end; i += 32) bucketOf[i] = b;
}

}  // namespace

void findBuckets(Context<Cuda>& context, std::span<const std::uint64_t> key, int cellShift, int dimensions,
                 BucketLevels<Cuda>& levels, std::size_t mostLevels) {
  std::vector<std::uint32_t> counts = countBuckets(context, key, cellShift, dimensions);
  if (counts.size() > mostLevels) counts.resize(mostLevels);
  levels.begin.resize(counts.size());
  // Keys of one level's buckets and of the next one's, in turns.
  Buffer<std::uint64_t, Cuda> even(context, counts[0]), odd(context, counts.size() > 1 ? counts[1] : 0);
  Buffer<std::uint32_t, Cuda> number;
  std::span<const std::uint64_t> below = key;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    Buffer<std::uint32_t, Cuda>& begin = levels.begin[level];
    Buffer<std::uint64_t, Cuda>& own = level % 2 == 0 ? even : odd;
    begin.resize(context, counts[level] + std::size_t{1});
    const int shift = cellShift + static_cast<int>(level) * dimensions;
    if (!below.empty()) findRuns(context, below, shift, number, begin);
    closeLevel(context, below, begin, own.data());
    below = {own.data(), counts[level]};
  }

  levels.bucketOf.resize(context, key.size());
  launch(context, blocksFor(counts[0], blockSize / 32), blockSize, 0, fillBucketOf, levels.begin[0].data(),
         counts[0], levels.bucketOf.data());
}

}  // namespace treacle
