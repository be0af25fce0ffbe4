#include "treacle/model/case/probe.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Both ends of a length among them.
int placesOn(double length, double spacing, int given) {
  return given > 0 ? given : std::max(2, static_cast<int>(std::lround(length / spacing)) + 1);
}

}  // namespace

ProbePlaces ProbePlaces::of(const Probe& p, double spacing) {
  switch (p.kind) {
    case ProbeKind::Line:
      return {p.from, p.to - p.from, {}, placesOn(norm(p.to - p.from), spacing, p.count), 1};
    case ProbeKind::Height:
      return {p.from, p.to - p.from, {}, 2, 1};
    case ProbeKind::Plane:
      return {p.corner, p.along, p.up, placesOn(norm(p.along), spacing, p.columns),
              placesOn(norm(p.up), spacing, p.rows)};
    case ProbeKind::Point:
    case ProbeKind::Flow:
    case ProbeKind::Region:
    case ProbeKind::Load:
    case ProbeKind::WallPressure:
      break;
  }
  return {p.point};
}

Vec<3> ProbePlaces::at(std::size_t place) const {
  const auto share = [](std::size_t k, int count) {
    return count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0;
  };
  const auto width = static_cast<std::size_t>(columns);
  return corner + share(place % width, columns) * along + share(place / width, rows) * up;
}

}  // namespace treacle
