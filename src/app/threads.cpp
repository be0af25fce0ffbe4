#include "threads.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/team.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace treacle {
namespace {

/// How many threads of so many, beside this one, the system starts: all of them live at the same time.
int startable(int count) {
  std::latch end(1);
  std::vector<std::jthread> threads;
  threads.reserve(static_cast<std::size_t>(count));
  try {
    while (static_cast<int>(threads.size()) < count) threads.emplace_back([&end] { end.wait(); });
  } catch (const std::system_error&) {
    // No more than these.
  }
  end.count_down();
  return static_cast<int>(threads.size());
}

void useThreads(int count) {
  if (count > 0) omp_set_num_threads(count);
  Team::fitToWork(count == 0 && !std::getenv("OMP_NUM_THREADS"));
}

}  // namespace

UsedThreads::UsedThreads(int count) : before_(omp_get_max_threads()) { useThreads(count); }
UsedThreads::~UsedThreads() { omp_set_num_threads(before_); }

void startThreads(int count) {
  useThreads(count);
  const int wanted = omp_get_max_threads();
  const char* origin = count > 0 ? "--threads" : "OMP_NUM_THREADS";
  if (wanted > mostThreads)
    throw InputError(fmt::format("{}: expected at most {} threads, found {}", origin, mostThreads, wanted));
  if (const int started = 1 + startable(wanted - 1); started < wanted)
    throw InputError(fmt::format("{} {}: this machine starts no more than {} threads; expected fewer", origin,
                                 wanted, started));
#pragma omp parallel
  {}
}

}  // namespace treacle
