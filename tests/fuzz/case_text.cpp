// Text of a case file. One that is taken must come back from what is written of it.

#include "input_file.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/checks.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::InputFile file(fuzz::textOf(data, size));
  Case c;
  try {
    c = readCase(file.path());
  } catch (const InputError&) {
    return 0;
  }
  c.resolution = 1;  // applied
  const fuzz::InputFile written(caseText(c));
  if (!(readCase(written.path()) == c)) std::abort();
  static_cast<void>(stabilityNumbers(c));
  return 0;
}
