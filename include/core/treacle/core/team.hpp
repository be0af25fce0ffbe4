#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>

namespace treacle {

/// The threads that share the loops of a time step. OpenMP would call them together anew for every loop; here they
/// wait for the next one beside each other, which costs a fifth of that. Between loops the leader goes on alone.
class Team {
 public:
  /// Runs body() on the calling thread while the other threads of OpenMP serve its loops (parallel.hpp). Throws
  /// what body throws. With one thread, or inside another team, body() has no team of its own. `work`: of a loop,
  /// as so many particles in 2D; it counts where teams fit their work.
  static void lead(const std::function<void()>& body, std::size_t work = std::numeric_limits<std::size_t>::max());

  /// Whether teams leave out threads that would have little to do: each gets a work of 250 or more. To call a
  /// thread for less takes as long as it saves, and beside other programs far longer. False: all threads of
  /// OpenMP.
  static void fitToWork(bool fit) { fitsWork_ = fit; }

  /// The team that the calling thread leads and whose threads are waiting; null: none.
  static Team* led() { return led_; }

  int size() const { return size_; }

  /// Runs job(thread) for thread = 0 ... size() - 1, that of 0 on the calling thread, and waits for all. Loops
  /// inside a job have no team. Only the job of thread 0 may throw.
  template <class F>
  void run(F& job) {
    const Work work(
        *this, [](void* f, int thread) { (*static_cast<F*>(f))(thread); }, &job);
    job(0);
  }

 private:
  using Call = void (*)(void*, int);

  /// From the start of a job until everybody has done it, also where the leader's part throws.
  class Work {
   public:
    Work(Team& team, Call call, void* job) : team_(team) { team_.start(call, job); }
    ~Work() { team_.finish(); }
    Work(const Work&) = delete;

   private:
    Team& team_;
  };

  Team() = default;
  void start(Call call, void* job);
  void finish();
  void serve(int thread);

  static inline thread_local Team* led_ = nullptr;
  static inline std::atomic<bool> fitsWork_{false};

  int size_ = 1;
  // What the leader writes and the others read in one cache line, and what they write in another: a job is known
  // as soon as one line has gone over, and its end likewise.
  alignas(64) Call call_ = nullptr;
  void* job_ = nullptr;
  std::atomic<unsigned> started_{0};           // jobs so far
  alignas(64) std::atomic<unsigned> done_{0};  // shares of them that the others have done
};

}  // namespace treacle
