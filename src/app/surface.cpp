#include "commands.hpp"
#include "frame_number.hpp"
#include "print.hpp"
#include "run_log.hpp"
#include "threads.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/surface/free_surface.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

void makeSurface(const SurfaceOptions& options, const RunDirectory& run, const Case& c, std::size_t frame) {
  Timer timer;
  const FreeSurface surface = freeSurface(readFrame(run.fluidFrame(frame)), c.spacing, options.cell);
  const std::uint64_t bytes = run.writeSurface(frame, surface, options.format, c.output.compression);
  if (surface.leftOut > 0)
    printWarning(fmt::format("frame {}: {} particle{} without a position that a surface can be at", frame,
                             surface.leftOut, surface.leftOut == 1 ? "" : "s"));
  print("{}: t = {:.6g} s, {} triangles, {:.3g} MB, {:.3g} s\n", run.surfaceFile(frame, options.format).string(),
        surface.time, surface.triangles.size(), static_cast<double>(bytes) / 1e6, timer.lap());
  flushPrinted();
}

}  // namespace

void surfaceCommand(const SurfaceOptions& options) {
  if (!hasFreeSurface()) throw InputError(whyNoFreeSurface());
  const RunDirectory run = RunDirectory::open(options.directory);
  requireFrames(run);
  const Case c = readCase(run.caseFile(), {}, ShapeFiles::Leave);
  if (c.dimensions != 3)
    throw InputError(fmt::format("{}: a case of two dimensions has no surface of triangles; expected three",
                                 options.directory.string()));
  const std::size_t first = options.frame ? frameNumber(*options.frame, run) : 0;
  const std::size_t last = options.frame ? first : run.frameCount() - 1;
  startThreads(options.threads);
  for (std::size_t frame = first; frame <= last; ++frame) makeSurface(options, run, c, frame);
  if (options.format == SurfaceFormat::Vtp) print("ParaView: {}\n", run.surfaceIndex().string());
}

}  // namespace treacle
