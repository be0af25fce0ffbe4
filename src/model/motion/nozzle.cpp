#include "treacle/model/motion/nozzle.hpp"

#include "geometry/facet_tree.hpp"
#include "geometry/polygon.hpp"
#include "geometry/wall_turn.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace treacle {
namespace {

/// Unit vectors across a direction: along the width and, in space, along the height.
template <int D>
std::array<Vec<D>, D - 1> axesAcross(const Nozzle& nozzle, const Vec<D>& direction) {
  if constexpr (D == 2) {
    return {Vec<2>{direction[1], -direction[0]}};
  } else {
    Vec<3> up = nozzle.up;
    if (norm(up) == 0) {  // the axis that is the farthest from the direction
      int axis = 0;
      for (int k = 1; k < 3; ++k)
        if (std::abs(direction[k]) < std::abs(direction[axis]) - 1e-9) axis = k;
      up[axis] = 1;
    }
    up = up - dot(up, direction) * direction;
    up = up * (1 / norm(up));
    return {cross(direction, up), up};
  }
}

/// The places i + shift along each axis that lie in [-most, most] and are kept, in spacings.
template <int N, class Keep>
std::vector<Vec<N>> latticeOf(const Vec<N>& most, const Vec<N>& shift, Keep&& keep) {
  std::vector<Vec<N>> places;
  Vec<N> x;
  const auto along = [&](auto&& self, int k) -> void {
    if (k < 0) {
      if (keep(x)) places.push_back(x);
      return;
    }
    for (x[k] = std::ceil(-most[k] - shift[k]) + shift[k]; x[k] <= most[k]; ++x[k]) self(self, k - 1);
  };
  along(along, N - 1);
  return places;
}

/// A whole number of particles along each side, at least one, about the middle.
template <int N>
std::vector<Vec<N>> rectangleOf(const Vec<N>& sides) {
  Vec<N> most, shift;
  for (int k = 0; k < N; ++k) {
    const double count = std::max(1.0, std::round(sides[k]));
    most[k] = (count - 1) / 2 + 1e-6;
    shift[k] = std::fmod(count, 2) == 0 ? 0.5 : 0;
  }
  return latticeOf<N>(most, shift, [](const Vec<N>&) { return true; });
}

/// The lattice with or without a particle in the middle, whichever has the number nearer to `wanted`.
template <int N>
std::vector<Vec<N>> discOf(double radius, double inner, double wanted) {
  std::vector<Vec<N>> best;
  for (const double shift : {0.0, 0.5}) {
    auto places = latticeOf<N>(Vec<N>::filled(radius), Vec<N>::filled(shift), [&](const Vec<N>& x) {
      const double r = norm(x);
      return r <= radius * (1 + 1e-9) && (inner == 0 || r > inner * (1 + 1e-9));
    });
    const auto off = [&](const std::vector<Vec<N>>& p) {
      return std::abs(static_cast<double>(p.size()) - wanted);
    };
    if (best.empty() || off(places) < off(best)) best = std::move(places);
  }
  return best;
}

Vec<2> centroidOf(const std::vector<Vec<2>>& polygon) {
  Vec<2> sum{};
  double area = 0;  // six times, with its sign
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec<2>&a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double part = a[0] * b[1] - b[0] * a[1];
    sum += part * (a + b), area += 3 * part;
  }
  return (1 / area) * sum;
}

/// Tries lattices that are shifted by quarters of a spacing. Takes the one whose number of places is the nearest
/// to `wanted`, and among equal ones that whose middle is the nearest to that of the polygon.
std::vector<Vec<2>> polygonOf(const std::vector<Vec<2>>& points, double spacing, double wanted) {
  Vec<2> most{};
  for (const Vec<2>& x : points)
    for (int k = 0; k < 2; ++k) most[k] = std::max(most[k], std::abs(x[k]) / spacing);
  const Vec<2> middle = (1 / spacing) * centroidOf(points);
  Shape outline;
  outline.points = points;
  const FacetTree<2> sides(polygonFacets<2>(outline));
  const auto off = [&](const std::vector<Vec<2>>& places) {
    Vec<2> sum{};
    for (const Vec<2>& x : places) sum += x;
    const double count = static_cast<double>(places.size());
    return std::pair(std::abs(count - wanted), places.empty() ? 0 : norm((1 / count) * sum - middle));
  };
  std::vector<Vec<2>> best;
  for (int shift = 0; shift < 16; ++shift) {
    auto places = latticeOf<2>(most, {0.25 * (shift % 4), 0.25 * (shift / 4)},
                               [&](const Vec<2>& x) { return sides.winding(spacing * x) > 0.5; });
    if (shift == 0 || off(places) < off(best)) best = std::move(places);
  }
  return best;
}

template <int N>
double areaOf(const Nozzle& n) {
  const double pi = std::numbers::pi;
  if (n.kind == NozzleKind::Polygon) return 0.5 * std::abs(signedArea2(n.points));
  if (n.kind == NozzleKind::Rectangle) return N == 1 ? n.width : n.width * n.height;
  const auto disc = [&](double r) { return N == 1 ? 2 * r : pi * r * r; };
  return disc(n.radius) - disc(n.innerRadius);
}

template <int N>
std::vector<Vec<N>> placesAcross(const Nozzle& n, double spacing) {
  if (n.kind == NozzleKind::Disc)
    return discOf<N>(n.radius / spacing, n.innerRadius / spacing, areaOf<N>(n) / std::pow(spacing, N));
  if constexpr (N == 2)
    if (n.kind == NozzleKind::Polygon) return polygonOf(n.points, spacing, areaOf<N>(n) / (spacing * spacing));
  Vec<N> sides;
  sides[0] = n.width / spacing;
  if constexpr (N > 1) sides[1] = n.height / spacing;
  return rectangleOf<N>(sides);
}

}  // namespace

template <int D>
NozzleLayers<D>::NozzleLayers(const Case& c, const Body& body)
    : body_(body), spacing_(c.spacing), openingArea_(areaOf<D - 1>(body.inflow.nozzle)) {
  const Nozzle& nozzle = body.inflow.nozzle;
  if (openingArea_ / std::pow(spacing_, D - 1) > static_cast<double>(maxParticles))
    throw InputError(
        fmt::format("inflow '{}' would have more than {} particles in a layer", body.name, maxParticles));
  depth_ = static_cast<int>(std::ceil(c.interactionRadius() / spacing_ * (1 - 1e-9)));
  direction_ = resized<D>(nozzle.direction);
  direction_ = direction_ * (1 / norm(direction_));
  const auto axes = axesAcross<D>(nozzle, direction_);
  for (const Vec<D - 1>& place : placesAcross<D - 1>(nozzle, spacing_)) {
    Vec<D> x{};
    for (int k = 0; k < D - 1; ++k) x = x + (spacing_ * place[k]) * axes[static_cast<std::size_t>(k)];
    across_.push_back(x);
  }
  if (across_.empty())
    throw InputError(fmt::format(
        "inflow '{}': no particle has room in its nozzle; it must be as wide as one spacing", body.name));
  area_ = static_cast<double>(across_.size()) * std::pow(spacing_, D - 1);
}

template <int D>
Vec<D> NozzleLayers<D>::direction(double t) const {
  return body_.rotation ? wallTurn<D>(body_, t).turned(direction_) : direction_;
}

template <int D>
std::vector<Vec<D>> NozzleLayers<D>::layer(double way, double t) const {
  std::vector<Vec<D>> places;
  places.reserve(across_.size());
  const Vec<3>& center = body_.inflow.nozzle.center;
  if (!body_.rotation) {
    const Vec<D> middle = resized<D>(center + wallDisplacement(body_, t)) + way * direction_;
    for (const Vec<D>& x : across_) places.push_back(middle + x);
    return places;
  }
  const WallMotion<D> turn = wallTurn<D>(body_, t);
  const Vec<D> pivot = resized<D>(wallCenter(body_, t)),
               middle = resized<D>(center - body_.rotation->center) + way * direction_;
  for (const Vec<D>& x : across_) places.push_back(pivot + turn.turned(middle + x));
  return places;
}

template <int D>
double NozzleLayers<D>::speed(double t, double dt) const {
  const Inflow& inflow = body_.inflow;
  const double end = inflow.end > 0 ? inflow.end : t + dt + 1;
  const TimeFunction& rate = inflow.speed ? *inflow.speed : *inflow.flowRate;
  const double over = inflow.speed ? 1 : area_;
  const auto required = [&](double value) {
    // Formulas that fall to zero may miss it by rounding: what is less than 1e-9 spacings in a second is none.
    if (value / over < -1e-9 * spacing_)
      throw InputError(fmt::format("{} of inflow '{}' is {:g} at t = {:g} s; expected no negative numbers",
                                   inflow.speed ? "speed" : "flow_rate", body_.name, value, t));
    return std::max(0.0, value) / over;
  };
  if (dt == 0) return t >= inflow.start && t < end ? required(rate.at(t)) : 0;
  const double from = std::max(t, inflow.start), to = std::min(t + dt, end);
  if (!(from < to)) return 0;
  return required(rate.isConstant() && to - from == dt ? rate.value : rate.integral(from, to) / dt);
}

template <int D>
WallMotion<D> NozzleLayers<D>::motion(const Domain& domain, double t, double dt) const {
  WallMotion<D> m = wallMotion<D>(domain, body_, t, dt);
  // In the direction of the end of the step: a way within the nozzle and one with it, by the chord of the arc from
  // where a particle was, lead to the place that it has on the layer then.
  const Vec<D> flow = speed(t, dt) * direction(t + dt);
  m.velocity = m.velocity + flow;
  m.acceleration = m.acceleration + 2.0 * m.swirl(flow);  // of Coriolis: the layers go along what turns
  return m;
}

template <int D>
WallMotion<D> NozzleLayers<D>::motionAtEnd(const Domain& domain, double t, double dt) const {
  WallMotion<D> m = motion(domain, t, dt);
  m.center = resized<D>(wallCenter(body_, t + dt));
  return m;
}

template <int D>
void describeNozzle(const Body& body, const NozzleLayers<D>& layers, std::vector<std::string>& notes) {
  const double off = layers.area() / layers.openingArea() - 1;
  if (std::abs(off) <= 0.01) return;
  const char* unit = D == 2 ? "m" : "m2";
  notes.push_back(
      fmt::format("inflow '{}': its {} particles have a cross-section of {:.4g} {}, {:.2g} % {} than the {:.4g} "
                  "{} of its nozzle{}",
                  body.name, layers.size(), layers.area(), unit, 100 * std::abs(off), off > 0 ? "more" : "less",
                  layers.openingArea(), unit,
                  body.inflow.flowRate ? "; its speed follows from the flow rate and theirs" : ""));
}

template class NozzleLayers<2>;
template class NozzleLayers<3>;
template void describeNozzle(const Body&, const NozzleLayers<2>&, std::vector<std::string>&);
template void describeNozzle(const Body&, const NozzleLayers<3>&, std::vector<std::string>&);

}  // namespace treacle
