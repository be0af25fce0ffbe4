#pragma once

#include "mph/near_sums.cuh"
#include "treacle/precondition/projection_terms.hpp"
#include "treacle/precondition/staged_lists.hpp"

namespace treacle {

/// C q and C^T u with B, in single precision, from elements in few bits and what a block brings of its neighbours
/// to shared memory (StagedLists).

/// Four elements of a row, and where their columns are.
template <class Word>
struct StagedFour {
  Word element[4];
  std::uint64_t places;

  __device__ void load(const Word* elements, const std::uint64_t* place, std::size_t at) {
    constexpr int parts = sizeof(element) / sizeof(uint4);
    const uint4* from = reinterpret_cast<const uint4*>(elements) + parts * at;
    for (int k = 0; k < parts; ++k) reinterpret_cast<uint4*>(element)[k] = from[k];
    places = place[at];
  }
};

/// One block of a product: this thread's share of the row of one of its particles. What is made here is on its way
/// before the kernel waits for earlier ones, since none of these has made the lists.
template <class Split, int D, class Word>
class StagedBlock {
 public:
  static constexpr unsigned threads = StagedLists<D>::threads, particles = threads / Split::value;
  static constexpr std::uint32_t capacity = StagedLists<D>::capacity(Split::value);

  /// `count`: particles that have rows; all lanes of a warp take part in a sum, with the last one beyond it.
  __device__ StagedBlock(const StagedView<D, Word>& lists, const Word* elements, std::uint32_t count)
      : lists_(lists),
        elements_(elements),
        index_(blockIdx.x * particles + threadIdx.x / Split::value),
        i_(min(index_, count - 1)),
        marked_(lists.memberCount[blockIdx.x]),
        members_(marked_ & ~StagedView<D, Word>::inner) {
#pragma unroll
    for (unsigned k = 0; k < early; ++k) member_[k] = member(k);
    const std::uint64_t start = lists.start[i_ / nearSlice];
    first_ = start * nearSlice + i_ % nearSlice;
    quads_ = static_cast<int>(lists.start[i_ / nearSlice + 1] - start);
#pragma unroll
    for (int k = 0; k < ahead; ++k) load(four_[k], part() + k * Split::value);
  }

  /// Until what the block reads is there. Ghosts may be on their way: blocks that have none go ahead, but for the
  /// last one.
  __device__ void waitForNeighbours() const {
    if (isTorn() || marked_ == members_ || blockIdx.x + 1 == gridDim.x)
      waitForEarlierKernels();
    else
      readBeforeEarlierKernelEnds();
  }

  __device__ std::uint32_t particle() const { return i_; }
  /// Whether this thread has the particle's sum to store.
  __device__ bool stores() const { return part() == 0 && index_ == i_; }

  /// Brings gathered(j) of all columns j to `staged`.
  template <class V, class Gather>
  __device__ void stage(V (&staged)[capacity], const Gather& gathered) const {
    if (isTorn()) return;
#pragma unroll
    for (unsigned first = 0; first < rounds; first += batch) {
      V value[batch];
#pragma unroll
      for (unsigned k = 0; k < batch && first + k < rounds; ++k)
        if (first * threads < members_)
          value[k] = gathered(first + k < early ? member_[first + k] : member(first + k));
#pragma unroll
      for (unsigned k = 0; k < batch && first + k < rounds; ++k) {
        const unsigned place = (first + k) * threads + threadIdx.x;
        if (place < members_) staged[place] = value[k];
      }
    }
    __syncthreads();
  }

  /// add(element, gathered of its column) along the share.
  template <class V, class Gather, class Add>
  __device__ void alongRow(const V (&staged)[capacity], const Gather& gathered, const Add& add) {
    if (isTorn()) {
      const std::uint32_t s = i_ / nearSlice, lane = i_ % nearSlice;
      const std::uint64_t begin = lists_.sliceStart[s];
      const auto rows = static_cast<int>(lists_.sliceStart[s + 1] - begin);
      for (int r = part(); r < rows; r += Split::value)
        add(unpackElement<D>(elements_[4 * (first_ + std::size_t{nearSlice} * (r / 4)) + r % 4]),
            gathered(lists_.entry[(begin + r) * nearSlice + lane]));
      return;
    }
    constexpr int stride = ahead * Split::value;
#pragma unroll 1
    for (int q = part(); q < quads_; q += stride)
#pragma unroll
      for (int a = 0; a < ahead; ++a) {
        const StagedFour<Word> four = four_[a];
        if (a > 0 && q + a * Split::value >= quads_) break;
        load(four_[a], q + a * Split::value + stride);
#pragma unroll
        for (int k = 0; k < 4; ++k)
          add(unpackElement<D>(four.element[k]),
              staged[static_cast<std::uint32_t>(four.places >> 16 * k) & 0xffff]);
      }
  }

 private:
  // Rounds in which a block's threads bring a neighbour each, four of them at a time; those whose neighbours are
  // known early, and fours of a row that are on their way at a time: where threads are few they wait, else they
  // hide the wait.
  static constexpr unsigned rounds = (capacity + threads - 1) / threads, batch = 4,
                            early = rounds < batch ? rounds : batch;
  static constexpr int ahead = Split::value > 1 ? 2 : 1;

  __device__ bool isTorn() const { return marked_ == StagedView<D, Word>::torn; }
  __device__ static int part() { return static_cast<int>(threadIdx.x % Split::value); }
  __device__ std::uint32_t member(unsigned round) const {
    const unsigned place = round * threads + threadIdx.x;
    return lists_.member[std::size_t{capacity} * blockIdx.x + (place < capacity ? place : 0)];
  }
  __device__ void load(StagedFour<Word>& four, int q) const {
    if (q < quads_) four.load(elements_, lists_.place, first_ + std::size_t{nearSlice} * q);
  }

  const StagedView<D, Word>& lists_;
  const Word* elements_;
  std::uint32_t index_, i_, marked_, members_, member_[early];
  std::size_t first_;
  int quads_;
  StagedFour<Word> four_[ahead];
};

/// `split` threads per own fluid particle: store(i, (C q)_i); reads elements and q of the neighbours. No atomics.
template <class Split, int D, class Word, class Store>
__global__ void __launch_bounds__(256)
    stagedGradientKernel(const Split split, const __grid_constant__ StagedView<D, Word> lists,
                         const ScalarField<float, Cuda> q, const __grid_constant__ Store store) {
  __shared__ float staged[StagedBlock<Split, D, Word>::capacity];
  StagedBlock<Split, D, Word> block(lists, lists.column, lists.ownFluid);
  const std::uint32_t i = block.particle();
  const Vec<D, float> own = fetch(&lists.own[i]);
  block.waitForNeighbours();
  decltype(ownOf(store, i)) owned{};  // where threads are few; many hide the wait, and want registers
  if constexpr (Split::value > 1) owned = ownOf(store, i);
  const float mine = q[i];
  const auto gathered = [&](std::uint32_t j) { return q[j]; };
  block.stage(staged, gathered);
  Vec<D, float> sum{};
  block.alongRow(staged, gathered,
                 [&](const Vec<D, float>& element, float qj) { addScaled(&sum[0], qj, element); });
  sum = inUnits<D, Word>(sum);
  for (int k = 0; k < D; ++k) sum[k] = splitSum(sum[k], split);
  if (!block.stores()) return;
  if constexpr (Split::value == 1) owned = ownOf(store, i);
  addScaled(&sum[0], mine, own);
  put(store, i, lists.unit * sum, owned);
}

/// `split` threads per particle: store(k, (C^T u)_k), walls at rest; reads elements and u of the neighbours. No
/// atomics.
template <class Split, int D, class Word, class Store>
__global__ void __launch_bounds__(256)
    stagedDivergenceKernel(const Split split, const __grid_constant__ StagedView<D, Word> lists,
                           const VectorField<D, float, Cuda> u, const __grid_constant__ Store store) {
  __shared__ Gathered<D, float> staged[StagedBlock<Split, D, Word>::capacity];
  StagedBlock<Split, D, Word> block(lists, lists.row, lists.activeCount);
  const std::uint32_t k = block.particle();
  const Vec<D, float> own = k < lists.fluidCount ? fetch(&lists.own[k]) : Vec<D, float>{};
  block.waitForNeighbours();
  decltype(ownOf(store, k)) owned{};
  if constexpr (Split::value > 1) owned = ownOf(store, k);
  const Vec<D, float> mine = fetch(&u.at[k]);
  const auto gathered = [&](std::uint32_t j) -> Gathered<D, float> { return inUnits<D, Word>(fetch(&u.at[j])); };
  block.stage(staged, gathered);
  float sum = 0;
  block.alongRow(staged, gathered, [&](const Vec<D, float>& element, const Gathered<D, float>& uj) {
    sum -= dot(element, fetch(&uj));
  });
  sum = splitSum(sum, split);
  if (!block.stores()) return;
  if constexpr (Split::value == 1) owned = ownOf(store, k);
  put(store, k, lists.unit * (sum + dot(own, mine)), owned);
}

/// Calls f(split) with how many threads share a row.
template <int D, class F>
void withSharing(const StagedLists<D>& lists, F&& f) {
  if (lists.sharing() == 8) {
    if constexpr (D == 3) f(Threads<8>{});
  } else if (lists.sharing() == 4) {
    f(Threads<4>{});
  } else {
    f(Threads<1>{});
  }
}

template <int D, class Store>
void stagedGradient(const Context<Cuda>& context, const StagedLists<D>& lists, const MphPairs<D>& pairs,
                    const NearProducts<D>& near, ScalarField<float, Cuda> q, const Store& store) {
  withSharing(lists, [&](auto split) {
    lists.withView(pairs, near, [&]<class Word>(const StagedView<D, Word>& view) {
      constexpr unsigned threads = StagedLists<D>::threads;
      launchEarly(context, blocksFor(std::size_t{view.ownFluid} * split, threads), threads, 0,
                  stagedGradientKernel<decltype(split), D, Word, Store>, split, view, q, store);
    });
  });
}
template <int D, class Store>
void stagedDivergence(const Context<Cuda>& context, const StagedLists<D>& lists, const MphPairs<D>& pairs,
                      const NearProducts<D>& near, VectorField<D, float, Cuda> u, const Store& store) {
  withSharing(lists, [&](auto split) {
    lists.withView(pairs, near, [&]<class Word>(const StagedView<D, Word>& view) {
      constexpr unsigned threads = StagedLists<D>::threads;
      launchEarly(context, blocksFor(std::size_t{view.activeCount} * split, threads), threads, 0,
                  stagedDivergenceKernel<decltype(split), D, Word, Store>, split, view, u, store);
    });
  });
}

}  // namespace treacle
