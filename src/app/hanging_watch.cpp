#include "hanging_watch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace treacle {

std::optional<std::string> HangingWatch::look(const Frame& fluid, const Frame& walls,
                                              const Arrangement& arrangement) {
  if (warned_ || arrangement.touchesWalls || fluid.position.empty() || case_.isOpen()) {
    before_.reset();
    return std::nullopt;
  }
  Vec<3> mean{};
  for (const Vec<3>& v : fluid.velocity) mean += v;
  mean *= 1 / static_cast<double>(fluid.velocity.size());
  const std::optional<double> before = std::exchange(before_, fluid.time);
  if (!before || !(fluid.time > *before)) return std::nullopt;
  // In free fall it would by now be faster, unless it has just been thrown upwards.
  const double duration = fluid.time - *before;
  const bool rests = norm(mean) * duration < 0.1 * case_.spacing;
  if (!rests || norm(case_.gravity) * duration * duration < case_.spacing) return std::nullopt;
  const double gap = distanceToWalls(fluid, walls, case_.domain) / case_.spacing;
  // Arrangements leave thin sheets out, which fluid may touch nevertheless.
  if (gap < nearestReach || gap > 2 * case_.interactionRadius() / case_.spacing) return std::nullopt;
  warned_ = true;
  return fmt::format(
      "t = {:.6g} s: the fluid touches no wall and yet rests: its nearest particle is {:.2g} spacings "
      "from a wall's, where 1 is contact. Viscous fluid feels walls across a gap of up to {:.2g} spacings; a "
      "smaller spacing makes the gap smaller, a body that begins in contact with the wall has none",
      fluid.time, gap, case_.interactionRadius() / case_.spacing);
}

}  // namespace treacle
