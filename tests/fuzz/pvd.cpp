// Indices of frames. Times must ascend.

#include "treacle/io/frames/pvd.hpp"
#include "input_file.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::InputFile file(fuzz::textOf(data, size));
  fuzz::accept([&] {
    double before = -1;
    for (const PvdEntry& entry : readPvd(file.path())) {
      if (before != -1 && !(entry.time > before)) std::abort();
      before = entry.time;
    }
  });
  return 0;
}
