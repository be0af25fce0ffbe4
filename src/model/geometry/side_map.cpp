#include "treacle/model/geometry/side_map.hpp"

#include "body_region.hpp"
#include "thin_sheet.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/core/work_in_hand.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "wall_turn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Particles act on each other within this reach, and a node may be half a cell from a particle.
double reachOf(const Case& c) { return c.interactionRadius() + c.spacing; }

/// The smallest lattice around the sheet whose nodes include the places of the lattice of all solids.
template <int D>
SideMap<D> emptyMap(const Case& c, const Body& body, const ThinSheet<D>& sheet) {
  SideMap<D> map;
  map.edge = c.spacing / 2;
  double nodes = 1;
  for (int k = 0; k < D; ++k) {
    const double first = c.domain.min[k], low = std::floor((sheet.min()[k] - first) / map.edge),
                 high = std::ceil((sheet.max()[k] - first) / map.edge);
    map.origin[k] = first + low * map.edge;
    nodes *= high - low + 1;
    map.count[k] = static_cast<std::int32_t>(std::min(high - low + 1, 2e9));
  }
  constexpr double most = 2e9;
  if (nodes > most)
    throw InputError(fmt::format(
        "thin sheet '{}' is too large: its map would have {:.2g} nodes, {:g} of them fit; take a larger spacing",
        body.name, nodes, most));
  map.height.resize(static_cast<std::size_t>(nodes));
  return map;
}

template <int D>
Vec<D> nodeOf(const SideMap<D>& map, std::size_t index) {
  Vec<D> x = map.origin;
  for (int k = 0; k < D; ++k) {
    const auto count = static_cast<std::size_t>(map.count[k]);
    x[k] += static_cast<double>(index % count) * map.edge;
    index /= count;
  }
  return x;
}

/// Errors: InputError where neighbours are on different sides, but no sheet is between them.
template <int D>
void requireApart(const Case& c, const Body& body, const SideMap<D>& map) {
  const int between = static_cast<int>(SideMap<D>::unitsOfSpacing * map.edge / c.spacing) + 1;
  std::size_t stride = 1;
  for (int k = 0; k < D; ++k) {
    for (std::size_t i = stride; i < map.height.size(); ++i) {
      if (i / stride % static_cast<std::size_t>(map.count[k]) == 0) continue;
      const int a = map.height[i - stride], b = map.height[i];
      if (a * b < 0 && std::abs(a) > between && std::abs(b) > between)
        throw InputError(fmt::format(
            "thin sheet '{}' has its front face its back at {}, less than {} apart: expected more, or both to be "
            "walls with a thickness",
            body.name, positionText(resized<3>(nodeOf(map, i)), D), lengthText(2 * reachOf(c))));
    }
    stride *= static_cast<std::size_t>(map.count[k]);
  }
}

template <int D>
void leaveOutCuts(const Case& c, const Body& body, const ThinSheet<D>& sheet, SideMap<D>& map) {
  if (BodyCondition<D>::isEmpty(body)) return;
  const BodyCondition<D> condition(c, body);
  for (std::size_t i = 0; i < map.height.size(); ++i) {
    if (map.height[i] == 0) continue;
    const Vec<D> x = nodeOf(map, i);
    if (!condition.holds(x + sheet.at(x, reachOf(c)).way)) map.height[i] = 0;
  }
}

/// The side of a place; so near the sheet the nearest node may be on the other one.
template <int D>
std::uint32_t sideOf(const ThinSheet<D>& sheet, const Vec<D>& x, double reach, int height) {
  constexpr int near = static_cast<int>(SideMap<D>::unitsOfSpacing);
  const sides::Side exact = std::abs(height) <= near ? sheet.at(x, reach).side : sides::None;
  return exact != sides::None ? exact : height > 0 ? sides::Front : sides::Back;
}

/// Of a particle of the sheet: the side that it is met from. One layer is shown.
template <int D>
std::uint32_t sheetWord(const ThinSheet<D>& sheet, int number, const Vec<D>& x, double reach, double spacing) {
  const auto place = sheet.at(x, reach);
  const bool front = place.side == sides::Front;
  const bool layer = place.distance < (0.5 + (front ? 1e-6 : -1e-6)) * spacing;
  return sides::sheetParticle(number, front ? sides::Back : sides::Front) | (layer ? sides::shown : 0);
}

template <int D>
SideMap<D> sideMapOf(const Case& c, const Body& body, const ThinSheet<D>& sheet) {
  SideMap<D> map = emptyMap(c, body, sheet);
  const double reach = reachOf(c), unit = SideMap<D>::unitsOfSpacing / c.spacing;
  WorkInHand work(fmt::format("finding the sides of '{}'", body.name), map.height.size());
  constexpr std::size_t some = 256;
  parallelForDynamic((map.height.size() + some - 1) / some, 2, 1, [&](std::size_t block) {
    const std::size_t begin = block * some, end = std::min(begin + some, map.height.size());
    for (std::size_t i = begin; i < end; ++i) {
      const auto place = sheet.at(nodeOf(map, i), reach);
      if (place.side == sides::None) continue;
      const double height = std::clamp(std::round(place.distance * unit), 1.0, 127.0);
      map.height[i] = static_cast<std::int8_t>(place.side == sides::Front ? height : -height);
    }
    work.add(end - begin);
  });
  requireApart(c, body, map);
  leaveOutCuts(c, body, sheet, map);
  return map;
}

}  // namespace

template <int D>
SideMap<D> makeSideMap(const Case& c, const Body& body) {
  return sideMapOf(c, body, ThinSheet<D>(c, body));
}

template <int D>
PlacedSheet<D> placedSheet(const Case& c, const Body& body, const SideMap<D>& map, const std::int8_t* height,
                           double time) {
  PlacedSheet<D> placed{map.origin, 1 / map.edge, map.count, height, {}, {}, {}, {}, 0, 1};
  for (int k = 0; k < D; ++k)
    if (c.domain.periodic[static_cast<std::size_t>(k)]) placed.period[k] = c.domain.max[k] - c.domain.min[k];
  if (body.rotation) {
    const WallMotion<D> motion = wallTurn<D>(body, time);
    placed.start = resized<D>(body.rotation->center);
    placed.axis = motion.axis, placed.sine = motion.sine, placed.cosine = motion.cosine;
  } else {
    for (int k = 0; k < D; ++k) placed.start[k] = map.origin[k] + (map.count[k] - 1) * map.edge / 2;
  }
  placed.center = placed.start + resized<D>(wallDisplacement(body, time));
  return placed;
}

template <int D>
void createSides(const Case& c, Particles<D>& particles) {
  particles.has.sides = true;
  particles.side.resize(particles.count);
  std::fill(particles.side.begin(), particles.side.end(), 0);
  const std::uint32_t walls = particles.wallBegin();
  const double reach = reachOf(c);
  int sheet = 0;
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    const Body& body = c.bodies[b];
    if (!body.shape.isThinSheet()) continue;
    const ThinSheet<D> surface(c, body);
    const SideMap<D> map = sideMapOf(c, body, surface);
    const PlacedSheet<D> placed = placedSheet<D>(c, body, map, map.height.data(), 0);
    parallelFor(particles.count, parallelGrain, [&](std::size_t i) {
      std::uint32_t& word = particles.side[i];
      const Vec<D>& x = particles.position[i];
      if (i >= walls && particles.body[i] == b)
        word |= sheetWord(surface, sheet, x, reach, c.spacing);
      else if (const int height = placed.heightAt(x); height != 0)
        word = sides::with(word, sheet, sideOf(surface, x, reach, height));
    });
    ++sheet;
  }
}

template SideMap<2> makeSideMap<2>(const Case&, const Body&);
template SideMap<3> makeSideMap<3>(const Case&, const Body&);
template PlacedSheet<2> placedSheet<2>(const Case&, const Body&, const SideMap<2>&, const std::int8_t*, double);
template PlacedSheet<3> placedSheet<3>(const Case&, const Body&, const SideMap<3>&, const std::int8_t*, double);
template void createSides<2>(const Case&, Particles<2>&);
template void createSides<3>(const Case&, Particles<3>&);

}  // namespace treacle
