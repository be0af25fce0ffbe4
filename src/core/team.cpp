#include "treacle/core/team.hpp"

#include <omp.h>

#include <exception>
#include <thread>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace treacle {
namespace {

/// How often a thread looks before it offers its core to others, some microseconds in all. Where there are more
/// threads than cores, the one that is waited for may be waiting for this core. Nobody sleeps: a step is short,
/// and to be woken takes longer than most loops.
constexpr int looks = 200;

template <class Condition>
void waitUntil(Condition&& condition) {
  for (int look = 0; !condition(); ++look) {
    if (look >= looks)
      std::this_thread::yield();
    else
#ifdef __x86_64__
      _mm_pause();
#else
      ;
#endif
  }
}

}  // namespace

void Team::lead(const std::function<void()>& body) {
  const int threads = omp_get_max_threads();
  if (threads == 1 || omp_in_parallel()) return body();
  Team team;
  std::exception_ptr failure;
#pragma omp parallel num_threads(threads)
  {
    const int thread = omp_get_thread_num();
    if (thread > 0) {
      team.serve(thread);
    } else {
      team.size_ = omp_get_num_threads();
      led_ = &team;
      try {
        body();
      } catch (...) {
        failure = std::current_exception();
      }
      led_ = nullptr;
      team.start(nullptr, nullptr);  // the end
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void Team::start(Call call, void* job) {
  led_ = nullptr;
  call_ = call;
  job_ = job;
  started_.store(started_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

void Team::finish() {
  const unsigned all = started_.load(std::memory_order_relaxed) * static_cast<unsigned>(size_ - 1);
  waitUntil([&] { return done_.load(std::memory_order_acquire) == all; });
  led_ = this;
}

void Team::serve(int thread) {
  for (unsigned next = 1;; ++next) {
    waitUntil([&] { return started_.load(std::memory_order_acquire) == next; });
    if (!call_) return;
    call_(job_, thread);
    done_.fetch_add(1, std::memory_order_release);
  }
}

}  // namespace treacle
