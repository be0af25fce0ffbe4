#include "output_thread.hpp"

#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace treacle {

OutputThread::OutputThread(std::function<void(const Snapshot&)> write) : write_(std::move(write)) {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& e) {
    throw RunError(
        fmt::format("the system gives no thread for the output ({}): too little memory, or a limit of the "
                    "number of processes (ulimit -u)",
                    e.what()));
  }
}

OutputThread::~OutputThread() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Snapshot& OutputThread::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return handedOver_ - written_ < 2; });
  rethrow();
  // The second snapshot takes memory only where writing is slower than computing.
  if (handedOver_ == written_) handedOver_ = written_ = 0;
  return snapshots_[static_cast<std::size_t>(handedOver_ % 2)];
}

void OutputThread::handOver() {
  {
    const std::lock_guard lock(mutex_);
    last_ = handedOver_ % 2;
    ++handedOver_;
  }
  changed_.notify_all();
}

Snapshot& OutputThread::last() {
  wait();
  const std::lock_guard lock(mutex_);
  handedOver_ = written_ = last_;  // all is written: counting may begin anywhere
  return snapshots_[static_cast<std::size_t>(last_)];
}

void OutputThread::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return handedOver_ == written_; });
  rethrow();
}

double OutputThread::busySeconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

void OutputThread::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void OutputThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return closed_ || handedOver_ > written_; });
    if (handedOver_ == written_) return;
    const Snapshot& snapshot = snapshots_[static_cast<std::size_t>(written_ % 2)];
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

}  // namespace treacle
