#include "treacle/model/motion/nozzle.hpp"

#include "geometry/wall_turn.hpp"
#include "nozzle_lattice.hpp"
#include "nozzle_profile.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {
namespace {

/// The one of a single vector is at its first place.
template <int D>
NozzleColumns<D> latticeOf(std::span<const Vec<D>> across, const std::array<Vec<D>, D - 1>& axes, double spacing) {
  NozzleColumns<D> lattice;
  lattice.spacing = spacing;
  for (int k = 0; k < D - 1; ++k) {
    lattice.axes[k] = axes[static_cast<std::size_t>(k)];
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec<D>& x : across) {
      const double along = dot(x, lattice.axes[k]);
      low = std::min(low, along), high = std::max(high, along);
    }
    lattice.first += low * lattice.axes[k];
    lattice.counts[k] = static_cast<int>(std::lround((high - low) / spacing)) + 1;
  }
  return lattice;
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
  profile_ = nozzleProfile<D>(body, across_, axes);
  lattice_ = latticeOf<D>(std::span(across_).first(profile_.size()), axes, spacing_);
}

template <int D>
Vec<D> NozzleLayers<D>::direction(double t) const {
  return body_.rotation ? wallTurn<D>(body_, t).turned(direction_) : direction_;
}

template <int D>
std::vector<Vec<D>> NozzleLayers<D>::layer(std::span<const double> ways, double t) const {
  std::vector<Vec<D>> places;
  places.reserve(across_.size());
  const Vec<3>& center = body_.inflow.nozzle.center;
  const auto way = [&](std::size_t column) { return ways[ways.size() == 1 ? 0 : column] * direction_; };
  if (!body_.rotation) {
    const Vec<D> middle = resized<D>(center + wallDisplacement(body_, t));
    for (std::size_t k = 0; k < across_.size(); ++k) places.push_back(middle + way(k) + across_[k]);
    return places;
  }
  const WallMotion<D> turn = wallTurn<D>(body_, t);
  const Vec<D> pivot = resized<D>(wallCenter(body_, t)), middle = resized<D>(center - body_.rotation->center);
  for (std::size_t k = 0; k < across_.size(); ++k)
    places.push_back(pivot + turn.turned(middle + way(k) + across_[k]));
  return places;
}

template <int D>
std::vector<double> NozzleLayers<D>::excess() const {
  std::vector<double> more(profile_);
  for (double& x : more) x -= 1;
  return more;
}

/// Where the nozzle is at time t, as layer() has it.
template <int D>
NozzleColumns<D> NozzleLayers<D>::columns(const Domain& domain, double t) const {
  NozzleColumns<D> now = lattice_;
  const Vec<3>& center = body_.inflow.nozzle.center;
  if (body_.rotation) {
    const WallMotion<D> turn = wallTurn<D>(body_, t);
    for (Vec<D>& axis : now.axes) axis = turn.turned(axis);
    now.first = resized<D>(wallCenter(body_, t)) +
                turn.turned(resized<D>(center - body_.rotation->center) + lattice_.first);
  } else {
    now.first = resized<D>(center + wallDisplacement(body_, t)) + lattice_.first;
  }
  for (int k = 0; k < D; ++k)
    if (domain.periodic[static_cast<std::size_t>(k)]) now.period[k] = domain.max[k] - domain.min[k];
  return now;
}

template <int D>
std::vector<Vec<D>> NozzleLayers<D>::eachOf(std::span<const double> multiples, const Vec<D>& of) const {
  std::size_t places = 1;
  for (const int count : lattice_.counts) places *= static_cast<std::size_t>(count);
  std::vector<Vec<D>> each(places);
  for (std::size_t k = 0; k < multiples.size(); ++k) each[lattice_.placeOf(across_[k])] = multiples[k] * of;
  return each;
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
