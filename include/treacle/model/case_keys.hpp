#pragma once

#include "treacle/model/body_keys.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/key.hpp"
#include "treacle/model/material_keys.hpp"
#include "treacle/model/probe_keys.hpp"
#include "treacle/model/settings_keys.hpp"
#include "treacle/model/width.hpp"

#include <string_view>
#include <vector>

namespace treacle {

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
/// - v(key, path, keys::file) for a file, which a case file names relative to itself,
/// - v(key, points) for a list of points of the plane,
/// - v(key, number, flag, keys::orAuto) for a number that may be "auto", which the flag says,
/// - v(key, function) for a TimeFunction, which is a number, an expression or a table, and may be missing,
/// - v(key, struct) for a table in the table,
/// - v(key, optional) for one that may be missing, as may an Oscillation, which then is Oscillation{},
/// - v(key, vector of structs) for tables with names; the bound is that of their number.
/// Which keys there are follows from dimensions and method of the case, from whether it has heat, from type and
/// shape of a body, from the type of a probe, from the model of a rheology or shift, and from whether time steps
/// are automatic. Vectors have as many components as the case has dimensions.
namespace keys {

/// The table of which a case holds nothing but its vector.
template <class Vector>
struct Gravity {
  Vector& acceleration;
};
template <class Vector>
Gravity(Vector&) -> Gravity<Vector>;  // clang 14 does not find it by itself

void visit(auto& v, Like<Domain> auto& d, const Case&) {
  v({"min", required, "m"}, d.min);
  v({"max", required, "m"}, d.max);
  v({"periodic"}, d.periodic);
}

template <class Vector>
void visit(auto& v, const Gravity<Vector>& g, const Case&) {
  v({"acceleration", optional, "m/s2"}, g.acceleration);
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
  v({"outflow", optional, "", {0, maxOutflows}}, c.outflows);
  v({"time", required}, c.time);
  v({"method"}, c.method);
  if (c.method.kind == MethodKind::MphI) {
    v({"rheology"}, c.rheology);
    v({"heat"}, c.heat);
  }
  v({"solver"}, c.solver);
  v({"output"}, c.output);
  v({"probe", optional, "", {0, maxProbes}}, c.probes);
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
