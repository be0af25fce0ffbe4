#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/names.hpp"
#include "treacle/model/width.hpp"

#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace treacle {

/// What a number, or the number of entries of a list, may be.
struct Bound {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;             // without these two
  std::string_view reason = "";  // what speaks against others, for messages

  /// Not for what is not finite.
  bool holds(double x) const;
};

/// A key of a case file.
struct Key {
  std::string_view name;
  bool required = false;       // else there is a default, what the member is at first
  std::string_view unit = "";  // of its numbers
  Bound bound{};
};

/// What is expected of a key, e.g. "a positive number [s]", "a whole number of at least 1", "an array of 2 finite
/// numbers [m]".
std::string expectedNumber(const Key& key, bool orAuto = false, bool orExpression = false);
std::string expectedNumbers(const Key& key);
std::string expectedInteger(const Key& key);
std::string expectedVector(const Key& key, int dimensions, bool orExpressions = false);
std::string expectedEntries(const Key& key);

/// "expected a positive number [s], found 0".
std::string mismatch(const Key& key, const std::string& expected, const std::string& found);

/// The words of an enumeration for the values that fit.
template <class E, class Fits>
std::vector<std::string_view> wordsThat(Fits&& fits) {
  std::vector<std::string_view> words;
  for (const Named<E>& n : namesOf<E>)
    if (fits(n.value)) words.push_back(n.name);
  return words;
}

/// What is said of a material with both.
inline constexpr const char* viscosityBesideRheology =
    "the viscosity is that of the rheology; expected one of them";

/// What is said of a case of another method with heat.
inline constexpr const char* heatOfMphI = "only the method 'mph-i' has temperatures, found 'isph'";

/// The method of a case that says no more than its scheme.
MethodSettings defaultMethod(SchemeKind scheme);

/// The solver of a case that says no more than its method, or no more than that and the preconditioner.
SolverSettings defaultSolver(MethodKind method);
SolverSettings defaultSolver(MethodKind method, PreconditionerKind preconditioner);

/// Every key of a case file once, with the member of a case that it stands for. Who reads, writes, checks or lists
/// cases goes over the keys of a table by keys::visit(visitor, table, case), which calls in their order
/// - v(key, member) for numbers, words, flags, vectors, texts and the list of fields,
/// - v(key, member, fits) for a word where not all fit,
/// - v(key, text, keys::expression) for the text of an expression,
/// - v(key, vector, texts) for a vector that may have expressions in place of numbers, v(key, number, text)
/// likewise,
/// - v(key, index, keys::material) for a material, which a file calls by its name,
/// - v(key, number, flag, keys::orAuto) for a number that may be "auto", which the flag says,
/// - v(key, struct) for a table in the table,
/// - v(key, optional) for one that may be missing, as may an Oscillation, which then is Oscillation{},
/// - v(key, vector of structs) for tables with names; the bound is that of their number.
/// Which keys there are follows from dimensions and method of the case, from whether it has heat, from type and
/// shape of a body, from the model of a rheology or shift, and from whether time steps are automatic. Vectors have
/// as many components as the case has dimensions.
namespace keys {

inline constexpr bool required = true, optional = false;
inline constexpr Bound positive{.least = 0, .open = true}, notNegative{.least = 0};
// Beyond these a step or a solve would take as good as for ever.
inline constexpr Bound radius{.least = 0, .most = 20, .open = true}, iterations{1, 1e6}, sweeps{1, 1000},
    degree{0, 1000}, stepTolerance{1e-6, 0.5}, flowIndex{.least = 0, .most = 5, .open = true};
inline constexpr Bound regularisation{
    .least = 0, .open = true, .reason = "a yield stress without it would make a fluid at rest infinitely viscous"};
inline constexpr struct ExpressionTag {
} expression;
inline constexpr struct MaterialTag {
} material;
inline constexpr struct OrAutoTag {
} orAuto;
struct AllFit {
  constexpr bool operator()(auto) const { return true; }
};

/// A T to be read into, or one that stays as it is.
template <class M, class T>
concept Like = std::same_as<std::remove_const_t<M>, T>;

/// The table of which a case holds nothing but its vector.
template <class Vector>
struct Gravity {
  Vector& acceleration;
};
template <class Vector>
Gravity(Vector&) -> Gravity<Vector>;  // clang 14 does not find it by itself

/// Whether a method can do with it.
constexpr bool fits(PreconditionerKind preconditioner, MethodKind method) {
  switch (preconditioner) {
    case PreconditionerKind::None:
    case PreconditionerKind::Jacobi:
      return true;
    case PreconditionerKind::CellMultigrid:
    case PreconditionerKind::HatMultigrid:
      return method == MethodKind::Isph;
    case PreconditionerKind::BlockJacobi:
    case PreconditionerKind::BucketMultigrid:
    case PreconditionerKind::ProjectedMultigrid:
      break;
  }
  return method == MethodKind::MphI;
}

/// Pressures at the free surface come and go: nothing follows from those of several steps.
constexpr bool fits(FirstGuess guess, MethodKind method) {
  return method == MethodKind::MphI || guess == FirstGuess::Last;
}

void visit(auto& v, Like<Domain> auto& d, const Case&) {
  v({"min", required, "m"}, d.min);
  v({"max", required, "m"}, d.max);
  v({"periodic"}, d.periodic);
}

template <class Vector>
void visit(auto& v, const Gravity<Vector>& g, const Case&) {
  v({"acceleration", optional, "m/s2"}, g.acceleration);
}

void visit(auto& v, Like<Rheology> auto& r, const Case&) {
  using enum RheologyModel;
  v({"model", required}, r.model);
  if (r.yields()) {
    v({"yield_stress", required, "Pa", positive}, r.yieldStress);
    v({"regularisation", required, "s", regularisation}, r.regularisation);
  }
  if (r.model == Bingham || r.model == Casson)
    v({"plastic_viscosity", required, "Pa s", positive}, r.plasticViscosity);
  if (r.model == PowerLaw || r.model == HerschelBulkley)
    v({"consistency", required, "Pa s^n", positive}, r.consistency);
  if (r.model == Cross || r.model == CarreauYasuda) {
    v({"zero_viscosity", required, "Pa s", positive}, r.zeroViscosity);
    v({"infinite_viscosity", optional, "Pa s", notNegative}, r.infiniteViscosity);
    v({"time_constant", required, "s", positive}, r.timeConstant);
  }
  if (r.hasIndex()) v({"flow_index", required, "", flowIndex}, r.flowIndex);
  if (r.model == CarreauYasuda) v({"transition", optional, "", positive}, r.transition);
  v({"min_viscosity", optional, "Pa s", notNegative}, r.leastViscosity);
  v({"max_viscosity", optional, "Pa s", notNegative}, r.mostViscosity);
}

void visit(auto& v, Like<ViscosityShift> auto& s, const Case&) {
  v({"model", required}, s.model);
  if (s.model == ShiftModel::Table) {
    v({"temperatures", required, "K", positive}, s.temperatures);
    v({"factors", required, "", positive}, s.factors);
    return;
  }
  v({"reference_temperature", required, "K", positive}, s.reference);
  if (s.model == ShiftModel::Arrhenius) v({"activation_energy", required, "J/mol", positive}, s.activationEnergy);
  if (s.model == ShiftModel::Vft) {
    v({"b", required, "K", positive}, s.slope);
    v({"t0", required, "K", notNegative}, s.divergence);
  }
  if (s.model == ShiftModel::Wlf) {
    v({"c1", required, "", positive}, s.c1);
    v({"c2", required, "K", positive}, s.c2);
  }
  v({"min_factor", optional, "", positive}, s.least);
  v({"max_factor", optional, "", positive}, s.most);
}

void visit(auto& v, Like<Material> auto& m, const Case& c) {
  v({"name", required}, m.name);
  v({"density", required, "kg/m3", positive}, m.density);
  if (c.method.kind == MethodKind::MphI) v({"rheology"}, m.rheology);
  if (!m.rheology) v({"dynamic_viscosity", required, "Pa s", notNegative}, m.dynamicViscosity);
  if (c.method.kind != MethodKind::MphI) return;
  v({"bulk_viscosity", required, "Pa s", notNegative}, m.bulkViscosity);
  v({"bulk_modulus", required, "Pa", notNegative}, m.bulkModulus);
  v({"slip_length", optional, "m", notNegative}, m.slipLength);
  v({"surface_tension", optional, "N/m", notNegative}, m.surfaceTension);
  v({"contact_angle", optional, "deg", {0, 180}}, m.contactAngle);
  if (!c.heat) return;
  v({"specific_heat", required, "J/(kg K)", positive}, m.specificHeat);
  v({"conductivity", required, "W/(m K)", notNegative}, m.conductivity);
  v({"emissivity", optional, "", {0, 1}}, m.emissivity);
  v({"viscosity_shift"}, m.viscosityShift);
}

void visit(auto& v, Like<Oscillation> auto& o, const Case&) {
  v({"amplitude", required, "m"}, o.amplitude);
  v({"period", required, "s", positive}, o.period);
  v({"phase", optional, "rad"}, o.phase);
}

void visit(auto& v, Like<Rotation> auto& r, const Case& c) {
  v({"center", required, "m"}, r.center);
  v({"speed", required, "rad/s"}, r.speed);
  if (c.dimensions == 3) v({"axis", required, "any unit"}, r.axis);
}

/// The coordinates of a shape, which stand among the keys of its body.
void visit(auto& v, Like<Shape> auto& s, const Case&) {
  switch (s.kind) {
    case ShapeKind::Box:
      v({"min", required, "m"}, s.min);
      v({"max", required, "m"}, s.max);
      return;
    case ShapeKind::Sphere:
      v({"center", required, "m"}, s.center);
      break;
    case ShapeKind::Cylinder:
      v({"start", required, "m"}, s.start);
      v({"end", required, "m"}, s.end);
      break;
  }
  v({"radius", required, "m", positive}, s.radius);
  v({"inner_radius", optional, "m", notNegative}, s.innerRadius);
}

void visit(auto& v, Like<Body> auto& b, const Case& c) {
  v({"name", required}, b.name);
  v({"type", required}, b.kind);
  v({"material", required}, b.material, material);
  v({"shape", required}, b.shape.kind);
  v({"where"}, b.where, expression);
  v({"velocity", optional, "m/s"}, b.velocity, b.velocityExpression);
  v({"oscillation"}, b.oscillation);
  v({"rotation"}, b.rotation);
  if (c.heat) {
    const bool fluid = b.kind == BodyKind::Fluid;
    v({"temperature", fluid, "K", fluid ? positive : notNegative}, b.temperature, b.temperatureExpression);
    if (!fluid) v({"wall_conductance", optional, "W/(m2 K)", notNegative}, b.wallConductance);
  }
  visit(v, b.shape, c);
}

void visit(auto& v, Like<Width> auto& w, const Case& c) {
  v({"axis", required}, w.axis, [&](Coordinate axis) { return static_cast<int>(axis) < c.dimensions; });
  v({"from", required, "m"}, w.from);
  v({"to", required, "m"}, w.to);
  v({"factor", optional, "", positive}, w.factor);
}

void visit(auto& v, Like<TimeSettings> auto& t, const Case&) {
  v({"step", required, "s", positive}, t.step, t.automatic, orAuto);
  v({"end", required, "s", positive}, t.end);
  v({"courant", optional, "", notNegative}, t.courant);
  if (!t.automatic) return;
  v({"tolerance", optional, "", stepTolerance}, t.tolerance);
  v({"min_step", optional, "s", positive}, t.least);
  v({"max_step", optional, "s", positive}, t.step);
}

void visit(auto& v, Like<IsphSettings> auto& i, const Case&) {
  constexpr Bound smoothingRatio{
      .least = 0.9,
      .most = 2,
      .reason =
          "with less the sums have too few neighbours to be accurate, with more they smooth the flow away and "
          "take several times as long"};
  v({"kernel"}, i.kernel);
  v({"smoothing_ratio", optional, "spacings", smoothingRatio}, i.smoothingRatio);
  v({"alpha", optional, "", {0, 1}}, i.alpha);
  v({"walls"}, i.walls);
  v({"viscosity"}, i.viscosity);
  v({"shifting", optional, "", notNegative}, i.shifting);
  v({"negative_pressure"}, i.negativePressure);
}

void visit(auto& v, Like<MethodSettings> auto& m, const Case& c) {
  v({"name"}, m.kind);
  if (c.method.kind == MethodKind::Isph) return visit(v, m.isph, c);
  v({"scheme"}, m.scheme);
  v({"pressure_weight"}, m.pressureWeight);
  v({"viscosity_weight"}, m.viscosityWeight);
  v({"wall_velocity"}, m.wallVelocity);
  v({"pressure_gradient"}, m.pressureGradient);
  v({"pressure_radius", optional, "spacings", radius}, m.pressureRadius);
  v({"density_radius", optional, "spacings", {0, radius.most}}, m.densityRadius);
  v({"viscosity_radius", optional, "spacings", radius}, m.viscosityRadius);
  v({"viscosity_correction", optional, "", {0, 1}}, m.viscosityCorrection);
}

void visit(auto& v, Like<RheologySettings> auto& r, const Case&) {
  v({"iterations", optional, "", {1, 100}}, r.iterations);
  v({"tolerance", optional, "", {0, 1}}, r.tolerance);
}

void visit(auto& v, Like<HeatSettings> auto& h, const Case&) {
  v({"ambient_temperature", optional, "K", positive}, h.ambient);
  v({"heat_transfer", optional, "W/(m2 K)", notNegative}, h.transfer);
  v({"viscous_heating"}, h.viscousHeating);
  v({"tolerance", optional, "", {0, 1, true}}, h.tolerance);
  v({"max_iterations", optional, "", iterations}, h.maxIterations);
}

void visit(auto& v, Like<MultigridSettings> auto& m, const Case&) {
  v({"finest_sweeps", optional, "", sweeps}, m.finestSweeps);
  v({"middle_sweeps", optional, "", sweeps}, m.middleSweeps);
  v({"coarsest_sweeps", optional, "", sweeps}, m.coarsestSweeps);
  v({"particle_diagonal"}, m.particleDiagonal);
  v({"coarse_operators"}, m.coarseOperators);
}

void visit(auto& v, Like<ProjectedSettings> auto& p, const Case&) {
  v({"pressure_degree", optional, "", degree}, p.pressureDegree);
  v({"grid_degree", optional, "", degree}, p.gridDegree);
  v({"velocity_degree", optional, "", degree}, p.velocityDegree);
  v({"iteration_bound", optional, "", iterations}, p.iterationBound);
}

void visit(auto& v, Like<CellSettings> auto& s, const Case&) {
  v({"levels", optional, "", {0, 100}}, s.levels);
  v({"sweeps", optional, "", sweeps}, s.sweeps);
}

void visit(auto& v, Like<HatSettings> auto& h, const Case&) {
  v({"grid_degree", optional, "", degree}, h.gridDegree);
  v({"iteration_bound", optional, "", iterations}, h.iterationBound);
}

void visit(auto& v, Like<SolverSettings> auto& s, const Case& c) {
  const auto fitsMethod = [&](auto word) { return fits(word, c.method.kind); };
  v({"krylov"}, s.krylov);
  v({"preconditioner"}, s.preconditioner, fitsMethod);
  v({"tolerance", optional, "", {0, 1, true}}, s.tolerance);
  v({"max_iterations", optional, "", iterations}, s.maxIterations);
  v({"precision"}, s.precision);
  v({"first_guess"}, s.firstGuess, fitsMethod);
  v({"divided_nodes", optional, "", {0, 1e9}}, s.dividedNodes);
  if (c.method.kind == MethodKind::Isph) {
    v({"cells"}, s.cells);
    v({"hats"}, s.hats);
    return;
  }
  v({"operator"}, s.operatorKind);
  v({"neighbours"}, s.neighbours);
  v({"deflation", optional, "", {0, maxModes}}, s.deflation);
  v({"multigrid"}, s.multigrid);
  v({"projected"}, s.projected);
}

void visit(auto& v, Like<OutputSettings> auto& o, const Case& c) {
  OutputFormat format{};
  v({"interval", optional, "s", notNegative}, o.interval);
  v({"checkpoint_interval", optional, "s", notNegative}, o.checkpointInterval);
  v({"fields"}, o.fields);
  v({"format"}, format);
  v({"precision"}, o.precision);
  v({"pieces"}, o.pieces);
  if (c.method.kind == MethodKind::MphI) v({"balance"}, o.balance);
}

void visit(auto& v, Like<WatchSettings> auto& w, const Case&) {
  v({"energy", optional, "", notNegative}, w.energy);
  v({"courant", optional, "", notNegative}, w.courant);
  v({"inside_walls", optional, "", {0, 1}}, w.insideWalls);
  v({"density", optional, "", notNegative}, w.density);
}

void visit(auto& v, Like<Case> auto& c, const Case&) {
  const Gravity gravity{c.gravity};
  v({"title"}, c.title);
  v({"dimensions", required, "", {2, 3}}, c.dimensions);
  v({"spacing", required, "m", positive}, c.spacing);
  v({"resolution", optional, "", positive}, c.resolution);
  v({"domain", required}, c.domain);
  v({"gravity"}, gravity);
  v({"material", required, "", {1, maxMaterials}}, c.materials);
  v({"body", required, "", {1, maxBodies}}, c.bodies);
  v({"time", required}, c.time);
  v({"method"}, c.method);
  if (c.method.kind == MethodKind::MphI) {
    v({"rheology"}, c.rheology);
    v({"heat"}, c.heat);
  }
  v({"solver"}, c.solver);
  v({"output"}, c.output);
  v({"watch"}, c.watch);
}

/// The keys of a table: of which shape, by the shape of a body.
template <class Table>
std::vector<std::string_view> namesIn(const Table& table, const Case& c) {
  std::vector<std::string_view> names;
  const auto add = [&](const Key& key, auto&&...) { names.push_back(key.name); };
  visit(add, table, c);
  return names;
}

}  // namespace keys
}  // namespace treacle
