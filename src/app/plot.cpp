#include "commands.hpp"
#include "frame_number.hpp"
#include "print.hpp"
#include "run_log.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/picture/picture.hpp"
#include "treacle/model/case/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace treacle {
namespace {

const Probe& probeNamed(const std::string& name, const Case& c) {
  const auto found = std::ranges::find(c.probes, name, &Probe::name);
  if (found != c.probes.end()) return *found;
  std::vector<std::string_view> names;
  for (const Probe& probe : c.probes) names.push_back(probe.name);
  throw InputError(names.empty() ? fmt::format("--probe {}: the case has no probes", name)
                                 : fmt::format("--probe: {}", wrongWord(names, name)));
}

}  // namespace

void plotCommand(const PlotOptions& options, std::string_view field) {
  const RunDirectory run = RunDirectory::open(options.directory);
  const Case c = readCase(run.caseFile(), {}, ShapeFiles::Leave);
  std::filesystem::path output = options.output;
  if (!output.empty()) RunDirectory::requireForeign(output, "--output");
  if (!options.probe.empty()) {
    const Probe& probe = probeNamed(options.probe, c);
    if (output.empty()) output = run.probePicture(probe.name);
    return drawCurves(options.directory, output, {"--probe=" + probe.name, fmt::format("--field={}", field)});
  }
  if (options.history)
    return drawCurves(options.directory, output.empty() ? run.historyPicture() : output, {"--history"});
  if (const std::string kind = output.extension().string(); !kind.empty() && kind != ".png")
    throw InputError(fmt::format("--output {}: pictures of frames are PNG; expected a name that ends in .png",
                                 output.string()));
  PictureOptions picture;
  picture.field = options.field, picture.state = options.state;
  picture.spacing = c.spacing;
  picture.gravity = c.gravity;
  picture.title = c.title;
  const std::size_t frame = frameNumber(options.frame, run);
  if (output.empty()) output = run.framePicture(frame);
  const std::size_t missing =
      drawFrame(output, readFrame(run.fluidFrame(frame)), readFrame(run.wallsFrame(frame)), picture);
  if (missing > 0)
    printWarning(fmt::format("frame {}: {} particle{} without a position that can be drawn", frame, missing,
                             missing == 1 ? "" : "s"));
  print("{}\n", output.string());
}

}  // namespace treacle
