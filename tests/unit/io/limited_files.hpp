#pragma once

#include <omp.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace treacle::test {

/// Runs f in a child process in which no file can grow beyond `bytes`, as on a full disk. f returns whether all
/// was as expected; so does this function.
template <class F>
bool withFileLimit(rlim_t bytes, F f) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{bytes, bytes};
    ::signal(SIGXFSZ, SIG_IGN);
    omp_set_num_threads(1);  // the others have not come along
    bool good = ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
    try {
      good = good && f();
    } catch (...) {
      good = false;
    }
    ::_exit(good ? 0 : 1);
  }
  int status = -1;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace treacle::test
