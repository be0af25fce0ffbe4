#pragma once

#include "treacle/model/case/body_keys.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/case/key.hpp"
#include "treacle/model/case/material_keys.hpp"
#include "treacle/model/case/probe_keys.hpp"
#include "treacle/model/case/settings_keys.hpp"
#include "treacle/model/case/width.hpp"

#include <string_view>
#include <vector>

namespace treacle {

/// What is said of a material with both.
inline constexpr const char* viscosityBesideRheology =
    "the viscosity is that of the rheology; expected one of them";

/// What is said of a case of another method with heat, and of one with a rheology.
inline constexpr const char* heatOfMphI = "only the method 'mph-i' has temperatures, found 'isph'";
inline constexpr const char* rheologyOfMphI =
    "only the method 'mph-i' has fluids that are not Newtonian, found 'isph'";

/// The method of a case that says no more than its scheme.
MethodSettings defaultMethod(SchemeKind scheme);
/// h_p / l of the accurate scheme where a case has rigid bodies and does not give it: the pressure around a body
/// would hold it back with the shorter one (docs/rigid-bodies.md).
inline constexpr double radiusAroundBodies = 3.5;

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

/// What a case file has at its top beside the keys of a case, which know nothing of it once it is read.
inline constexpr Key baseKey{"base", "Case file, relative to this one, that this one changes"};
inline constexpr Key widthKey{"width", "A stretch of one axis becomes wider or narrower"};

/// The table of which a case holds nothing but its vector, and the components of it that vary.
template <class Vector, class Functions>
struct Gravity {
  Vector& acceleration;
  Functions& inTime;
};
template <class Vector, class Functions>
Gravity(Vector&, Functions&) -> Gravity<Vector, Functions>;  // clang 14 does not find it by itself

void visit(auto& v, Like<Domain> auto& d, const Case&) {
  v({"min", "Corner of the domain with the least coordinates", required, "m"}, d.min);
  v({"max", "Corner of the domain with the largest coordinates; every particle must start inside", required, "m"},
    d.max);
  v({"periodic",
     "Whether what leaves on one side comes in on the other; a particle that leaves an open side ends the run"},
    d.periodic);
}

template <class Vector, class Functions>
void visit(auto& v, const Gravity<Vector, Functions>& g, const Case&) {
  v({"acceleration", "Gravity", optional, "m/s2"}, g.acceleration, g.inTime);
}

void visit(auto& v, Like<Width> auto& w, const Case& c) {
  v({"axis", "Axis that is scaled", required}, w.axis,
    [&](Coordinate axis) { return static_cast<int>(axis) < c.dimensions; });
  v({"from", "Where the stretch that is scaled begins", required, "m"}, w.from);
  v({"to", "Where it ends; what is beyond moves along", required, "m"}, w.to);
  v({"factor", "What the stretch is scaled by", optional, "", positive}, w.factor);
}

void visit(auto& v, Like<TimeSettings> auto& t, const Case&) {
  v({"step", "Time step at resolution 1, with courant the longest one; auto: as long as errors allow, with MPH-I",
     required, "s", positive},
    t.step, t.automatic, orAuto);
  v({"end", "End of the run", required, "s", positive}, t.end);
  v({"courant",
     "Courant number: in a step the fastest particle goes at most so many spacings; 0 or 1e-6 to 100, 0 being no "
     "bound, with automatic steps 1",
     optional, "", notNegative},
    t.courant);
  if (!t.automatic) return;
  v({"tolerance", "Largest error of an automatic step, as a part of the way that the fluid goes in it", optional,
     "", stepTolerance},
    t.tolerance);
  v({"min_step", "Shortest automatic step; by default a 10,000th of max_step", optional, "s", positive}, t.least);
  v({"max_step", "Longest automatic step; by default the longest that is known to be stable, at most end",
     optional, "s", positive},
    t.step);
}

void visit(auto& v, Like<Case> auto& c, const Case&) {
  const Gravity gravity{c.gravity, c.gravityInTime};
  v({"title", "Title in pictures and summary"}, c.title);
  v({"dimensions", "Number of dimensions, and of components of all vectors of the file", required, "", {2, 3}},
    c.dimensions);
  v({"spacing", "Distance between particles at the start, at resolution 1", required, "m", positive}, c.spacing);
  v({"resolution", "What spacing and time.step, unless that is auto, are divided by", optional, "", positive},
    c.resolution);
  v({"domain", "Where particles may be", required}, c.domain);
  v({"gravity", "Gravity"}, gravity);
  v({"frame", "Rotation of the frame that places and velocities are in; gravity is that outside, at the start"},
    c.frame);
  v({"material", "Materials, of fluids and walls", required, "", {1, maxMaterials}}, c.materials);
  v({"body", "What particles are made of", required, "", {1, maxBodies}}, c.bodies);
  v({"outflow", "Where fluid leaves", optional, "", {0, maxOutflows}}, c.outflows);
  v({"opening", "Where fluid goes in or out by a pressure", optional, "", {0, maxOpenings}}, c.openings);
  v({"time", "Time step and end of the run", required}, c.time);
  v({"method", "Numerical method and its settings"}, c.method);
  if (c.method.kind == MethodKind::MphI) {
    v({"rheology", "How viscosity and flow are brought together where a material has a rheology"}, c.rheology);
    v({"heat", "The case has temperatures; may be empty"}, c.heat);
  }
  v({"gas", "The fluid may trap gas, which has a pressure; may be empty"}, c.gas);
  v({"solver", "How the linear system of a step is solved"}, c.solver);
  v({"output", "What is written"}, c.output);
  v({"probe", "What is measured while the case runs", optional, "", {0, maxProbes}}, c.probes);
  v({"watch", "Bounds beyond which a run ends because it no longer means anything"}, c.watch);
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
