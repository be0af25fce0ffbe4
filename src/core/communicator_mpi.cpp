#include "treacle/core/communicator.hpp"

#include "treacle/core/timer.hpp"

#include <mpi.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace treacle {
namespace {

/// A single message has at most so many bytes: MPI counts in int.
constexpr std::size_t longestMessage = std::size_t{1} << 30;

/// Whether something that starts processes together has started this one. Without, MPI could be started as well,
/// but that takes a tenth of a second and may fail where there are no networks to look for.
bool isStartedByLauncher() {
  constexpr const char* names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK", "MPI_LOCALNRANKS"};
  return std::any_of(std::begin(names), std::end(names), [](const char* name) { return std::getenv(name); });
}

/// MPI ends the job by itself where a call fails (MPI_ERRORS_ARE_FATAL), so results need not be looked at.
template <class F>
void forEachPiece(std::span<const Communicator::Message> messages, F&& f) {
  for (const Communicator::Message& m : messages)
    for (std::size_t at = 0; at < m.bytes; at += longestMessage)
      f(static_cast<char*>(m.data) + at, static_cast<int>(std::min(longestMessage, m.bytes - at)), m.rank);
}

}  // namespace

Communicator Communicator::ofJob() {
  Communicator job;
  if (!isStartedByLauncher()) return job;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  job.ownsMpi_ = true;
  MPI_Comm_rank(MPI_COMM_WORLD, &job.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &job.size_);
  MPI_Comm host;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
  MPI_Comm_rank(host, &job.localRank_);
  MPI_Comm_free(&host);
#ifdef MPIX_CUDA_AWARE_SUPPORT
  job.takesDeviceMemory_ = MPIX_Query_cuda_support() == 1;
#endif
  return job;
}

Communicator::Communicator(Communicator&& other) noexcept
    : rank_(other.rank_),
      size_(other.size_),
      localRank_(other.localRank_),
      takesDeviceMemory_(other.takesDeviceMemory_),
      ownsMpi_(std::exchange(other.ownsMpi_, false)) {}

Communicator::~Communicator() {
  if (ownsMpi_) MPI_Finalize();
}

void Communicator::allGather(const void* own, void* all, std::size_t bytes) const {
  if (size_ == 1) {
    if (bytes > 0) std::memcpy(all, own, bytes);
    return;
  }
  const int count = static_cast<int>(bytes);
  Timer timer;
  MPI_Allgather(own, count, MPI_BYTE, all, count, MPI_BYTE, MPI_COMM_WORLD);
  traffic_.seconds += timer.lap();
  ++traffic_.calls;
  traffic_.bytes += bytes * (size_ - 1);
}

void Communicator::broadcastBytes(void* data, std::size_t bytes, int root) const {
  if (size_ == 1) return;
  MPI_Bcast(data, static_cast<int>(bytes), MPI_BYTE, root, MPI_COMM_WORLD);
  if (rank_ == root) traffic_.bytes += bytes * (size_ - 1);
}

void Communicator::exchange(std::span<const Message> sent, std::span<const Message> received) const {
  Timer timer;
  std::vector<MPI_Request> requests;
  const auto next = [&] { return &requests.emplace_back(MPI_REQUEST_NULL); };
  constexpr int tag = 0;
  requests.reserve(sent.size() + received.size());
  forEachPiece(received, [&](void* data, int bytes, int rank) {
    MPI_Irecv(data, bytes, MPI_BYTE, rank, tag, MPI_COMM_WORLD, next());
  });
  forEachPiece(sent, [&](void* data, int bytes, int rank) {
    MPI_Isend(data, bytes, MPI_BYTE, rank, tag, MPI_COMM_WORLD, next());
    traffic_.bytes += static_cast<std::size_t>(bytes);
  });
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  traffic_.seconds += timer.lap();
  ++traffic_.calls;
}

Communicator::RankText Communicator::first(const std::string& own) const {
  const std::vector<std::size_t> lengths = all(own.size());
  const auto found = std::find_if(lengths.begin(), lengths.end(), [](std::size_t n) { return n > 0; });
  if (found == lengths.end()) return {};
  RankText result{static_cast<int>(found - lengths.begin()), own};
  result.text.resize(*found);
  broadcastBytes(result.text.data(), *found, result.rank);
  return result;
}

void Communicator::abort(const std::string& why, int exitCode) const {
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  std::fprintf(stderr, "treacle: error: rank %d of %d, on %s: %s; the whole job ends\n", rank_, size_, host,
               why.c_str());
  std::fflush(stderr);
  if (ownsMpi_) MPI_Abort(MPI_COMM_WORLD, exitCode);
  std::_Exit(exitCode);
}

}  // namespace treacle
