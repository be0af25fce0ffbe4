#include "treacle/core/communicator.hpp"

#include <cstdio>
#include <cstdlib>

// Builds without MPI: there is one process.

namespace treacle {

Communicator Communicator::ofJob() { return {}; }
Communicator::Communicator(Communicator&& other) noexcept = default;
Communicator::~Communicator() = default;

void Communicator::allGather(const void* own, void* all, std::size_t bytes) const {
  if (bytes > 0) std::memcpy(all, own, bytes);
}
void Communicator::broadcastBytes(void*, std::size_t, int) const {}
void Communicator::exchange(std::span<const Message>, std::span<const Message>) const {}
Communicator::RankText Communicator::first(const std::string& own) const { return {0, own}; }

void Communicator::abort(const std::string& why, int exitCode) const {
  std::fprintf(stderr, "treacle: error: %s\n", why.c_str());
  std::fflush(stderr);
  std::_Exit(exitCode);
}

}  // namespace treacle
