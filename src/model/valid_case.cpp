#include "polygon.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case_error.hpp"
#include "treacle/model/case_keys.hpp"
#include "treacle/model/checks.hpp"
#include "treacle/model/expression.hpp"
#include "treacle/model/shape.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <utility>

namespace treacle {
namespace {

/// One table of a case: its values are checked one by one, as a visitor of its keys, then by `requireSound`
/// together.
class Checker {
 public:
  Checker(const Case& c, CasePath path) : case_(c), path_(std::move(path)) {}

  template <class Table>
  void check(const Table& table) const {
    keys::visit(*this, table, case_);
    requireSound(*this, table);
  }

  const Case& wholeCase() const { return case_; }

  /// `keys`: the way from this table.
  [[noreturn]] void fail(std::initializer_list<std::string_view> keys, const std::string& text) const {
    throw CaseError(below(keys), text);
  }

  void operator()(const Key&, bool) const {}
  void operator()(const Key&, const std::array<bool, 3>&) const {}
  void operator()(const Key&, const OutputFields&) const {}
  void operator()(const Key& key, double x) const { require(key.bound.holds(x), key, expectedNumber(key), x); }
  void operator()(const Key& key, int x) const { require(key.bound.holds(x), key, expectedInteger(key), x); }
  void operator()(const Key& key, const Vec<3>& x) const {
    requireVector(key, x, expectedVector(key, case_.dimensions));
  }
  void operator()(const Key& key, const std::string& text) const {
    if (key.required && text.empty()) fail({key.name}, "missing; expected a string");
  }
  void operator()(const Key& key, const std::string& text, keys::ExpressionTag) const {
    if (text.empty()) return;
    try {
      Expression{text, case_.dimensions};
    } catch (const InputError& e) {
      fail({key.name}, e.what());
    }
  }
  void operator()(const Key& key, double x, const std::string& text) const {
    (*this)(key, text, keys::expression);
    if (text.empty()) require(key.bound.holds(x), key, expectedNumber(key, false, true), x);
  }
  void operator()(const Key& key, const std::vector<double>& numbers) const {
    for (const double x : numbers) require(key.bound.holds(x), key, expectedNumbers(key), x);
  }
  void operator()(const Key& key, const std::string& path, keys::FileTag) const { (*this)(key, path); }
  void operator()(const Key& key, const std::vector<Vec<2>>& points) const {
    for (const Vec<2>& x : points)
      for (int k = 0; k < 2; ++k) require(key.bound.holds(x[k]), key, expectedPoints(key), x[k]);
  }
  void operator()(const Key& key, Vec<3> x, const std::array<std::string, 3>& texts) const {
    for (int k = 0; k < case_.dimensions; ++k) {
      const std::string& text = texts[static_cast<std::size_t>(k)];
      (*this)(key, text, keys::expression);
      if (!text.empty()) x[k] = 0;  // does not count
    }
    requireVector(key, x, expectedVector(key, case_.dimensions, true));
  }
  void operator()(const Key& key, int index, keys::MaterialTag) const {
    const std::size_t count = case_.materials.size();
    if (index < 0 || static_cast<std::size_t>(index) >= count)
      fail({key.name}, fmt::format("expected the index of one of {} materials, found {}", count, index));
  }
  void operator()(const Key& key, double x, bool isAuto, keys::OrAutoTag) const {
    if (!isAuto) require(key.bound.holds(x), key, expectedNumber(key, true), x);
  }
  template <class E, class Fits = keys::AllFit>
  requires std::is_enum_v<E>
  void operator()(const Key& key, E value, Fits fits = {}) const {
    const std::string_view word = nameOf(value);
    if (word.empty() || !fits(value)) fail({key.name}, wrongWord(wordsThat<E>(fits), word));
  }

  template <class Table>
  requires std::is_class_v<Table>
  void operator()(const Key& key, const Table& table) const { Checker(case_, below({key.name})).check(table); }
  void operator()(const Key& key, const Oscillation& oscillation) const {
    if (oscillation != Oscillation{}) Checker(case_, below({key.name})).check(oscillation);
  }
  void operator()(const Key& key, const std::optional<TimeFunction>& f) const {
    if (!f) return;
    if (f->isTable()) return requireTable(key, *f);
    if (f->expression.empty()) return require(key.bound.holds(f->value), key, expectedFunction(key), f->value);
    try {
      Expression::ofTime(f->expression);
    } catch (const InputError& e) {
      fail({key.name}, e.what());
    }
  }
  void operator()(const Key& key, const TimeVector& functions) const {
    for (const auto& f : functions) (*this)(key, f);
  }
  template <class Table>
  void operator()(const Key& key, const std::optional<Table>& table) const {
    if (table) (*this)(key, *table);
  }
  template <class Table>
  void operator()(const Key& key, const std::vector<Table>& tables) const {
    if (tables.empty() && key.required)
      fail({key.name}, fmt::format("missing; expected {}", expectedEntries(key)));
    if (tables.size() > key.bound.most)
      fail({key.name}, fmt::format("expected at most {}, found {}", key.bound.most, tables.size()));
    for (std::size_t k = 0; k < tables.size(); ++k) {
      const std::string& name = tables[k].name;
      if (!name.empty() && std::ranges::count(tables, name, &Table::name) > 1)
        fail({key.name}, fmt::format("two [[{}]] are named '{}'", key.name, name));
      Checker(case_, below({key.name, name.empty() ? std::to_string(k) : name})).check(tables[k]);
    }
  }

 private:
  template <class T>
  void require(bool sound, const Key& key, const std::string& expected, T found) const {
    if (!sound) fail({key.name}, mismatch(key, expected, fmt::format("{}", found)));
  }

  void requireTable(const Key& key, const TimeFunction& f) const {
    if (f.values.size() != f.times.size())
      fail({key.name},
           fmt::format("expected as many values as times, {}, found {}", f.times.size(), f.values.size()));
    for (std::size_t k = 0; k < f.times.size(); ++k) {
      require(key.bound.holds(f.values[k]), key, expectedNumber(key), f.values[k]);
      if (!std::isfinite(f.times[k])) fail({key.name}, fmt::format("expected finite times, found {}", f.times[k]));
      if (k > 0 && !(f.times[k - 1] < f.times[k]))
        fail({key.name}, fmt::format("expected rising times, found {} after {}", f.times[k], f.times[k - 1]));
    }
  }

  void requireVector(const Key& key, const Vec<3>& x, const std::string& expected) const {
    for (int k = 0; k < case_.dimensions; ++k) require(key.bound.holds(x[k]), key, expected, x[k]);
    for (int k = case_.dimensions; k < 3; ++k)
      if (x[k] != 0) fail({key.name}, fmt::format("expected 0 along {} in a plane, found {}", "xyz"[k], x[k]));
  }

  CasePath below(std::initializer_list<std::string_view> keys) const {
    CasePath path = path_;
    path.insert(path.end(), keys.begin(), keys.end());
    return path;
  }

  const Case& case_;
  CasePath path_;
};

template <class Table>
void requireSound(const Checker&, const Table&) {}

void requireOrder(const Checker& at, const Vec<3>& min, const Vec<3>& max) {
  for (int k = 0; k < at.wholeCase().dimensions; ++k)
    if (!(min[k] < max[k]))
      at.fail({"max"}, fmt::format("expected more than min on every axis, found {} <= {} along {}", max[k], min[k],
                                   "xyz"[k]));
}

void requireSound(const Checker& at, const Domain& d) { requireOrder(at, d.min, d.max); }

void requireSound(const Checker& at, const Rotation& r) {
  if (r.angle && r.speed != 0) at.fail({"angle"}, "expected one of speed and angle, found both");
  if (const double length = norm(r.axis); length == 0 || !std::isfinite(length))
    at.fail({"axis"}, fmt::format("expected a direction, found a vector of length {}", length));
}

/// The viscosity of every shear rate must be finite, and that of a fluid at rest positive: without any it would
/// fall apart.
void requireSound(const Checker& at, const Rheology& r) {
  using enum RheologyModel;
  if (r.mostViscosity > 0 && r.mostViscosity <= r.leastViscosity)
    at.fail({"max_viscosity"},
            fmt::format("expected more than min_viscosity = {}, found {}", r.leastViscosity, r.mostViscosity));
  const bool plateaus = r.model == Cross || r.model == CarreauYasuda;
  if (plateaus && r.infiniteViscosity > r.zeroViscosity)
    at.fail({"infinite_viscosity"},
            fmt::format("expected at most zero_viscosity = {}, found {}", r.zeroViscosity, r.infiniteViscosity));
  if (plateaus && r.flowIndex > 1)
    at.fail({"flow_index"}, fmt::format("expected at most 1 between two plateaus, found {}", r.flowIndex));
  const bool power = r.model == PowerLaw || r.model == HerschelBulkley;
  if (power && r.flowIndex < 1 && r.mostViscosity == 0)
    at.fail({"max_viscosity"},
            fmt::format("expected a positive number [Pa s]: with flow_index = {} < 1 a fluid at rest would be "
                        "infinitely viscous",
                        r.flowIndex));
  if (r.model == PowerLaw && r.flowIndex > 1 && r.leastViscosity == 0)
    at.fail(
        {"min_viscosity"},
        fmt::format("expected a positive number [Pa s]: with flow_index = {} > 1 a fluid at rest would have no "
                    "viscosity",
                    r.flowIndex));
}

/// Shift factors that are defined at all temperatures, and tables that are functions.
void requireSound(const Checker& at, const ViscosityShift& s) {
  if (s.least >= s.most)
    at.fail({"max_factor"}, fmt::format("expected more than min_factor = {}, found {}", s.least, s.most));
  if (s.model == ShiftModel::Vft && s.divergence >= s.reference)
    at.fail({"t0"},
            fmt::format("expected less than reference_temperature = {} K, found {}", s.reference, s.divergence));
  if (s.model != ShiftModel::Table) return;
  const std::size_t rows = s.temperatures.size();
  if (rows < 2 || rows > ViscosityShift::mostRows)
    at.fail({"temperatures"}, fmt::format("expected 2 to {} numbers, found {}", ViscosityShift::mostRows, rows));
  if (s.factors.size() != rows)
    at.fail({"factors"},
            fmt::format("expected as many numbers as temperatures, {}, found {}", rows, s.factors.size()));
  for (std::size_t k = 1; k < rows; ++k)
    if (!(s.temperatures[k - 1] < s.temperatures[k]))
      at.fail({"temperatures"},
              fmt::format("expected rising numbers, found {} after {}", s.temperatures[k], s.temperatures[k - 1]));
}

void requireSound(const Checker& at, const Material& m) {
  if (m.rheology && at.wholeCase().method.kind != MethodKind::MphI)
    at.fail({"rheology"}, fmt::format("only the method '{}' has fluids that are not Newtonian, found '{}'",
                                      nameOf(MethodKind::MphI), nameOf(at.wholeCase().method.kind)));
  if (m.viscosityShift && !at.wholeCase().heat)
    at.fail({"viscosity_shift"}, "there are no temperatures in a case without [heat]");
  if (at.wholeCase().method.kind != MethodKind::MphI &&
      (m.surfaceTension != 0 || m.contactAngle != Material{}.contactAngle))
    at.fail({m.surfaceTension != 0 ? "surface_tension" : "contact_angle"},
            fmt::format("only the method '{}' has surface tension, found '{}'", nameOf(MethodKind::MphI),
                        nameOf(at.wholeCase().method.kind)));
  if (m.rheology && m.dynamicViscosity != 0) at.fail({"dynamic_viscosity"}, viscosityBesideRheology);
}

void requireSound(const Checker& at, const Transform& t) {
  if (const double length = norm(t.axis); length == 0 || !std::isfinite(length))
    at.fail({"axis"}, fmt::format("expected a direction, found a vector of length {}", length));
  if (t.angle != 0 && norm2(t.angles) > 0)
    at.fail({"angles"}, "expected either angle, about axis, or angles, about x, y and z; found both");
}

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
  if (const double length = norm(s.axis); length == 0 || !std::isfinite(length))
    at.fail({"axis"}, fmt::format("expected a direction, found a vector of length {}", length));
  if (s.tubeRadius >= s.radius)
    at.fail({"tube_radius"}, fmt::format("expected less than radius = {}, found {}", s.radius, s.tubeRadius));
  if (s.innerRadius >= s.tubeRadius)
    at.fail({"inner_radius"},
            fmt::format("expected less than tube_radius = {}, found {}", s.tubeRadius, s.innerRadius));
}

void requirePolygon(const Checker& at, const Shape& s) {
  constexpr std::size_t most = 10'000;
  const std::size_t count = s.points.size();
  if (count < 3 || count > most)
    at.fail({"points"}, fmt::format("expected 3 to {} points, the corners in order, found {}", most, count));
  const auto text = [&](std::size_t k) {
    return fmt::format("({}, {})", s.points[k % count][0], s.points[k % count][1]);
  };
  if (const auto sides = crossingSides(s.points)) {
    const auto [a, b] = *sides;
    if (a == b)
      at.fail({"points"},
              fmt::format("found {} twice in a row, as points {} and {}", text(a), a + 1, (a + 1) % count + 1));
    at.fail({"points"}, fmt::format("the side from {} to {} meets that from {} to {}: expected corners in order, "
                                    "whose sides meet nowhere else",
                                    text(a), text(a + 1), text(b), text(b + 1)));
  }
  if (signedArea2(s.points) == 0) at.fail({"points"}, "expected a polygon with an area, found points in a line");
  if (at.wholeCase().dimensions == 3 && !(s.bottom < s.top))
    at.fail({"top"}, fmt::format("expected more than bottom = {}, found {}", s.bottom, s.top));
}

void requireSound(const Checker& at, const Shape& s) {
  switch (s.kind) {
    case ShapeKind::Box:
      return requireOrder(at, s.min, s.max);
    case ShapeKind::Torus:
      return requireTorus(at, s);
    case ShapeKind::Polygon:
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

void requireDirection(const Checker& at, const char* key, const Vec<3>& v) {
  if (norm(v) == 0) at.fail({key}, "expected a vector that is not zero");
}

void requireSound(const Checker& at, const Nozzle& n) {
  requireDirection(at, "direction", n.direction);
  if (n.kind == NozzleKind::Disc && n.innerRadius >= n.radius)
    at.fail({"inner_radius"}, fmt::format("expected less than radius = {}, found {}", n.radius, n.innerRadius));
  if (norm(cross(n.up, n.direction)) <= 1e-6 * norm(n.up) * norm(n.direction) && norm(n.up) > 0)
    at.fail({"up"}, "expected a vector that is not along the direction");
}

void requireSound(const Checker& at, const Inflow& i) {
  if (i.speed.has_value() == i.flowRate.has_value())
    at.fail({i.speed ? "flow_rate" : "speed"},
            i.speed ? "expected one of speed and flow_rate, found both" : "missing; expected speed or flow_rate");
  if (i.end > 0 && i.end <= i.start)
    at.fail({"end"},
            fmt::format("expected 0, which is never, or more than start = {} s, found {}", i.start, i.end));
}

void requireSound(const Checker& at, const Outflow& o) {
  if (o.kind == OutflowKind::Box) return requireOrder(at, o.min, o.max);
  requireDirection(at, "normal", o.normal);
}

/// The forces on it are those of MPH-I, and its torque has no nearest image.
void requireRigid(const Checker& at) {
  const Case& c = at.wholeCase();
  if (c.method.kind != MethodKind::MphI)
    at.fail({"type"}, fmt::format("only the method '{}' moves rigid bodies, found '{}'", nameOf(MethodKind::MphI),
                                  nameOf(c.method.kind)));
  for (int k = 0; k < c.dimensions; ++k)
    if (c.domain.periodic[static_cast<std::size_t>(k)])
      at.fail({"type"}, fmt::format("there can be no rigid body in a domain that is periodic along {}", "xyz"[k]));
}

/// Only fluids start with velocities of their own for each particle, only walls and nozzles are moved.
void requireSound(const Checker& at, const Body& b) {
  if (b.kind == BodyKind::Inflow) return requireSound(at, b.inflow);
  requireSound(at, b.shape);
  if (b.kind == BodyKind::Rigid) requireRigid(at);
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

void requireSound(const Checker& at, const Width& w) {
  if (!(w.from < w.to)) at.fail({"to"}, fmt::format("expected more than from = {}, found {}", w.from, w.to));
}

/// ISPH moves on pressures that come and go at the free surface: its errors do not fall with the step alone.
void requireAutomaticSteps(const Checker& at, const TimeSettings& t) {
  if (at.wholeCase().method.kind != MethodKind::MphI)
    at.fail({"step"},
            fmt::format("\"auto\" is for the method '{}', found '{}'; expected the longest step [s], and "
                        "courant to shorten it where the flow is fast",
                        nameOf(MethodKind::MphI), nameOf(at.wholeCase().method.kind)));
  if (t.least > t.step)
    at.fail({"min_step"}, fmt::format("expected at most max_step = {} s, found {}", t.step, t.least));
}

void requireSound(const Checker& at, const TimeSettings& t) {
  if (t.automatic) requireAutomaticSteps(at, t);
  const double steps = t.end / (t.automatic ? t.least : t.step);
  if (steps < 0.5 && !t.stepsVary())
    at.fail({"end"}, fmt::format("expected at least one step of {} s, found {}", t.step, t.end));
  if (steps > maxSteps)
    at.fail({t.automatic ? "min_step" : "step"}, fmt::format("{:.3g} steps to the end are too many", steps));
  constexpr double leastCourant = 1e-6, mostCourant = 100;
  if (t.courant != 0 && !(t.courant >= leastCourant && t.courant <= mostCourant))
    at.fail({"courant"},
            fmt::format("expected 0 or a number from {} to {}, found {}", leastCourant, mostCourant, t.courant));
}

/// What works on neighbour lists cannot do without them.
void requireSound(const Checker& at, const SolverSettings& s) {
  if (at.wholeCase().method.kind != MethodKind::MphI || s.neighbours == NeighbourKind::Lists) return;
  const auto refuse = [&](std::string_view key, std::string_view word) {
    at.fail({"neighbours"},
            fmt::format("expected 'lists' with {} = '{}', found 'ranges': that needs lists", key, word));
  };
  const MultigridSettings& m = s.multigrid;
  if (s.preconditioner == PreconditionerKind::ProjectedMultigrid)
    refuse("preconditioner", nameOf(s.preconditioner));
  if (s.operatorKind == OperatorKind::Assembled) refuse("operator", nameOf(s.operatorKind));
  if (m.particleDiagonal == SmootherDiagonal::ExtendedJacobi)
    refuse("multigrid.particle_diagonal", nameOf(m.particleDiagonal));
  if (m.coarseOperators == CoarseKind::Spgemm) refuse("multigrid.coarse_operators", nameOf(m.coarseOperators));
}

void requireSound(const Checker& at, const OutputSettings& o) {
  const MethodKind method = at.wholeCase().method.kind;
  if (o.balance && method != MethodKind::MphI)
    at.fail({"balance"},
            fmt::format("only the method '{}' has one, found '{}'", nameOf(MethodKind::MphI), nameOf(method)));
}

/// The search needs three cells along a periodic axis: with fewer, a particle would meet a neighbour twice.
void requirePeriodicLength(const Checker& at, const Case& c) {
  constexpr int cells = 3;
  const double edge = c.searchEdge();
  const std::string_view edgeText = c.method.kind == MethodKind::Isph ? "2 h" : "max(h_v, h_n, 2 h_p)";
  for (int k = 0; k < c.dimensions; ++k) {
    const double length = c.domain.max[k] - c.domain.min[k];
    if (!c.domain.periodic[static_cast<std::size_t>(k)] || std::floor(length / edge) >= cells) continue;
    at.fail(
        {"domain", "periodic"},
        fmt::format("the domain is {} long along {}; a periodic axis must hold {} search cells of edge {} = {}: "
                    "expected at least {}",
                    lengthText(length), "xyz"[k], cells, edgeText, lengthText(edge), lengthText(cells * edge)));
  }
}

/// Positions need digits for parts of a spacing, and the keys that particles are sorted by have 63 bits, four for
/// each axis of a cell. How many cells there may be in all is a question of memory.
void requireDomainSize(const Checker& at, const Case& c) {
  const double farthest = 1e-6 / std::numeric_limits<double>::epsilon() * c.spacing;
  const double mostCells = c.dimensions == 2 ? 1 << 29 : 1 << 19;
  for (int k = 0; k < c.dimensions; ++k) {
    for (const auto& [key, x] : {std::pair("min", c.domain.min[k]), std::pair("max", c.domain.max[k])})
      if (!(std::abs(x) <= farthest))
        at.fail({"domain", key},
                fmt::format("found {} m along {}, expected at most {:.3g} m from 0: farther away positions are "
                            "rounded by more than a millionth of the spacing of {}",
                            x, "xyz"[k], farthest, lengthText(c.spacing)));
    if (const double cells = std::floor((c.domain.max[k] - c.domain.min[k]) / c.searchEdge()); cells > mostCells)
      at.fail(
          {"domain", "max"},
          fmt::format("the domain has {:.3g} search cells of edge {} along {}, expected at most {:.3g}: take a "
                      "smaller domain or a larger spacing",
                      cells, lengthText(c.searchEdge()), "xyz"[k], mostCells));
  }
}

/// On a lattice the nearest neighbours are one spacing away.
void requireSound(const Checker& at, const MethodSettings& m) {
  if (m.kind != MethodKind::MphI) return;
  for (const auto& [key, radius] :
       {std::pair("pressure_radius", m.pressureRadius), std::pair("viscosity_radius", m.viscosityRadius)})
    if (radius <= 1)
      at.fail({key},
              fmt::format("expected more than 1 spacing, found {}: particles would have no neighbours", radius));
}

/// Indices of the materials that some fluid is made of.
std::set<int> fluidMaterials(const Case& c) {
  std::set<int> found;
  for (const Body& body : c.bodies)
    if (body.holdsFluid()) found.insert(body.material);
  return found;
}

/// What holds a fluid together in MPH-I, and what the pressure equation of ISPH can do.
void requireMaterials(const Checker& at, const Case& c) {
  const Material* lightest = nullptr;
  const Material* heaviest = nullptr;
  for (int index : fluidMaterials(c)) {
    const Material& m = c.materials[static_cast<std::size_t>(index)];
    if (c.method.kind == MethodKind::MphI && m.bulkViscosity == 0 && m.bulkModulus == 0)
      at.fail(
          {"material", m.name, "bulk_viscosity"},
          "found 0, and bulk_modulus = 0: such a fluid has no pressure and falls through walls; expected one of "
          "them positive, and bulk_modulus <= " +
              mostBulkModulusText(c));
    if (!lightest || m.density < lightest->density) lightest = &m;
    if (!heaviest || m.density > heaviest->density) heaviest = &m;
  }
  constexpr double largestRatio = 10;  // 20 jumps, 30 explodes
  if (c.method.kind == MethodKind::Isph && heaviest && heaviest->density > largestRatio * lightest->density)
    at.fail({"material", heaviest->name, "density"},
            fmt::format(
                "found {:g} times that of '{}' = {:g} kg/m3: with ISPH the densities of fluids may differ by a "
                "factor of {:g} at most, beyond which the step is unstable where they meet",
                heaviest->density / lightest->density, lightest->name, lightest->density, largestRatio));
}

void requireSound(const Checker& at, const Case& c) {
  if (c.heat && c.method.kind != MethodKind::MphI) at.fail({"heat"}, heatOfMphI);
  if (std::ranges::none_of(c.bodies, &Body::holdsFluid))
    at.fail({"body"}, "no fluid: expected at least one [[body]] with type = \"fluid\" or \"inflow\"");
  requireMaterials(at, c);
  requireDomainSize(at, c);
  requirePeriodicLength(at, c);
  for (const auto& [key, interval] :
       {std::pair("interval", c.output.interval), std::pair("checkpoint_interval", c.output.checkpointInterval)})
    if (interval > 0 && c.time.end / interval > maxSteps)
      at.fail({"output", key}, fmt::format("{:.3g} intervals to the end are too many", c.time.end / interval));
}

}  // namespace

void requireValid(const Case& c) { Checker(c, {}).check(c); }

void requireValid(const Width& width, const Case& c) { Checker(c, {"width"}).check(width); }

}  // namespace treacle
