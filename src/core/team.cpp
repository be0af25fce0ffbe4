#include "treacle/core/team.hpp"

#include <omp.h>

#include <atomic>
#include <exception>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace treacle {
namespace {

/// How often a thread looks before it goes to sleep, about half a millisecond in all. To be woken takes longer
/// than most loops; but where there are more threads than cores, the one that is waited for may be waiting for
/// this core, and a system gives those who slept a core sooner than those who did not.
constexpr int looks = 20000;

/// Until the condition holds for the number.
template <class Condition>
void waitUntil(const std::atomic<unsigned>& number, Condition&& condition) {
  for (int look = 0; look < looks; ++look) {
    if (condition(number.load(std::memory_order_acquire))) return;
#ifdef __x86_64__
    _mm_pause();
#endif
  }
  for (unsigned now = number.load(std::memory_order_acquire); !condition(now);
       now = number.load(std::memory_order_acquire))
    number.wait(now, std::memory_order_acquire);
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
  started_.notify_all();
}

void Team::finish() {
  const unsigned all = started_.load(std::memory_order_relaxed) * static_cast<unsigned>(size_ - 1);
  waitUntil(done_, [all](unsigned done) { return done == all; });
  led_ = this;
}

void Team::serve(int thread) {
  for (unsigned next = 1;; ++next) {
    waitUntil(started_, [next](unsigned started) { return started == next; });
    if (!call_) return;
    call_(job_, thread);
    done_.fetch_add(1, std::memory_order_release);
    done_.notify_one();
  }
}

}  // namespace treacle
