// Particles of other programs, and histories with their pictures.

#include "input_file.hpp"
#include "treacle/io/history.hpp"
#include "treacle/io/particle_csv.hpp"
#include "treacle/io/picture.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::InputFile file(fuzz::textOf(data, size));
  fuzz::accept([&] { readParticleCsv(file.path(), std::nullopt); });
  fuzz::accept([&] { readParticleCsv(file.path(), 2); });
  fuzz::accept([&] { drawHistory("/dev/null", readHistory(file.path())); });
  return 0;
}
