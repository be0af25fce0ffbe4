#pragma once

#include "snapshot.hpp"

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace treacle {

/// Writes snapshots in the order in which they are handed over, while the caller computes. There are two: one can
/// be filled while the other is written. What goes wrong is thrown in the caller's thread, by next() or wait(),
/// once; snapshots that were handed over meanwhile are written nevertheless.
class OutputThread {
 public:
  /// `write` is called by the thread, for one snapshot at a time. Errors: RunError where the system gives no
  /// thread.
  explicit OutputThread(std::function<void(const Snapshot&)> write);
  OutputThread(const OutputThread&) = delete;
  OutputThread& operator=(const OutputThread&) = delete;
  /// Waits until all is written; errors are lost.
  ~OutputThread();

  /// The snapshot to fill and hand over next; its memory is that of an earlier one. Waits while both are being
  /// written. Errors: what `write` threw.
  Snapshot& next();
  void handOver();

  /// The snapshot that was handed over last, as long as next() has not given it out again, to be handed over once
  /// more. Waits until it is written. Errors: what `write` threw.
  Snapshot& last();

  /// Returns when all that was handed over is written. Errors: what `write` threw.
  void wait();

  double busySeconds() const;  // spent writing

 private:
  void run();
  void rethrow();

  std::function<void(const Snapshot&)> write_;
  std::array<Snapshot, 2> snapshots_;
  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::int64_t handedOver_ = 0, written_ = 0;  // the k-th snapshot stands in place k % 2
  std::int64_t last_ = 0;                      // place of the last one handed over
  bool closed_ = false;
  std::exception_ptr failure_;
  double seconds_ = 0;
  std::thread thread_;  // last: it uses the others
};

}  // namespace treacle
