#pragma once

#include "core/device_link.hpp"
#include "core/launch.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// What devices of one host do to exchange through each other's memory (peer_link.cu): a kernel puts what it sends
// into the mailbox of its peer, says so by a flag there, waits for the flag of what it gets, and takes that out of
// its own mailbox. Nothing but kernels is launched, so a graph may have all of it, in the body of a loop, too.

namespace treacle::peer {

/// Every message is moved by several blocks, each a slice of its own with a flag of its own: so many suffice for
/// the latency, and more for the bandwidth of a long one.
inline constexpr unsigned fewBlocks = 32, mostBlocks = 128, threads = 512;
inline constexpr std::size_t shortMessage = std::size_t{512} << 10;
inline constexpr int mostPeers = 15;
/// Room for a message; longer ones go in pieces.
inline constexpr std::size_t capacity = std::size_t{16} << 20;
/// Flags of different blocks are in lines of their own.
inline constexpr std::size_t flagBytes = 64;
/// What a process has in its mailbox for each other one: flags, and two places for messages that take turns. When
/// the second next message is written, the peer has said that it began the next exchange, so it has taken out the
/// one before.
inline constexpr std::size_t slotBytes = mostBlocks * flagBytes + 2 * capacity;

/// As DeviceLink::Spent, by what the device counts; times in [ns].
struct Counters {
  unsigned long long bytes, calls, inside, waiting;
};
__device__ inline unsigned long long nanoseconds() {
  unsigned long long now;
  asm volatile("mov.u64 %0, %globaltimer;" : "=l"(now));
  return now;
}
/// Of one thread of one block, which stands for all of a kernel.
class Stopwatch {
 public:
  __device__ explicit Stopwatch(Counters* spent)
      : spent_(blockIdx.x + blockIdx.y + threadIdx.x == 0 ? spent : nullptr), start_(spent_ ? nanoseconds() : 0) {}
  __device__ void waits() { waits_ = spent_ ? nanoseconds() : 0; }
  __device__ void goesOn() const {
    if (spent_) spent_->waiting += nanoseconds() - waits_;
  }
  /// `bytes`: sent by all blocks of the kernel.
  __device__ void ends(std::size_t bytes) const {
    if (!spent_) return;
    spent_->inside += nanoseconds() - start_;
    spent_->bytes += bytes;
    ++spent_->calls;
  }

 private:
  Counters* spent_;
  unsigned long long start_, waits_ = 0;
};

struct Peer {
  std::byte *there, *here;  // slots: of this process in the peer's mailbox, of the peer in this one's
  unsigned* epoch;          // per block: number of the last exchange with the peer, the same for all of them

  __device__ static unsigned* flag(std::byte* slot, unsigned block) {
    return reinterpret_cast<unsigned*>(slot + block * flagBytes);
  }
  __device__ static std::byte* message(std::byte* slot, unsigned epoch) {
    return slot + mostBlocks * flagBytes + (epoch & 1) * capacity;
  }
  /// Everything that the block wrote before the last barrier can be seen by the peer, which waits for it.
  __device__ void signal(unsigned block, unsigned number) const {
    __threadfence_system();
    asm volatile("st.release.sys.global.u32 [%0], %1;" ::"l"(flag(there, block)), "r"(number) : "memory");
  }
  __device__ void await(unsigned block, unsigned number) const {
    unsigned seen;
    do {
      asm volatile("ld.acquire.sys.global.u32 %0, [%1];" : "=r"(seen) : "l"(flag(here, block)) : "memory");
    } while (static_cast<int>(seen - number) < 0);
  }
};

/// A round of an exchange with one peer: up to two pieces of memory each way, one behind the other in the mailbox.
/// What is sent is all of `data`, or, with `index`, its values of `size` bytes with these indices.
struct Round {
  struct Piece {
    std::byte* data = nullptr;
    std::size_t bytes = 0;
    const std::uint32_t* index = nullptr;
    std::size_t size = 0;
  };
  std::array<Piece, 2> sent, received;

  /// The same for who sends and who receives the pieces.
  TREACLE_HD static unsigned blocksOf(const std::array<Piece, 2>& pieces) {
    return pieces[0].bytes + pieces[1].bytes > shortMessage ? mostBlocks : fewBlocks;
  }
};
struct Exchange {
  Peer peer[mostPeers];
  Round round[mostPeers];
  std::size_t bytes;  // sent
  Counters* spent;
};

/// What another device may have written is read past the first-level cache.
template <class Word>
__device__ inline void copyWords(const std::byte* from, std::byte* to, std::size_t bytes) {
  for (std::size_t k = threadIdx.x; k < bytes / sizeof(Word); k += blockDim.x)
    reinterpret_cast<Word*>(to)[k] = __ldcg(reinterpret_cast<const Word*>(from) + k);
}
/// This block's slice of what `blocks` of them move: the same bytes for who sends and who receives it.
struct Slice {
  std::size_t begin, bytes;

  __device__ Slice(std::size_t whole, unsigned blocks) {
    const std::size_t length = padded((whole + blocks - 1) / blocks);
    begin = min(blockIdx.x * length, whole);
    bytes = min(length, whole - begin);
  }
};
__device__ inline void copySlice(const std::byte* from, std::byte* to, std::size_t whole, unsigned blocks) {
  const Slice slice(whole, blocks);
  const std::size_t bytes = slice.bytes;
  from += slice.begin, to += slice.begin;
  const std::size_t all = reinterpret_cast<std::size_t>(from) | reinterpret_cast<std::size_t>(to) | bytes;
  if (all % 16 == 0) return copyWords<uint4>(from, to, bytes);
  if (all % 4 == 0) return copyWords<unsigned>(from, to, bytes);
  copyWords<unsigned char>(from, to, bytes);
}

/// Words of a slice of values that are gathered, each of so many words.
template <class Word>
__device__ inline void gatherWords(const Round::Piece& piece, std::byte* to, unsigned blocks) {
  const Slice slice(piece.bytes, blocks);
  const auto* const from = reinterpret_cast<const Word*>(piece.data);
  const auto words = static_cast<std::uint32_t>(piece.size / sizeof(Word));
  const auto first = static_cast<std::uint32_t>(slice.begin / sizeof(Word)),
             last = first + static_cast<std::uint32_t>(slice.bytes / sizeof(Word));
  for (std::uint32_t k = first + threadIdx.x; k < last; k += blockDim.x) {
    const std::uint32_t value = words == 1 ? k : k / words;
    reinterpret_cast<Word*>(to)[k] = from[std::size_t{piece.index[value]} * words + (k - value * words)];
  }
}
__device__ inline void sendSlice(const Round::Piece& piece, std::byte* to, unsigned blocks) {
  if (!piece.index) return copySlice(piece.data, to, piece.bytes, blocks);
  const std::size_t all = reinterpret_cast<std::size_t>(piece.data) | piece.size;
  if (all % 16 == 0) return gatherWords<uint4>(piece, to, blocks);
  if (all % 8 == 0) return gatherWords<uint2>(piece, to, blocks);
  if (all % 4 == 0) return gatherWords<unsigned>(piece, to, blocks);
  gatherWords<unsigned char>(piece, to, blocks);
}

/// Blocks that had nothing to do this time count it, too: which of the two places is next must be the same for
/// all.
__device__ inline void countForIdleBlocks(const Peer& peer, unsigned number) {
  for (unsigned idle = gridDim.x + blockIdx.x; idle < mostBlocks; idle += gridDim.x) peer.epoch[idle] = number;
}

/// A row of blocks per peer, as many as the longest message has. What comes after may begin meanwhile.
static __global__ void __launch_bounds__(threads) exchangeKernel(const __grid_constant__ Exchange e) {
  waitForEarlierKernels();
  letNextKernelBegin();
  Stopwatch watch(e.spent);
  const Peer& peer = e.peer[blockIdx.y];
  const Round& round = e.round[blockIdx.y];
  const unsigned block = blockIdx.x, number = peer.epoch[block] + 1;
  const unsigned senders = Round::blocksOf(round.sent), receivers = Round::blocksOf(round.received);
  if (block < senders) {
    std::byte* const there = Peer::message(peer.there, number);
    sendSlice(round.sent[0], there, senders);
    sendSlice(round.sent[1], there + padded(round.sent[0].bytes), senders);
  }
  __syncthreads();
  if (threadIdx.x == 0) {
    if (block < senders) peer.signal(block, number);
    watch.waits();
    if (block < receivers) peer.await(block, number);
    watch.goesOn();
    peer.epoch[block] = number;
    countForIdleBlocks(peer, number);
  }
  __syncthreads();
  if (block < receivers) {
    const std::byte* const here = Peer::message(peer.here, number);
    copySlice(here, round.received[0].data, round.received[0].bytes, receivers);
    copySlice(here + padded(round.received[0].bytes), round.received[1].data, round.received[1].bytes, receivers);
  }
  watch.ends(e.bytes);
}

struct Peers {
  Peer peer[mostPeers];
  int count, rank;
  Counters* spent;
};

struct Add {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a + b;
  }
};
struct Larger {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a > b ? a : b;
  }
};

/// One thread per number and peer, then one per number: everybody's values joined in the order of ranks.
template <class T, class Join>
__global__ void __launch_bounds__(threads)
    joinKernel(const __grid_constant__ Peers peers, T* values, std::size_t count, Join join) {
  __shared__ unsigned numbers[mostPeers];  // of this exchange with each peer
  waitForEarlierKernels();
  Stopwatch watch(peers.spent);
  const unsigned block = blockIdx.x;
  if (threadIdx.x < static_cast<unsigned>(peers.count))
    numbers[threadIdx.x] = peers.peer[threadIdx.x].epoch[block] + 1;
  __syncthreads();
  const std::size_t first = block * std::size_t{blockDim.x} + threadIdx.x,
                    stride = std::size_t{gridDim.x} * blockDim.x;
  for (int p = 0; p < peers.count; ++p) {
    const Peer& peer = peers.peer[p];
    T* there = reinterpret_cast<T*>(Peer::message(peer.there, numbers[p]));
    for (std::size_t k = first; k < count; k += stride) there[k] = values[k];
  }
  __syncthreads();
  if (threadIdx.x < static_cast<unsigned>(peers.count)) {
    const Peer& peer = peers.peer[threadIdx.x];
    const unsigned number = numbers[threadIdx.x];
    peer.signal(block, number);
    watch.waits();
    peer.await(block, number);
    watch.goesOn();
    peer.epoch[block] = number;
    countForIdleBlocks(peer, number);
  }
  __syncthreads();
  for (std::size_t k = first; k < count; k += stride) {
    T joint{};
    for (int p = 0; p <= peers.count; ++p) {  // the peers in the order of ranks, this process between them
      if (p == peers.rank) joint = p == 0 ? values[k] : join(joint, values[k]);
      if (p == peers.count) break;
      const Peer& peer = peers.peer[p];
      const T theirs = __ldcg(reinterpret_cast<const T*>(Peer::message(peer.here, numbers[p])) + k);
      joint = p == 0 && peers.rank != 0 ? theirs : join(joint, theirs);
    }
    values[k] = joint;
  }
  watch.ends(count * sizeof(T) * peers.count);
}

}  // namespace treacle::peer
