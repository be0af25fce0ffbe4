#include "print.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace treacle {
namespace {

int failure = 0;  // of the first print that failed, a value of errno

void note(bool good) {
  if (!good && failure == 0) failure = errno;
}

}  // namespace

void printText(const std::string& text) {
  if (failure == 0) note(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void flushPrinted() {
  if (failure == 0) note(std::fflush(stdout) == 0);
}

void printError(const std::string& text) {
  std::string shown = text;  // names may hold what a terminal would obey
  for (char& c : shown)
    if ((static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t' && c != '\r') || c == 0x7f) c = '?';
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

std::string printFailure() {
  return failure == 0 || failure == EPIPE ? std::string{} : std::generic_category().message(failure);
}

void openClosedStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) {
      const int null = ::open("/dev/null", O_RDWR);
      if (null >= 0 && null != descriptor) ::dup2(null, descriptor), ::close(null);
    }
}

}  // namespace treacle
