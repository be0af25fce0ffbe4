#include "patience.hpp"

#include "print.hpp"
#include "progress.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/core/work_in_hand.hpp"

#include <fmt/format.h>

#include <chrono>
#include <system_error>

namespace treacle {

Patience::Patience(const char* what, bool quiet) {
  if (quiet) return;
  try {
    thread_ = std::thread([this, what] { run(what); });
  } catch (const std::system_error&) {
    // What is being done is worth more than to hear of it.
  }
}

Patience::~Patience() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Patience::run(const char* what) {
  using namespace std::chrono_literals;
  double seconds = 0;
  Timer timer;
  for (std::unique_lock lock(mutex_); !changed_.wait_for(lock, 5s, [&] { return ended_; });) {
    const auto work = WorkInHand::look();
    seconds += timer.lap();
    printError(fmt::format("treacle: {}{}, for {}\n", work ? work->what : what,
                           work && work->done ? fmt::format(", {:.0f} %", 100 * *work->done) : "",
                           durationText(seconds)));
  }
}

}  // namespace treacle
