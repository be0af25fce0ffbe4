#pragma once

namespace treacle {

/// Most threads that a run can have.
inline constexpr int mostThreads = 1024;

/// Sets the number of threads and starts them. 0: as many as OpenMP takes by itself, of which steps use no more
/// than pay (Team::fitToWork) unless OMP_NUM_THREADS is set. OpenMP ends the program where it gets fewer than it
/// wants, with a code that means something else here, so it is tried before. Errors: InputError for more than
/// there can be.
void startThreads(int count);

/// The same until it goes, of threads that have been started and for the thread that makes it: OpenMP keeps their
/// number by thread.
class UsedThreads {
 public:
  explicit UsedThreads(int count);
  ~UsedThreads();
  UsedThreads(const UsedThreads&) = delete;
  UsedThreads& operator=(const UsedThreads&) = delete;

 private:
  int before_;
};

}  // namespace treacle
