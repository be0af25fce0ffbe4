#include "treacle/core/team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
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

/// A further thread is taken for so many particles in 2D: some 30 microseconds of a product, while calling a
/// thread that waits takes less than one.
constexpr std::size_t workPerThread = 500;

/// Until the condition holds for the number. Returns whether it took no sleep.
template <class Condition>
bool waitUntil(const std::atomic<unsigned>& number, Condition&& condition) {
  for (int look = 0; look < looks; ++look) {
    if (condition(number.load(std::memory_order_acquire))) return true;
#ifdef __x86_64__
    _mm_pause();
#endif
  }
  for (unsigned now = number.load(std::memory_order_acquire); !condition(now);
       now = number.load(std::memory_order_acquire))
    number.wait(now, std::memory_order_acquire);
  return false;
}

/// What a leader has learnt of the others. Where a machine has other work for their cores, a loop of microseconds
/// may wait milliseconds for each of them: the leader then does all of some loops by itself before it asks again.
struct Patience {
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned least = 16, most = 4096;  // loops that it does alone

  bool isAlone = false;  // in the job at hand
  unsigned left = 0;     // jobs that are still to be done alone
  unsigned next = 0;     // how many there will be if the others are late once more
  Clock::time_point start{};

  void begin() {
    isAlone = left > 0;
    if (isAlone)
      --left;
    else
      start = Clock::now();
  }
  /// The leader was done at `own`, and all of them are now.
  void learn(bool wereQuick, Clock::time_point own) {
    if (wereQuick || Clock::now() - own <= 4 * (own - start)) {
      next /= 2;
    } else {
      next = std::clamp(2 * next, least, most);
      left = next;
    }
  }
};
thread_local Patience patience;

/// So many threads of OpenMP until it goes, for loops without a team, too.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~ThreadLimit() { omp_set_num_threads(before_); }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  int before_;
};

}  // namespace

void Team::lead(const std::function<void()>& body, std::size_t work) {
  int threads = omp_get_max_threads();
  if (fitsWork_) threads = static_cast<int>(std::min(work / workPerThread + 1, static_cast<std::size_t>(threads)));
  const ThreadLimit limit(threads);
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
  if (call) {
    patience.begin();
    if (patience.isAlone) return;
  }
  started_.store(started_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  started_.notify_all();
}

void Team::finish() {
  if (patience.isAlone) {
    for (int thread = 1; thread < size_; ++thread) call_(job_, thread);
  } else {
    const Patience::Clock::time_point own = Patience::Clock::now();
    const unsigned all = started_.load(std::memory_order_relaxed) * static_cast<unsigned>(size_ - 1);
    const bool wereQuick = waitUntil(done_, [all](unsigned done) { return done == all; });
    patience.learn(wereQuick, own);
  }
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
