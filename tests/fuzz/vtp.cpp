// Frames, and pictures of them.

#include "treacle/io/frames/vtp.hpp"
#include "input_file.hpp"
#include "treacle/io/picture/picture.hpp"

using namespace treacle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::InputFile file(fuzz::textOf(data, size));
  fuzz::accept([&] {
    const Frame frame = readVtp(file.path());
    PictureOptions options;
    options.spacing = 1e-3;
    options.width = 200;
    for (const PictureField field : {PictureField::Speed, PictureField::Pressure}) {
      options.field = field;
      drawFrame("/dev/null", frame, frame, options);
    }
  });
  return 0;
}
