// Expressions of a case, such as those of `where`.

#include "treacle/model/case/expression.hpp"
#include "input_file.hpp"

#include <string>

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::textOf(data, size));
  for (const int dimensions : {2, 3})
    fuzz::accept([&] {
      const Expression expression(text, dimensions);
      for (const double x : {0.0, 1e-3, -1e300}) static_cast<void>(expression({x, -x, 2 * x}));
    });
  return 0;
}
