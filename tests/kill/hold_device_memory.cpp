// hold_device_memory LEFT: takes the first GPU's memory until about LEFT bytes are free, prints a line, and goes
// on to take what is given back, until it is killed.
#include "support/device_faults.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: hold_device_memory LEFT\n");
    return 2;
  }
  treacle::test::MemoryHog hog(std::strtoull(argv[1], nullptr, 10));
  std::puts("device memory is taken");
  std::fflush(stdout);
  while (true) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    hog.takeMore();
  }
}
