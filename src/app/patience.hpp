#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace treacle {

/// While it lives, stderr says every five seconds what the program is doing: the work in hand, or `what` beside
/// any.
class Patience {
 public:
  /// `quiet`: nothing is said.
  explicit Patience(const char* what, bool quiet = false);
  ~Patience();
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;

 private:
  void run(const char* what);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::thread thread_;  // none where the system gives none
};

}  // namespace treacle
