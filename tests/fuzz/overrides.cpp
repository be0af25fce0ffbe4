// Overrides of a case, one a line.

#include "input_file.hpp"
#include "treacle/io/case/case_reader.hpp"

#include <string>
#include <vector>

using namespace treacle;

namespace {

constexpr std::string_view caseWithAll = R"(dimensions = 2
spacing = 1e-3
domain = {min = [-0.05, -0.01], max = [0.05, 0.05]}
time = {step = 1e-3, end = 0.4}
width = {axis = "x", from = 0, to = 0.01}
material = [{name = "honey", density = 1400, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6}]
body = [
  {name = "drop", type = "fluid", material = "honey", shape = "sphere", center = [0, 0.02], radius = 0.01},
  {name = "left wall", type = "wall", material = "honey", shape = "box", min = [-0.05, -0.01], max = [0.05, 0]},
]
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> overrides;
  for (std::string_view rest = fuzz::textOf(data, size); !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    overrides.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  const fuzz::InputFile file(caseWithAll);
  fuzz::accept([&] { readCase(file.path(), overrides); });
  return 0;
}
