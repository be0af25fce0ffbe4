// Particles of other programs, and histories.

#include "input_file.hpp"
#include "treacle/io/frames/particle_csv.hpp"
#include "treacle/io/tables/history.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::InputFile file(fuzz::textOf(data, size));
  fuzz::accept([&] { readParticleCsv(file.path(), std::nullopt); });
  fuzz::accept([&] { readParticleCsv(file.path(), 2); });
  fuzz::accept([&] { readHistory(file.path()); });
  return 0;
}
