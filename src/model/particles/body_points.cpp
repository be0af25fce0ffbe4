#include "body_points.hpp"

#include "geometry/body_region.hpp"
#include "geometry/mesh_notes.hpp"
#include "given_points.hpp"
#include "lattice.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/motion/nozzle.hpp"

#include <fmt/format.h>
#include <cmath>
#include <functional>
#include <optional>

namespace treacle {
namespace {

/// Errors: InputError for a value that is not finite.
template <int D>
double valueAt(const Vec<D>& x, const Expression& expression, const Body& body, const char* key,
               const std::string& text) {
  const double value = expression(resized<3>(x));
  if (!std::isfinite(value))
    throw CaseError({"body", body.name, key},
                    fmt::format("\"{}\" is {} for the particle at {}; expected a finite number", text,
                                std::isnan(value) ? "not a number" : "infinite", positionText(resized<3>(x), D)));
  return value;
}

template <int D>
double positiveAt(const Vec<D>& x, const Expression& expression, const Body& body, const char* key,
                  const std::string& text, const char* unit) {
  const double value = valueAt(x, expression, body, key, text);
  if (value > 0) return value;
  throw CaseError({"body", body.name, key},
                  fmt::format("\"{}\" is {}{} for the particle at {}; expected more than 0", text, value, unit,
                              positionText(resized<3>(x), D)));
}

/// Asked for each particle as it is made: a body that is too large by far ends there and not in all the memory.
template <int D>
void requireInside(const Domain& domain, const Body& body, const Vec<D>& x) {
  for (int k = 0; k < D; ++k)
    if (!(x[k] >= domain.min[k] && x[k] < domain.max[k]))
      throw InputError(fmt::format("body '{}' reaches out of the domain: a particle at {}, the domain is {}",
                                   body.name, positionText(resized<3>(x), D),
                                   rangeText(domain.min, domain.max, D)));
}

/// Before the condition of the body.
template <int D>
BodyPoints<D> pointsOf(const Case& c, const Body& body, std::vector<std::string>& notes,
                       const std::function<bool(const Vec<D>&)>& keep) {
  if (body.shape.kind == ShapeKind::Particles) return givenPoints<D>(c, body, notes, keep);
  return {latticePoints<D>(c, body, notes, keep), {}};
}

}  // namespace

template <int D>
BodyPoints<D> bodyPoints(const Case& c, const Body& body, std::vector<std::string>& notes) {
  requireContent(body);
  std::optional<Expression> where;
  if (!body.where.empty()) where.emplace(body.where, D);
  const std::vector<BodyRegion<D>> subtracted = subtractedRegions<D>(c, body);
  std::size_t all = 0;
  BodyPoints<D> points = pointsOf<D>(c, body, notes, [&](const Vec<D>& x) {
    ++all;
    if (where && valueAt(x, *where, body, "where", body.where) == 0) return false;
    for (const BodyRegion<D>& region : subtracted)
      if (region.holds(x)) return false;
    if (!body.shape.isThinSheet()) requireInside(c.domain, body, x);  // a sheet may be larger
    return true;
  });
  if (where && points.size() == 0)
    notes.push_back(
        fmt::format("body '{}': where = \"{}\" holds at none of its {} particles", body.name, body.where, all));
  return points;
}

template <int D>
BodyPoints<D> nozzlePoints(const Case& c, const Body& body, BodyKind kind, std::vector<std::string>& notes) {
  const NozzleLayers<D> layers(c, body);
  BodyPoints<D> points;
  const auto add = [&](double way) {
    for (const Vec<D>& x : layers.layer(way, 0)) {
      requireInside(c.domain, body, x);
      points.place.push_back(x);
    }
  };
  if (kind == BodyKind::Fluid) {
    if (layers.speed(0, 0) > 0) add(c.spacing / 2);
    return points;
  }
  describeNozzle(body, layers, notes);
  for (int k = 0; k < layers.depth(); ++k) add(-(k + 0.5) * c.spacing);
  return points;
}

template <int D>
InitialState<D>::InitialState(const Case& c, const Body& body)
    : body_(body),
      disorder_(body.disorder * c.spacing),
      wall_(wallMotion<D>(c.domain, body, 0, 0)),
      expressions_(D),
      similarity_(similarityOf<D>(body.shape)) {
  if (body.kind == BodyKind::Inflow) {
    const NozzleLayers<D> layers(c, body);
    wall_ = layers.motion(c.domain, 0, 0);
    const Vec<D> mean = layers.speed(0, 0) * layers.direction(0);
    for (const double share : layers.excess()) excess_.push_back(share * mean);
  }
  for (std::size_t k = 0; k < D; ++k)
    if (const std::string& text = body.velocityExpression[k]; !text.empty()) expressions_[k].emplace(text, D);
  if (!body.temperatureExpression.empty()) temperature_.emplace(body.temperatureExpression, D);
  if (!body.viscosityFactorExpression.empty()) viscosityFactor_.emplace(body.viscosityFactorExpression, D);
  const Material& material = c.materials[static_cast<std::size_t>(body.material)];
  for (const std::string& name : c.stateNames()) {
    StartingState& state = states_.emplace_back();
    const auto own = std::ranges::find(material.states, name, &MaterialState::name);
    if (own == material.states.end()) continue;
    state.value = own->start, state.least = own->lowest(), state.most = own->highest();
    const auto given = std::ranges::find(body.states, name, &StateStart::name);
    if (given == body.states.end()) continue;
    state.value = given->value, state.given = &*given;
    if (!given->expression.empty()) state.expression.emplace(given->expression, D);
  }
}

template <int D>
bool InitialState<D>::hasExpressions() const {
  const auto isThere = [](const auto& expression) { return expression.has_value(); };
  return temperature_ || viscosityFactor_ || std::ranges::any_of(expressions_, isThere) ||
         std::ranges::any_of(states_, isThere, &StartingState::expression);
}

template <int D>
Vec<D> InitialState<D>::placeOf(const BodyPoints<D>& points, std::size_t k, std::uint32_t id) const {
  Vec<D> x = points.place[k];
  if (disorder_ > 0)
    for (int axis = 0; axis < D; ++axis)
      x[axis] += disorder_ * pseudoRandom(D * id + static_cast<std::uint32_t>(axis));
  return x;
}

template <int D>
Vec<D> InitialState<D>::velocityAt(const BodyPoints<D>& points, std::size_t k) const {
  const Vec<D>& x = points.place[k];
  if (excess_.size() > 1) return wall_.velocityAt(x) + excess_[k % excess_.size()];
  if (body_.kind != BodyKind::Fluid) return wall_.velocityAt(x);
  Vec<D> u = resized<D>(body_.velocity);
  for (std::size_t axis = 0; axis < D; ++axis)
    if (expressions_[axis])
      u[static_cast<int>(axis)] =
          valueAt(x, *expressions_[axis], body_, "velocity", body_.velocityExpression[axis]);
  if (body_.fileVelocities)
    u += similarity_.direction(resized<D>(body_.shape.file.particles.value->velocity[points.given[k]]));
  return u;
}

template <int D>
double InitialState<D>::temperatureAt(const BodyPoints<D>& points, std::size_t k) const {
  if (body_.fileTemperatures) return body_.shape.file.particles.value->temperature[points.given[k]];
  const Vec<D>& x = points.place[k];
  if (!temperature_) return body_.temperature;
  return positiveAt(x, *temperature_, body_, "temperature", body_.temperatureExpression, " K");
}

template <int D>
double InitialState<D>::viscosityFactorAt(const Vec<D>& x) const {
  if (viscosityFactor_)
    return positiveAt(x, *viscosityFactor_, body_, "viscosity_factor", body_.viscosityFactorExpression, "");
  return body_.viscosityFactor > 0 ? body_.viscosityFactor : 1;
}

template <int D>
double InitialState<D>::stateAt(std::size_t k, const Vec<D>& x) const {
  const StartingState& state = states_[k];
  if (!state.expression) return state.value;
  const double value = valueAt(x, *state.expression, body_, "state", state.given->expression);
  if (!(value >= state.least && value <= state.most))
    throw InputError(fmt::format("body '{}': state '{}' = \"{}\" is {} at {}; expected a number from {} to {}",
                                 body_.name, state.given->name, state.given->expression, value,
                                 positionText(resized<3>(x), D), state.least, state.most));
  return value;
}

template BodyPoints<2> bodyPoints<2>(const Case&, const Body&, std::vector<std::string>&);
template BodyPoints<3> bodyPoints<3>(const Case&, const Body&, std::vector<std::string>&);
template BodyPoints<2> nozzlePoints<2>(const Case&, const Body&, BodyKind, std::vector<std::string>&);
template BodyPoints<3> nozzlePoints<3>(const Case&, const Body&, BodyKind, std::vector<std::string>&);
template class InitialState<2>;
template class InitialState<3>;

}  // namespace treacle
