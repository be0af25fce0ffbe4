#include "output_thread.hpp"

#include "treacle/core/timer.hpp"

#include <utility>

namespace treacle {

template <int D>
OutputThread<D>::OutputThread(std::function<void(const Snapshot<D>&)> write)
    : write_(std::move(write)), thread_([this] { run(); }) {}

template <int D>
OutputThread<D>::~OutputThread() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

template <int D>
Snapshot<D>& OutputThread<D>::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return handedOver_ - written_ < 2; });
  rethrow();
  // The second snapshot takes memory only where writing is slower than computing.
  if (handedOver_ == written_) handedOver_ = written_ = 0;
  return snapshots_[static_cast<std::size_t>(handedOver_ % 2)];
}

template <int D>
void OutputThread<D>::handOver() {
  {
    const std::lock_guard lock(mutex_);
    ++handedOver_;
  }
  changed_.notify_all();
}

template <int D>
void OutputThread<D>::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return handedOver_ == written_; });
  rethrow();
}

template <int D>
double OutputThread<D>::busySeconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

template <int D>
void OutputThread<D>::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

template <int D>
void OutputThread<D>::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return closed_ || handedOver_ > written_; });
    if (handedOver_ == written_) return;
    const Snapshot<D>& snapshot = snapshots_[static_cast<std::size_t>(written_ % 2)];
    lock.unlock();
    Timer timer;
    std::exception_ptr failure;
    try {
      write_(snapshot);
    } catch (...) {
      failure = std::current_exception();
    }
    const double seconds = timer.lap();
    lock.lock();
    seconds_ += seconds;
    if (!failure_) failure_ = failure;
    ++written_;
    changed_.notify_all();
  }
}

template class OutputThread<2>;
template class OutputThread<3>;

}  // namespace treacle
