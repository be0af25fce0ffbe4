#include "case_checker.hpp"
#include "treacle/model/geometry/shape.hpp"

namespace treacle {
namespace {

/// It is the name of a file, on any system.
void requireFileName(const Checker& at, const std::string& name) {
  constexpr std::string_view others = "._-+";
  const auto isFit = [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           others.find(c) != others.npos;
  };
  if (name.starts_with('.') || !std::ranges::all_of(name, isFit))
    at.fail({"name"}, fmt::format("expected letters, digits and . _ - +, not . at first, since it names a file; "
                                  "found '{}'",
                                  name));
}

template <class Entry>
void requireOneOf(const Checker& at, std::string_view key, std::string_view what, const std::string& name,
                  const std::vector<Entry>& entries) {
  if (std::ranges::find(entries, name, &Entry::name) == entries.end())
    at.fail({key}, fmt::format("expected the name of {}, found '{}'", what, name));
}

void requireWall(const Checker& at, std::string_view key, const std::string& name) {
  const Case& c = at.wholeCase();
  requireOneOf(at, key, "a wall or rigid body", name, c.bodies);
  if (!std::ranges::find(c.bodies, name, &Body::name)->isWall())
    at.fail({key}, fmt::format("'{}' is fluid; expected the name of a wall or rigid body", name));
}

/// Boxes lie along the axes.
void requireCarrier(const Checker& at, const Probe& p) {
  requireWall(at, "moves_with", p.movesWith);
  if (p.box) at.fail({"box"}, "a probe that moves with a body has none; expected a plane, by point and normal");
}

/// Elsewhere nothing can ever be read.
void requireInside(const Checker& at, const Vec<3>& x) {
  const Domain& domain = at.wholeCase().domain;
  for (int k = 0; k < at.wholeCase().dimensions; ++k)
    if (!(x[k] >= domain.min[k] && x[k] <= domain.max[k]))
      at.fail({"point"}, fmt::format("expected a point of the domain, {} to {} m along {}, found {}",
                                     domain.min[k], domain.max[k], "xyz"[k], x[k]));
}

/// Of a line some part.
void requireMeets(const Checker& at, const Vec<3>& from, const Vec<3>& to) {
  const Domain& domain = at.wholeCase().domain;
  double begin = 0, end = 1;  // of its part in the domain, as shares of the way
  for (int k = 0; k < at.wholeCase().dimensions; ++k) {
    const double way = to[k] - from[k], low = domain.min[k] - from[k], high = domain.max[k] - from[k];
    if (way == 0) {
      if (low > 0 || high < 0) end = -1;
    } else {
      begin = std::max(begin, std::min(low / way, high / way)),
      end = std::min(end, std::max(low / way, high / way));
    }
  }
  if (begin > end)
    at.fail({"from"}, fmt::format("expected a line through the domain, {}, found {}",
                                  rangeText(domain.min, domain.max, at.wholeCase().dimensions),
                                  rangeText(from, to, at.wholeCase().dimensions)));
}

void requireRectangle(const Checker& at, const Probe& p) {
  at.requireDirection("along", p.along);
  at.requireDirection("up", p.up);
  if (std::abs(dot(p.along, p.up)) > 1e-6 * norm(p.along) * norm(p.up))
    at.fail({"up"}, "expected a vector at right angles to along");
}

}  // namespace

void requireSound(const Checker& at, const ProbeBox& b) { at.requireOrder(b.min, b.max); }

void requireSound(const Checker& at, const Probe& p) {
  requireFileName(at, p.name);
  if (p.isOnWall()) requireWall(at, "body", p.body);
  if (p.kind == ProbeKind::Load) return;
  if (!p.movesWith.empty()) requireCarrier(at, p);
  if (p.kind == ProbeKind::Point && p.movesWith.empty()) requireInside(at, p.point);
  const bool isLine = p.kind == ProbeKind::WallPressure && at.wholeCase().dimensions == 2;
  if (isLine && norm(p.up) > 0) at.fail({"up"}, "found in two dimensions, where a patch is a line; expected none");
  if (isLine) at.requireDirection("along", p.along);
  if (p.kind == ProbeKind::Plane || (p.kind == ProbeKind::WallPressure && !isLine)) requireRectangle(at, p);
  if (p.kind == ProbeKind::WallPressure) return;
  if ((p.kind == ProbeKind::Line || p.kind == ProbeKind::Height) && p.from == p.to)
    at.fail({"to"}, "expected a point other than from");
  if ((p.kind == ProbeKind::Line || p.kind == ProbeKind::Height) && p.movesWith.empty())
    requireMeets(at, p.from, p.to);
  if (p.kind == ProbeKind::Flow) at.requireDirection("normal", p.normal);
  if (p.isSummed() && !p.material.empty())
    requireOneOf(at, "material", "a material", p.material, at.wholeCase().materials);
  const auto places = [spacing = at.wholeCase().spacing](const Vec<3>& edge, int given) {
    return given > 0 ? given : norm(edge) / spacing + 1;
  };
  constexpr double most = 1e7;
  if (const double count = places(p.to - p.from, p.count) * places(p.along, p.columns) * places(p.up, p.rows);
      !(count <= most))
    at.fail({"type"}, fmt::format("expected at most {:g} places, found {:.3g}", most, count));
}

}  // namespace treacle
