#include "treacle/precondition/staged_lists.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "precondition/acting.cuh"
#include "precondition/staged_sums.cuh"
#include "treacle/core/halo.hpp"

namespace treacle {
namespace {

constexpr unsigned slice = nearSlice;
constexpr std::uint32_t nobody = 0xffffffff;

/// What the rows are made of, and where they are written.
template <int D, class Word>
struct StagedRows {
  NearView<D, float, AccurateScheme> near;
  bool hasInner;         // some blocks have no ghosts, and that counts
  std::uint32_t ownEnd;  // of the walls
  Renormalised<D> tensors;
  float reach2;    // in the unit of near
  float unit;      // of differences [m]
  float perShape;  // units of the elements in what gradientShape and a difference make
  std::uint32_t *member, *memberCount;
  std::uint64_t *start, *place;
  Word *column, *row;
  Gathered<D, float>* own;

  __device__ bool within(std::uint32_t i, std::uint32_t j, const Vec<D, float>& d) const {
    return j != i && norm2(d) < reach2;
  }
  __device__ bool isGhost(std::uint32_t k) const { return k < near.fluidCount ? k >= near.ownFluid : k >= ownEnd; }
};

/// f(is there one, j, x_j - x_i) for the entries of the row of particle i in NearProducts, which `Split` threads
/// side by side take in turns; all of them call f together.
template <class Split, int D, class F>
__device__ inline void forEachEntry(const NearLists<D, float>& near, std::uint32_t i, F&& f) {
  constexpr int batch = 4;  // so many neighbours are on their way together
  const std::uint64_t begin = near.sliceStart[i / slice];
  const auto rows = static_cast<int>(near.sliceStart[i / slice + 1] - begin);
  const std::uint32_t* mine = near.entry + begin * slice + i % slice;
  const int4 here = near.own(i);
  const int part = static_cast<int>(threadIdx.x % Split::value);
  for (int first = 0; first < rows; first += batch * Split::value) {
    const auto rowOf = [&](int b) { return first + b * Split::value + part; };
    std::uint32_t j[batch];
    int4 there[batch];
#pragma unroll
    for (int b = 0; b < batch; ++b) j[b] = rowOf(b) < rows ? mine[std::size_t{slice} * rowOf(b)] : i;
#pragma unroll
    for (int b = 0; b < batch; ++b) there[b] = near.other(j[b]);
#pragma unroll
    for (int b = 0; b < batch; ++b) f(rowOf(b) < rows, j[b], near.difference(there[b], here));
  }
}

/// Who a block needs, in shared memory: while they are collected an open hash table, then in ascending order, so
/// that those who follow each other are fetched together.
template <std::uint32_t Capacity>
struct MemberTable {
  static constexpr std::uint32_t slots = Capacity <= 512 ? 1024 : 2048;
  std::uint32_t key[slots];
  std::uint32_t count, torn;

  __device__ static std::uint32_t read(const std::uint32_t& x) {
    return *static_cast<const volatile std::uint32_t*>(&x);
  }
  __device__ void clear() {
    for (unsigned s = threadIdx.x; s < slots; s += blockDim.x) key[s] = nobody;
    if (threadIdx.x == 0) count = torn = 0;
    __syncthreads();
  }
  __device__ void insert(std::uint32_t k) {
    for (std::uint32_t s = k * 2654435761u >> 16; !read(torn); ++s) {
      std::uint32_t there = read(key[s % slots]);  // most are there already
      if (there == nobody) {
        there = atomicCAS(&key[s % slots], nobody, k);
        if (there == nobody && atomicAdd(&count, 1) >= Capacity) atomicExch(&torn, 1);
      }
      if (there == nobody || there == k) return;
    }
  }
  /// By a bitonic network; the empty slots come last.
  __device__ void sort() {
    for (std::uint32_t run = 2; run <= slots; run *= 2)
      for (std::uint32_t step = run / 2; step > 0; step /= 2) {
        for (std::uint32_t n = threadIdx.x; n < slots / 2; n += blockDim.x) {
          const std::uint32_t a = n / step * 2 * step + n % step, b = a + step;
          const std::uint32_t first = key[a], second = key[b];
          if ((first > second) == ((a & run) == 0)) key[a] = second, key[b] = first;
        }
        __syncthreads();
      }
  }
};

/// Where k stands among `count` ascending numbers, of which it is one.
__device__ inline std::uint32_t placeAmong(const std::uint32_t* sorted, std::uint32_t count, std::uint32_t k) {
  std::uint32_t first = 0;
  while (count > 1) {
    const std::uint32_t half = count / 2;
    if (sorted[first + half] <= k) first += half;
    count -= half;
  }
  return first;
}

/// A block per block of particles, `split` threads for each of them; reads the rows of NearProducts and positions,
/// writes the block's members and the lengths of its slices' rows. Atomics in shared memory, on which the result
/// does not depend.
template <class Split, int D, class Word>
__global__ void __launch_bounds__(StagedLists<D>::threads)
    membersKernel(const Split split, const __grid_constant__ StagedRows<D, Word> out) {
  constexpr std::uint32_t particles = StagedLists<D>::threads / Split::value,
                          capacity = StagedLists<D>::capacity(Split::value);
  __shared__ MemberTable<capacity> table;
  __shared__ std::uint32_t longest[particles / slice];
  if (threadIdx.x < particles / slice) longest[threadIdx.x] = 0;
  table.clear();
  const auto& near = out.near;
  const std::uint32_t index = blockIdx.x * particles + threadIdx.x / split, i = min(index, near.activeCount - 1);
  if (threadIdx.x % split == 0) table.insert(i);
  int count = 0;
  forEachEntry<Split>(near, i, [&](bool exists, std::uint32_t j, const Vec<D, float>& d) {
    if (exists && out.within(i, j, d)) table.insert(j), ++count;
  });
  atomicMax(&longest[threadIdx.x / split / slice], static_cast<std::uint32_t>(splitSum(count, split)));
  __syncthreads();
  const bool torn = table.torn;
  bool ghosts = !out.hasInner;
  for (unsigned s = threadIdx.x; s < table.slots && !ghosts; s += blockDim.x)
    ghosts = table.key[s] != nobody && out.isGhost(table.key[s]);
  const bool inner = !__syncthreads_or(ghosts);
  if (threadIdx.x == 0)
    out.memberCount[blockIdx.x] =
        torn ? StagedView<D, Word>::torn : table.count | (inner ? StagedView<D, Word>::inner : 0);
  if (threadIdx.x < particles / slice) {
    const std::uint32_t s = blockIdx.x * (particles / slice) + threadIdx.x;
    if (s * slice < near.activeCount)
      out.start[s] = torn ? (near.sliceStart[s + 1] - near.sliceStart[s] + 3) / 4 : (longest[threadIdx.x] + 3) / 4;
  }
  std::uint32_t* member = out.member + std::size_t{capacity} * blockIdx.x;
  if (!torn) table.sort();
  for (unsigned k = threadIdx.x; k < capacity; k += blockDim.x)
    member[k] = !torn && k < table.count ? table.key[k] : i;  // there is always somebody to be fetched
}

/// The same; reads positions, B and members, writes the rows. No atomics.
template <class Split, int D, class Word>
__global__ void __launch_bounds__(StagedLists<D>::threads)
    rowsKernel(const Split split, const __grid_constant__ MphPairs<D> pairs,
               const __grid_constant__ StagedRows<D, Word> out) {
  constexpr std::uint32_t particles = StagedLists<D>::threads / Split::value,
                          capacity = StagedLists<D>::capacity(Split::value);
  __shared__ std::uint32_t member[capacity];
  const auto& near = out.near;
  const std::uint32_t marked = out.memberCount[blockIdx.x], members = marked & ~StagedView<D, Word>::inner;
  const bool torn = marked == StagedView<D, Word>::torn;
  for (unsigned k = threadIdx.x; !torn && k < members; k += blockDim.x)
    member[k] = out.member[std::size_t{capacity} * blockIdx.x + k];
  __syncthreads();
  const std::uint32_t index = blockIdx.x * particles + threadIdx.x / split, i = min(index, near.activeCount - 1);
  const bool writes = index == i;
  const int part = static_cast<int>(threadIdx.x % split);
  const unsigned team = splitLanes(split);
  const std::uint64_t start = out.start[i / slice];
  const auto length = static_cast<std::uint32_t>(4 * (out.start[i / slice + 1] - start));
  const auto write = [&](std::uint32_t n, std::uint32_t place, Word column, Word row) {
    const std::uint64_t at = 4 * ((start + n / 4) * slice + i % slice) + n % 4;
    if (!writes) return;
    reinterpret_cast<std::uint16_t*>(out.place)[at] = static_cast<std::uint16_t>(place);
    out.column[at] = column;
    out.row[at] = row;
  };
  const SymmetricBlock<D, float> b = converted<float>(out.tensors.of(i));
  Vec<D, float> own{};
  std::uint32_t n = 0;
  forEachEntry<Split>(near, i, [&](bool exists, std::uint32_t j, const Vec<D, float>& d) {
    const bool counts = exists && out.within(i, j, d), written = torn ? exists : counts;
    const unsigned all = __ballot_sync(~0u, written) & team;
    if (written) {
      const Vec<D, float> g = counts ? out.perShape * gradientShape(near, d) * d : Vec<D, float>{};
      const Vec<D> way = out.unit * converted<double>(d);
      const Word row = packElement<D, Word>(acting(pairs, i, j, way, b * g));
      own += inUnits<D, Word>(unpackElement<D>(row));
      write(n + __popc(all & ((1u << threadIdx.x % 32) - 1)), torn ? 0 : placeAmong(member, members, j),
            packElement<D, Word>(acting(pairs, i, j, way, converted<float>(out.tensors.of(j)) * g)), row);
    }
    n += __popc(all);
  });
  for (int k = 0; k < D; ++k) own[k] = splitSum(own[k], split);
  if (part == 0 && writes && i < near.fluidCount) out.own[i] = own;
  const Word zero = packElement<D, Word>(Vec<D, float>{});
  for (n += part; n < length; n += split) write(n, 0, zero, zero);
}

}  // namespace

template <int D>
template <class Word>
void StagedLists<D>::makeRows(Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                              double reach) {
  const std::uint32_t slices = blocksFor(pairs.activeCount, slice);
  const unsigned blocks = blocksFor(pairs.activeCount, threads / sharing_);
  member_.resize(context, std::size_t{capacity(sharing_)} * blocks);
  memberCount_.resize(context, blocks);
  start_.resize(context, std::size_t{slices} + 1);
  own_.resize(context, pairs.fluidCount);
  unit_ = largestElement(pairs) / ElementBits<D, Word>::largest;
  StagedRows<D, Word> rows{};
  rows.near = NearView<D, float, AccurateScheme>::make(pairs, near, pairs.terms.with(AccurateScheme{}));
  const float length = static_cast<float>(reach) * rows.near.mph.pressureRadius;
  rows.reach2 = length * length;
  rows.unit = static_cast<float>(LocalPositions<D, float>::unit(pairs));
  rows.perShape = static_cast<float>(pairs.terms.gradientFactor / unit_);
  rows.tensors = {pairs.renormalisation, pairs.fluidCount};
  rows.hasInner = context.halo && !context.halo->sentFluid.empty();
  rows.ownEnd = pairs.ownEnd();
  rows.member = member_.data(), rows.memberCount = memberCount_.data(), rows.start = start_.data();
  withSharing(*this, [&](auto split) {
    using Split = decltype(split);
    launch(context, blocks, threads, 0, membersKernel<Split, D, Word>, split, rows);
    const std::uint64_t room = startRows(context, start_) * slice;
    place_.resize(context, room);
    for (auto* elements : {&column_, &row_}) elements->resize(context, sizeof(Word) * room);
    rows.place = place_.data(), rows.own = own_.data();
    rows.column = reinterpret_cast<Word*>(column_.data()), rows.row = reinterpret_cast<Word*>(row_.data());
    launch(context, blocks, threads, 0, rowsKernel<Split, D, Word>, split, pairs, rows);
  });
}

template <int D>
void StagedLists<D>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                             double reach, bool wide) {
  sharing_ = sharing(pairs.fluidCount);
  wide_ = wide;
  wide ? makeRows<std::uint64_t>(context, pairs, near, reach)
       : makeRows<std::uint32_t>(context, pairs, near, reach);
}

template class StagedLists<2>;
template class StagedLists<3>;

}  // namespace treacle
