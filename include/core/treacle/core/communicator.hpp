#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace treacle {

/// The processes of a job, each known by its rank 0 ... size() - 1, and what they tell each other. All members but
/// those that return numbers of processes are collective: every process calls the same ones in the same order,
/// from the thread that made the communicator. Sums are formed in the order of ranks, so every process gets the
/// same bits, and gets them again in another run with as many processes. A communicator of one process, all that a
/// build without MPI has, does nothing but copy.
class Communicator {
 public:
  /// One process.
  Communicator() = default;
  /// The processes that mpirun, srun or the like have started together with this one; this one alone where nothing
  /// of the kind has, or the build has no MPI. Once per program; the end of the communicator is that of MPI.
  static Communicator ofJob();
  Communicator(Communicator&& other) noexcept;
  Communicator& operator=(Communicator&&) = delete;
  ~Communicator();

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Rank among the processes on the same host.
  int localRank() const { return localRank_; }
  /// Whether messages may be in the memory of a CUDA device.
  bool takesDeviceMemory() const { return takesDeviceMemory_; }

  /// Every process's value, in the order of ranks.
  template <class T>
  std::vector<T> all(const T& own) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(size_);
    allGather(&own, values.data(), sizeof(T));
    return values;
  }

  /// values[k] = sum of what all processes have there; equally many everywhere.
  template <class T>
  void sum(std::span<T> values) const {
    combine(values, [](T& sum, const T& value) { sum += value; });
  }
  /// flags[k]: whether any process has one.
  void anyOf(std::span<std::uint8_t> flags) const {
    combine(flags, [](std::uint8_t& any, std::uint8_t flag) { any |= flag; });
  }

  /// What every process has, one after the other in the order of ranks; at `root`, nothing at the others.
  template <class T>
  std::vector<T> collect(std::span<const T> own, int root = 0) const;

  /// to[r]: for rank r. Returns what came from each rank.
  template <class T>
  std::vector<std::vector<T>> swap(const std::vector<std::vector<T>>& to) const;

  /// [from][to], of a number that every process has for each one.
  std::vector<std::uint32_t> table(std::span<const std::uint32_t> to) const {
    std::vector<std::uint32_t> counts(to.size() * to.size());
    std::copy(to.begin(), to.end(), counts.begin() + static_cast<std::ptrdiff_t>(rank_ * to.size()));
    sum(std::span(counts));
    return counts;
  }

  /// The first text in the order of ranks that is not empty, with its rank; "" where all are.
  struct RankText {
    int rank = 0;
    std::string text;
  };
  RankText first(const std::string& own) const;

  /// values of `root`, everywhere.
  template <class T>
  void broadcast(T& value, int root = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    broadcastBytes(&value, sizeof(T), root);
  }

  /// Bytes for another process, or from it.
  struct Message {
    int rank;
    void* data;
    std::size_t bytes;
  };
  /// Sends and receives at once; between two processes messages keep their order.
  void exchange(std::span<const Message> sent, std::span<const Message> received) const;

  /// Ends all processes of the job, when one of them cannot go on and the others would wait for it: says on stderr
  /// which one, and why.
  [[noreturn]] void abort(const std::string& why, int exitCode) const;

  /// What this process has told the others so far, reductions included.
  struct Traffic {
    std::uint64_t bytes = 0, calls = 0;
    double seconds = 0;  // in exchanges and reductions, waiting included; not in broadcasts, where it may be idle
  };
  const Traffic& traffic() const { return traffic_; }
  /// Counts a message that went another way (DeviceLink).
  void note(std::size_t bytes) const { traffic_.bytes += bytes, ++traffic_.calls; }

 private:
  /// Arrays up to so many bytes are gathered whole; of longer ones each process combines a part for all.
  static constexpr std::size_t shortArray = 4096;

  void allGather(const void* own, void* all, std::size_t bytes) const;
  void broadcastBytes(void* data, std::size_t bytes, int root) const;
  std::size_t partBegin(std::size_t n, int rank) const { return n * rank / size_; }
  template <class T, class Add>
  void combine(std::span<T> values, Add&& add) const;

  int rank_ = 0, size_ = 1, localRank_ = 0;
  bool takesDeviceMemory_ = false;
  bool ownsMpi_ = false;  // ends it
  mutable Traffic traffic_;
};

template <class T, class Add>
void Communicator::combine(std::span<T> values, Add&& add) const {
  static_assert(std::is_trivially_copyable_v<T>);
  if (size_ == 1) return;
  const std::size_t n = values.size();
  if (values.size_bytes() <= shortArray) {
    std::vector<T> others(n * size_);
    allGather(values.data(), others.data(), values.size_bytes());
    std::copy_n(others.begin(), n, values.begin());
    for (std::size_t k = n; k < others.size(); ++k) add(values[k % n], others[k]);
    return;
  }
  const std::size_t begin = partBegin(n, rank_), length = partBegin(n, rank_ + 1) - begin;
  std::vector<T> parts(length * size_);
  std::vector<Message> sent, received;
  const auto forOthers = [&](auto&& f) {
    sent.clear(), received.clear();
    for (int r = 0; r < size_; ++r)
      if (r != rank_) f(r, values.subspan(partBegin(n, r), partBegin(n, r + 1) - partBegin(n, r)));
    exchange(sent, received);
  };
  std::copy_n(values.begin() + begin, length, parts.begin() + length * rank_);
  forOthers([&](int r, std::span<T> theirs) {
    sent.push_back({r, theirs.data(), theirs.size_bytes()});
    received.push_back({r, parts.data() + length * r, length * sizeof(T)});
  });
  std::copy_n(parts.begin(), length, values.begin() + begin);
  for (int r = 1; r < size_; ++r)
    for (std::size_t k = 0; k < length; ++k) add(values[begin + k], parts[length * r + k]);
  forOthers([&](int r, std::span<T> theirs) {
    sent.push_back({r, values.data() + begin, length * sizeof(T)});
    received.push_back({r, theirs.data(), theirs.size_bytes()});
  });
}

template <class T>
std::vector<T> Communicator::collect(std::span<const T> own, int root) const {
  const std::vector<std::size_t> counts = all(own.size());
  std::vector<T> whole(rank_ == root ? std::accumulate(counts.begin(), counts.end(), std::size_t{0}) : 0);
  std::vector<Message> sent, received;
  if (rank_ != root) sent.push_back({root, const_cast<T*>(own.data()), own.size_bytes()});
  std::size_t begin = 0;
  for (int r = 0; r < size_ && rank_ == root; begin += counts[r++]) {
    if (r == root)
      std::copy(own.begin(), own.end(), whole.begin() + begin);
    else
      received.push_back({r, whole.data() + begin, counts[r] * sizeof(T)});
  }
  exchange(sent, received);
  return whole;
}

template <class T>
std::vector<std::vector<T>> Communicator::swap(const std::vector<std::vector<T>>& to) const {
  std::vector<std::size_t> counts(std::size_t(size_) * size_);  // [from][to]
  for (int r = 0; r < size_; ++r) counts[std::size_t(rank_) * size_ + r] = to[r].size();
  sum(std::span(counts));
  std::vector<std::vector<T>> from(size_);
  std::vector<Message> sent, received;
  for (int r = 0; r < size_; ++r) {
    from[r].resize(counts[std::size_t(r) * size_ + rank_]);
    if (r == rank_) {
      from[r] = to[r];
      continue;
    }
    sent.push_back({r, const_cast<T*>(to[r].data()), to[r].size() * sizeof(T)});
    received.push_back({r, from[r].data(), from[r].size() * sizeof(T)});
  }
  exchange(sent, received);
  return from;
}

}  // namespace treacle
