// Files of the authors' program: parameters, a line of "%%", and particles or cuboids. What is taken must make a
// case file that is read again as the same case.

#include "import_parts.hpp"
#include "input_file.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/create.hpp"

#include <algorithm>
#include <cstdlib>

using namespace treacle;

namespace {

void convert(const MphParameters& parameters, const MphGeometry& geometry) {
  ImportedCase imported = convertedCase(parameters, geometry, "imported");
  const fuzz::InputFile file(imported.text);
  Case again = readCase(file.path(), {}, ShapeFiles::Leave);
  for (std::size_t b = 0; b < again.bodies.size() && b < imported.value.bodies.size(); ++b)
    again.bodies[b].shape.file.path = imported.value.bodies[b].shape.file.path;  // now absolute
  if (!(again == imported.value)) std::abort();
  if (boxPoints(imported.value) > 1e5) return;
  createParticles(imported.value, imported.warnings);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::textOf(data, size);
  const std::size_t end = std::min(text.find("%%\n"), text.size());
  const std::string_view second = text.substr(std::min(end + 3, text.size()));
  for (const auto read : {readMphParticles, readMphCuboids})
    fuzz::accept([&] {
      const MphGeometry geometry = read("box", second);
      convert(readMphParameters("box.data", text.substr(0, end)), geometry);
    });
  return 0;
}
