#include "core/peer_exchange.cuh"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace treacle {
namespace {

using namespace peer;

/// Memory that other processes can open.
class Mailbox {
 public:
  explicit Mailbox(std::size_t bytes) {
    TREACLE_CUDA_CHECK(cudaMalloc(&memory_, bytes));
    TREACLE_CUDA_CHECK(cudaMemset(memory_, 0, bytes));
    TREACLE_CUDA_CHECK(cudaDeviceSynchronize());
  }
  Mailbox(const Mailbox&) = delete;
  ~Mailbox() {
    if (opened_.empty()) cudaFree(memory_);  // else others may have it open, too: it goes with the process
  }

  std::byte* data() const { return static_cast<std::byte*>(memory_); }
  cudaIpcMemHandle_t handle() const {
    cudaIpcMemHandle_t handle{};
    if (cudaIpcGetMemHandle(&handle, memory_) != cudaSuccess) cudaGetLastError();  // opening it will fail
    return handle;
  }
  /// Another process's; null where its device cannot be reached from this one.
  std::byte* open(const cudaIpcMemHandle_t& handle) {
    void* other = nullptr;
    if (cudaIpcOpenMemHandle(&other, handle, cudaIpcMemLazyEnablePeerAccess) == cudaSuccess)
      opened_.push_back(other);
    else
      cudaGetLastError();  // it must not meet the next call
    return static_cast<std::byte*>(other);
  }
  /// The other ones, which must be before their owners free them.
  void close() {
    for (void* other : std::exchange(opened_, {})) cudaIpcCloseMemHandle(other);
  }

 private:
  void* memory_ = nullptr;
  std::vector<void*> opened_;
};

class PeerLink final : public DeviceLink {
 public:
  /// Collective.
  PeerLink(const Communicator& job, const Context<Cuda>& context)
      : job_(job),
        context_(context),
        box_(slotBytes * job.size()),
        epochs_(context, mostBlocks * job.size()),
        spent_(context, 1) {
    clearBytes(context, epochs_.data(), epochs_.size() * sizeof(unsigned));
    clearBytes(context, spent_.data(), sizeof(Counters));
    peers_.spent = spent_.data();
    const std::vector<cudaIpcMemHandle_t> handles = job.all(box_.handle());
    peers_.rank = job.rank();
    for (int r = 0; r < job.size(); ++r) {
      if (r == job.rank()) continue;
      std::byte* const box = box_.open(handles[r]);
      canReachAll_ = canReachAll_ && box != nullptr;
      peers_.peer[peers_.count++] = {box + slotBytes * job.rank(), box_.data() + slotBytes * r,
                                     epochs_.data() + mostBlocks * r};
    }
    context.synchronize();
  }
  /// Mailboxes stay until nobody writes to them any more, and nobody has them open.
  void close() override {
    context_.synchronize();
    job_.all(char{});
    box_.close();
    job_.all(char{});
  }

  bool canReachAll() const { return canReachAll_; }

  void exchange(std::span<const Communicator::Message> sent,
                std::span<const Communicator::Message> received) override {
    PiecesOfRanks to(job_.size()), from(job_.size());
    for (const Communicator::Message& m : sent) to[m.rank].push_back({static_cast<std::byte*>(m.data), m.bytes});
    for (const Communicator::Message& m : received)
      from[m.rank].push_back({static_cast<std::byte*>(m.data), m.bytes});
    for (auto* all : {&to, &from})
      for (auto& pieces : *all) pieces = inRounds(pieces);
    run(to, from);
  }

  bool exchangeGathered(const void* field, std::size_t size, std::span<const Gathered> sent,
                        std::span<const Communicator::Message> received) override {
    PiecesOfRanks to(job_.size()), from(job_.size());
    auto* const data = static_cast<std::byte*>(const_cast<void*>(field));
    for (const Gathered& g : sent) to[g.rank].push_back({data, g.count * size, g.index, size});
    for (const Communicator::Message& m : received)
      from[m.rank].push_back({static_cast<std::byte*>(m.data), m.bytes});
    // A peer for which all fits in one round does not see whether the values were packed before.
    for (auto* all : {&to, &from})
      for (const auto& pieces : *all)
        if (pieces.size() > 2 || bytesOf(pieces) > capacity) return false;
    run(to, from);
    return true;
  }

  void sum(double* values, std::size_t count) override { join(values, count, Add{}); }
  void sum(float* values, std::size_t count) override { join(values, count, Add{}); }
  void sum(std::uint32_t* values, std::size_t count) override { join(values, count, Add{}); }
  void max(std::uint8_t* flags, std::size_t count) override { join(flags, count, Larger{}); }

  bool canBeRecorded() const override { return true; }
  std::string name() const override { return "peer memory"; }
  Spent spent() const override {
    const auto now = valueOnHost(context_, spent_.data());
    return {now.bytes, now.calls, 1e-9 * static_cast<double>(now.inside), 1e-9 * static_cast<double>(now.waiting)};
  }

 private:
  using PiecesOfRanks = std::vector<std::vector<Round::Piece>>;

  static std::size_t bytesOf(const std::vector<Round::Piece>& pieces) {
    std::size_t bytes = 0;
    for (const Round::Piece& p : pieces) bytes += padded(p.bytes);
    return bytes;
  }
  /// Two for each round. What is too long for one goes piece by piece.
  static std::vector<Round::Piece> inRounds(const std::vector<Round::Piece>& pieces) {
    if (pieces.size() <= 2 && bytesOf(pieces) <= capacity) return pieces;
    std::vector<Round::Piece> rounds;
    for (const Round::Piece& p : pieces)
      for (std::size_t begin = 0; begin < p.bytes; begin += capacity) {
        rounds.push_back({p.data + begin, std::min(capacity, p.bytes - begin)});
        rounds.push_back({});
      }
    return rounds;
  }
  static void take(const std::vector<Round::Piece>& rounds, std::size_t round,
                   std::array<Round::Piece, 2>& pieces) {
    for (std::size_t k = 0; k < 2; ++k)
      if (2 * round + k < rounds.size()) pieces[k] = rounds[2 * round + k];
  }

  /// A pair of processes has as many rounds on both sides.
  void run(const PiecesOfRanks& to, const PiecesOfRanks& from) {
    for (std::size_t round = 0;; ++round) {
      Exchange e{.peer = {}, .round = {}, .bytes = 0, .spent = spent_.data()};
      unsigned count = 0, blocks = 0;
      for (int p = 0; p < peers_.count; ++p) {
        const int r = rankOf(p);
        if (2 * round >= std::max(to[r].size(), from[r].size())) continue;
        e.peer[count] = peers_.peer[p];
        take(to[r], round, e.round[count].sent);
        take(from[r], round, e.round[count].received);
        e.bytes += e.round[count].sent[0].bytes + e.round[count].sent[1].bytes;
        blocks =
            std::max({blocks, Round::blocksOf(e.round[count].sent), Round::blocksOf(e.round[count].received)});
        ++count;
      }
      if (count == 0) break;
      launchEarly(context_, dim3(blocks, count), threads, 0, exchangeKernel, e);
    }
  }

  int rankOf(int peer) const { return peer < job_.rank() ? peer : peer + 1; }

  template <class T, class Join>
  void join(T* values, std::size_t count, Join how) {
    constexpr std::size_t most = capacity / sizeof(T);
    for (std::size_t first = 0; first < count; first += most) {
      const std::size_t n = std::min(most, count - first);
      launchEarly(context_, std::min(blocksFor(n, threads), mostBlocks), threads, 0, joinKernel<T, Join>, peers_,
                  values + first, n, how);
    }
  }

  const Communicator& job_;
  const Context<Cuda>& context_;
  Mailbox box_;
  Buffer<unsigned, Cuda> epochs_;
  Buffer<Counters, Cuda> spent_;
  Peers peers_{};
  bool canReachAll_ = true;
};

}  // namespace

std::unique_ptr<DeviceLink> makePeerLink(const Communicator& job, const Context<Cuda>& context) {
  const std::vector<int> local = job.all(job.localRank());
  const int hosts = static_cast<int>(std::count(local.begin(), local.end(), 0));
  if (hosts > 1 || job.size() - 1 > mostPeers) return nullptr;
  auto link = std::make_unique<PeerLink>(job, context);
  const std::vector<std::uint8_t> all = job.all(std::uint8_t{link->canReachAll()});
  if (std::count(all.begin(), all.end(), 0) == 0) return link;
  link->close();
  return nullptr;
}

}  // namespace treacle
