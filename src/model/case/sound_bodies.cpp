#include "case_checker.hpp"
#include "geometry/polygon.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/side.hpp"
#include "treacle/model/motion/nozzle.hpp"
#include "treacle/model/motion/opening.hpp"

namespace treacle {
namespace {

void requireCone(const Checker& at, const Shape& s) {
  if (s.startRadius == 0 && s.endRadius == 0)
    at.fail({"end_radius"}, "expected more than 0 at one end of the axis, found 0 at both");
  const auto requireLess = [&](std::string_view key, double inner, std::string_view of, double radius) {
    if (inner > radius) at.fail({key}, fmt::format("expected at most {} = {}, found {}", of, radius, inner));
  };
  requireLess("inner_start_radius", s.innerStartRadius, "start_radius", s.startRadius);
  requireLess("inner_end_radius", s.innerEndRadius, "end_radius", s.endRadius);
  if (s.innerStartRadius == s.startRadius && s.innerEndRadius == s.endRadius)
    at.fail({"inner_end_radius"}, "found no room between the inner and the outer radii");
}

void requireTorus(const Checker& at, const Shape& s) {
  if (at.wholeCase().dimensions == 2)
    at.fail({"shape"}, "a torus has three dimensions; in the plane a ring is a sphere with an inner_radius");
  at.requireDirection("axis", s.axis);
  if (s.tubeRadius >= s.radius)
    at.fail({"tube_radius"}, fmt::format("expected less than radius = {}, found {}", s.radius, s.tubeRadius));
  if (s.innerRadius >= s.tubeRadius)
    at.fail({"inner_radius"},
            fmt::format("expected less than tube_radius = {}, found {}", s.tubeRadius, s.innerRadius));
}

/// Corners in order.
void requireOutline(const Checker& at, const std::vector<Vec<2>>& points, bool closed = true) {
  constexpr std::size_t most = 10'000;
  const std::size_t count = points.size(), least = closed ? 3 : 2;
  if (count < least || count > most)
    at.fail({"points"},
            fmt::format("expected {} to {} points, the corners in order, found {}", least, most, count));
  const auto text = [&](std::size_t k) {
    return fmt::format("({}, {})", points[k % count][0], points[k % count][1]);
  };
  if (const auto sides = crossingSides(points, closed)) {
    const auto [a, b] = *sides;
    if (a == b)
      at.fail({"points"},
              fmt::format("found {} twice in a row, as points {} and {}", text(a), a + 1, (a + 1) % count + 1));
    at.fail({"points"}, fmt::format("the side from {} to {} meets that from {} to {}: expected corners in order, "
                                    "whose sides meet nowhere else",
                                    text(a), text(a + 1), text(b), text(b + 1)));
  }
  if (closed && signedArea2(points) == 0)
    at.fail({"points"}, "expected a polygon with an area, found points in a line");
}

void requirePolygon(const Checker& at, const Shape& s) {
  requireOutline(at, s.points, s.kind == ShapeKind::Polygon);
  if (at.wholeCase().dimensions == 3 && !(s.bottom < s.top))
    at.fail({"top"}, fmt::format("expected more than bottom = {}, found {}", s.bottom, s.top));
}

void requireThinSheet(const Checker& at, const Body& b) {
  const bool line = b.shape.kind == ShapeKind::Polyline;
  if (b.kind != BodyKind::Wall)
    at.fail({line ? "shape" : "fill"},
            fmt::format("a {} is for bodies of type \"wall\"", line ? "polyline" : "thin-sheet"));
  const std::vector<Body>& bodies = at.wholeCase().bodies;
  const auto count = std::ranges::count_if(bodies, [](const Body& body) { return body.shape.isThinSheet(); });
  if (count > sides::mostSheets)
    at.fail({"shape"}, fmt::format("expected at most {} thin sheets, found {}", sides::mostSheets, count));
}

void requireShape(const Checker& at, const Shape& s) {
  switch (s.kind) {
    case ShapeKind::Box:
      return at.requireOrder(s.min, s.max);
    case ShapeKind::Torus:
      return requireTorus(at, s);
    case ShapeKind::Polygon:
    case ShapeKind::Polyline:
      return requirePolygon(at, s);
    case ShapeKind::Mesh:
      if (at.wholeCase().dimensions == 2)
        at.fail({"shape"},
                "a mesh has three dimensions; in the plane shape = \"polygon\" takes the points of an outline");
      return;
    case ShapeKind::Particles:
      return;
    case ShapeKind::Sphere:
    case ShapeKind::Cylinder:
    case ShapeKind::Cone:
      break;
  }
  if (s.kind != ShapeKind::Sphere && s.start == s.end) at.fail({"end"}, "expected a point other than start");
  if (s.kind == ShapeKind::Cone) return requireCone(at, s);
  if (s.innerRadius >= s.radius)
    at.fail({"inner_radius"}, fmt::format("expected less than radius = {}, found {}", s.radius, s.innerRadius));
}

/// Its torque has no nearest image.
void requireRigid(const Checker& at, const Body& b) {
  const Case& c = at.wholeCase();
  const RigidSettings &r = b.rigid, free{};
  if (c.hasThinSheets())
    at.fail({"type"},
            "found beside a thin sheet; expected a case without rigid bodies, or walls with a thickness");
  if (r.hinge && (r.translates != free.translates || r.rotates != free.rotates))
    at.fail({"hinge"}, "expected either a hinge or translates and rotates, found both");
  if (r.hinge && norm(b.velocity) > 0)
    at.fail({"velocity"}, "a body on a hinge only turns; expected angular_velocity in its place");
  if (r.release > 0 && norm(b.velocity) > 0) at.fail({"velocity"}, "a body stands still until its release");
  if (r.release > 0 && norm(r.angularVelocity) > 0)
    at.fail({"angular_velocity"}, "a body stands still until its release");
  for (const Spring& s : r.springs)
    if (s.to == b.name) at.fail({"springs", s.name, "to"}, "expected another body, found that of the spring");
  for (int k = 0; k < c.dimensions; ++k)
    if (c.domain.periodic[static_cast<std::size_t>(k)])
      at.fail({"type"}, fmt::format("there can be no rigid body in a domain that is periodic along {}", "xyz"[k]));
}

/// Fails for bodies that the case does not have, for inflows, and for bodies that subtract each other.
void requireSubtracted(const Checker& at, const Body& b, const Body& from, std::size_t depth) {
  const std::vector<Body>& bodies = at.wholeCase().bodies;
  for (const std::string& name : from.subtract) {
    const auto found = std::ranges::find(bodies, name, &Body::name);
    if (found == bodies.end()) {
      std::vector<std::string_view> names;
      for (const Body& other : bodies)
        if (other.kind != BodyKind::Inflow && other.name != b.name) names.push_back(other.name);
      at.fail({"subtract"}, wrongWord(names, name));
    }
    if (found->kind == BodyKind::Inflow)
      at.fail({"subtract"}, fmt::format("'{}' is an inflow; expected bodies that have a shape", name));
    if (found->shape.isThinSheet())
      at.fail({"subtract"},
              fmt::format("'{}' is a thin sheet, which holds no place; fluid may be on both sides", name));
    if (found->name == b.name)
      at.fail({"subtract"}, from.name == b.name
                                ? fmt::format("expected other bodies than '{}' itself", name)
                                : fmt::format("'{}' and '{}' subtract each other", b.name, from.name));
    if (depth < bodies.size()) requireSubtracted(at, b, *found, depth + 1);
  }
}

}  // namespace

void requireSound(const Checker& at, const Rotation& r) {
  if (r.angle && r.speed != 0) at.fail({"angle"}, "expected one of speed and angle, found both");
  at.requireDirection("axis", r.axis);
  at.requireFinite({"angle"}, r.angle);
}

void requireSound(const Checker& at, const Hinge& h) { at.requireDirection("axis", h.axis); }

void requireSound(const Checker& at, const Spring& s) {
  const auto isIt = [&](const Body& b) { return b.kind == BodyKind::Rigid && b.name == s.to; };
  if (!s.to.empty() && std::ranges::none_of(at.wholeCase().bodies, isIt))
    at.fail({"to"}, fmt::format("expected the name of a rigid body, found '{}'", s.to));
}

void requireSound(const Checker& at, const Transform& t) {
  at.requireDirection("axis", t.axis);
  if (t.angle != 0 && norm2(t.angles) > 0)
    at.fail({"angles"}, "expected either angle, about axis, or angles, about x, y and z; found both");
}

void requireSound(const Checker& at, const Nozzle& n) {
  at.requireDirection("direction", n.direction);
  if (n.kind == NozzleKind::Disc && n.innerRadius >= n.radius)
    at.fail({"inner_radius"}, fmt::format("expected less than radius = {}, found {}", n.radius, n.innerRadius));
  if (n.kind == NozzleKind::Polygon) {
    if (at.wholeCase().dimensions == 2)
      at.fail({"shape"}, "a polygon has two dimensions; in the plane an opening is a \"rectangle\" with a width");
    requireOutline(at, n.points);
  }
  if (norm(cross(n.up, n.direction)) <= 1e-6 * norm(n.up) * norm(n.direction) && norm(n.up) > 0)
    at.fail({"up"}, "expected a vector that is not along the direction");
}

/// What flows through a nozzle, while it does. Formulas that fall to zero may miss it by rounding.
void requireNotNegative(const Checker& at, std::string_view key, const std::optional<TimeFunction>& f,
                        const Inflow& i) {
  constexpr int samples = 1000;
  const double last = at.wholeCase().time.end, end = i.end > 0 ? std::min(i.end, last) : last;
  if (!f || f->expression.empty() || !(i.start < end && std::isfinite(end))) return;
  for (int k = 0; k < samples; ++k) {
    const double t = i.start + (end - i.start) * k / samples;
    if (const double value = f->at(t); value < -1e-9 * at.wholeCase().spacing)
      at.fail({key}, fmt::format("expected no negative numbers, found {:g} at t = {:g} s", value, t));
  }
}

void requireSound(const Checker& at, const Inflow& i) {
  if (i.speed.has_value() == i.flowRate.has_value())
    at.fail({i.speed ? "flow_rate" : "speed"},
            i.speed ? "expected one of speed and flow_rate, found both" : "missing; expected speed or flow_rate");
  if (i.end > 0 && i.end <= i.start)
    at.fail({"end"},
            fmt::format("expected 0, which is never, or more than start = {} s, found {}", i.start, i.end));
  at.requireFinite({"speed"}, i.speed, i.start);
  at.requireFinite({"flow_rate"}, i.flowRate, i.start);
  requireNotNegative(at, "speed", i.speed, i);
  requireNotNegative(at, "flow_rate", i.flowRate, i);
}

/// Once the nozzle is known to be sound.
template <int D>
void requireProfile(const Checker& at, const Body& body) {
  const std::string& profile = body.inflow.profile;
  if (profile == plugProfile) return;
  if (profile != parabolicProfile) {
    try {
      Expression{profile, D};
    } catch (const InputError& e) {
      at.fail({"profile"}, fmt::format("\"{}\" is neither \"{}\" nor \"{}\"; {}", profile, plugProfile,
                                       parabolicProfile, e.what()));
    }
  } else if (body.inflow.nozzle.kind == NozzleKind::Polygon) {
    at.fail({"profile"}, fmt::format("\"{}\" is for a disc or a rectangle; expected \"{}\" or an expression of x, "
                                     "y and z for a polygon",
                                     profile, plugProfile));
  }
  Body plug = body;
  plug.inflow.profile = plugProfile;
  NozzleLayers<D>(at.wholeCase(), plug);  // where its errors are none of the profile
  try {
    NozzleLayers<D>(at.wholeCase(), body);
  } catch (const InputError& e) {
    at.fail({"profile"}, e.what());
  }
}

void requireSound(const Checker& at, const Outflow& o) {
  if (o.kind == OutflowKind::Box) return at.requireOrder(o.min, o.max);
  at.requireDirection("normal", o.normal);
}

template <int D>
void requireReserve(const Checker& at, const Opening& o) {
  const Case& c = at.wholeCase();
  constexpr int depth = OpeningForce<D>::depth;
  const OpeningFace<D> face(c, o);
  for (std::size_t column = 0; column < face.columns(); ++column) {
    const Vec<D> x = face.at(column, depth + 1);
    for (int k = 0; k < D; ++k)
      if (!(x[k] >= c.domain.min[k] && x[k] < c.domain.max[k]))
        at.fail({"face", "center"},
                fmt::format("the reserve behind the face, {} spacings or {}, reaches out of the domain along {}: "
                            "expected the face farther inside, or a larger domain",
                            depth + 1, lengthText((depth + 1) * c.spacing), "xyz"[k]));
  }
}

void requireSound(const Checker& at, const Opening& o) {
  const Nozzle& face = o.face;
  if (face.kind == NozzleKind::Polygon || face.innerRadius > 0)
    at.fail({"face", face.kind == NozzleKind::Polygon ? "shape" : "inner_radius"},
            "the face of an opening is a whole \"disc\" or a \"rectangle\"");
  if (o.pressure && o.flowRate)
    at.fail({"flow_rate"}, "expected at most one of pressure and flow_rate, found both");
  at.requireFinite({"pressure"}, o.pressure);
  at.requireFinite({"flow_rate"}, o.flowRate);
  const auto isIt = [&](const Body& b) { return b.holdsFluid() && b.material == o.material; };
  if (std::ranges::none_of(at.wholeCase().bodies, isIt))
    at.fail({"material"}, "expected the material of a body of type \"fluid\" or \"inflow\"");
  at.wholeCase().dimensions == 2 ? requireReserve<2>(at, o) : requireReserve<3>(at, o);
}

/// Errors: CaseError for states that the body's material does not have, or that start outside their bounds.
void requireStates(const Checker& at, const Body& b) {
  const Material& m = at.wholeCase().materials[static_cast<std::size_t>(b.material)];
  for (const StateStart& start : b.states) {
    const auto state = std::ranges::find(m.states, start.name, &MaterialState::name);
    if (state == m.states.end())
      at.fail({"state", start.name, "name"},
              fmt::format("the material '{}' has no state '{}'", m.name, start.name));
    if (start.expression.empty() && !(start.value >= state->lowest() && start.value <= state->highest()))
      at.fail({"state", start.name, "value"}, fmt::format("expected a number from {} to {}, found {}",
                                                          state->lowest(), state->highest(), start.value));
  }
}

/// Only fluids start with velocities of their own for each particle, only walls and nozzles are moved.
void requireSound(const Checker& at, const Body& b) {
  at.requireFinite({"displacement"}, b.displacement);
  if (b.kind == BodyKind::Inflow) {
    requireSound(at, b.inflow);
    return at.wholeCase().dimensions == 2 ? requireProfile<2>(at, b) : requireProfile<3>(at, b);
  }
  requireShape(at, b.shape);
  if (b.shape.isThinSheet()) requireThinSheet(at, b);
  requireSubtracted(at, b, b, 0);
  if (b.kind == BodyKind::Rigid) requireRigid(at, b);
  at.requireFinite({"force"}, b.rigid.force);
  at.requireFinite({"torque"}, b.rigid.torque);
  requireStates(at, b);
  if (b.kind == BodyKind::Fluid) {
    constexpr const char* text = "only a body of type \"wall\" can have one";
    if (b.displacement != TimeVector{}) at.fail({"displacement"}, text);
    if (b.oscillation != Oscillation{}) at.fail({"oscillation"}, text);
    if (b.rotation) at.fail({"rotation"}, text);
    return;
  }
  if (!b.temperatureExpression.empty())
    at.fail({"temperature"}, fmt::format("only a body of type \"fluid\" can have an expression, found \"{}\"",
                                         b.temperatureExpression));
  if (b.wallConductance > 0 && b.temperature == 0)
    at.fail({"temperature"},
            "missing; expected that of what is behind a wall with wall_conductance: a positive number [K]");
  for (const std::string& text : b.velocityExpression)
    if (!text.empty())
      at.fail({"velocity"}, fmt::format("only a body of type \"fluid\" can have expressions; expected an array of "
                                        "{} finite numbers [m/s], found \"{}\"",
                                        at.wholeCase().dimensions, text));
}

}  // namespace treacle
