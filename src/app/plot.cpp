#include "commands.hpp"
#include "frame_number.hpp"
#include "print.hpp"
#include "run_log.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/io/history.hpp"
#include "treacle/io/picture.hpp"
#include "treacle/io/pvtp.hpp"
#include "treacle/io/run_directory.hpp"

#include <fmt/format.h>

namespace treacle {
void plotCommand(const PlotOptions& options) {
  const RunDirectory run = RunDirectory::open(options.directory);
  const Case c = readCase(run.caseFile(), {}, ShapeFiles::Leave);
  std::filesystem::path output = options.output;
  if (options.history) {
    if (output.empty()) output = run.historyPicture();
    drawHistory(output, readHistory(run.history()), c.title);
  } else {
    const std::size_t frame = frameNumber(options.frame, run);
    if (output.empty()) output = run.framePicture(frame);
    PictureOptions picture;
    picture.field = options.field;
    picture.spacing = c.spacing;
    picture.gravity = c.gravity;
    picture.title = c.title;
    const std::size_t missing =
        drawFrame(output, readFrame(run.fluidFrame(frame)), readFrame(run.wallsFrame(frame)), picture);
    if (missing > 0)
      printWarning(fmt::format("frame {}: {} particle{} without a position that can be drawn", frame, missing,
                               missing == 1 ? "" : "s"));
  }
  print("{}\n", output.string());
}

}  // namespace treacle
