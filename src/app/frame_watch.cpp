#include "frame_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace treacle {

void FrameWatch::note(std::size_t number, std::int64_t step, double time, int iterations,
                      const Arrangement& arrangement, const FrameCost& cost) {
  log_.info(fmt::format("frame {}: step {}, t = {:.6g} s, {} iterations, {}; {:.3g} MB in {:.3g} s", number, step,
                        time, iterations, textOf(arrangement), static_cast<double>(cost.bytes) / 1e6,
                        cost.seconds));
  tally_.cost += cost;
  tally_.arrangement = arrangement;
  tally_.smallestLeast = std::min(tally_.smallestLeast, arrangement.least);
  tally_.smallestLow = std::min(tally_.smallestLow, arrangement.low);
  warn(arrangement_.look(arrangement, time));
}

void FrameWatch::look(const Frame& fluid, const Frame& walls, const Arrangement& arrangement) {
  if (auto warning = hanging_.look(fluid, walls, arrangement)) warn({std::move(*warning)});
}

std::vector<std::string> FrameWatch::takeWarnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

void FrameWatch::warn(std::vector<std::string> warnings) {
  const std::lock_guard lock(mutex_);
  std::ranges::move(warnings, std::back_inserter(warnings_));
}

}  // namespace treacle
