#include "case_checker.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <limits>
#include <set>

namespace treacle {
namespace {

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

/// Indices of the materials that some fluid is made of.
std::set<int> fluidMaterials(const Case& c) {
  std::set<int> found;
  for (const Body& body : c.bodies)
    if (body.holdsFluid()) found.insert(body.material);
  return found;
}

/// Fluid is compressed by its background pressure.
void requireBackground(const Checker& at, double pressure, const Material& m) {
  constexpr double most = 0.1;
  if (pressure > 0 && m.surfaceTension > 0)
    at.fail({"method", "background_pressure"},
            fmt::format("found beside the surface_tension of '{}'; a case can have only one of them", m.name));
  if (pressure > most * m.bulkModulus)
    at.fail({"method", "background_pressure"},
            fmt::format("expected at most {:g} times the bulk_modulus of '{}', {:g} Pa, found {:g}", most, m.name,
                        m.bulkModulus, pressure));
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
    if (c.method.kind == MethodKind::MphI) requireBackground(at, c.method.backgroundPressure, m);
    if (c.method.kind == MethodKind::Isph && c.method.isph.smagorinsky > 0 && m.dynamicViscosity == 0)
      at.fail({"material", m.name, "dynamic_viscosity"},
              "found 0 with smagorinsky in [method] above 0: the law of the wall needs a viscosity; expected a "
              "positive number, such as 1e-3 Pa s for water");
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

}  // namespace

void requireSound(const Checker& at, const Domain& d) { at.requireOrder(d.min, d.max); }

void requireSound(const Checker& at, const Width& w) {
  if (!(w.from < w.to)) at.fail({"to"}, fmt::format("expected more than from = {}, found {}", w.from, w.to));
}

void requireSound(const Checker& at, const Vent& v) { at.requireOrder(v.min, v.max); }

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

/// On a lattice the nearest neighbours are one spacing away.
void requireSound(const Checker& at, const MethodSettings& m) {
  if (m.kind != MethodKind::MphI) return;
  for (const auto& [key, radius] :
       {std::pair("pressure_radius", m.pressureRadius), std::pair("viscosity_radius", m.viscosityRadius)})
    if (radius <= 1)
      at.fail({key},
              fmt::format("expected more than 1 spacing, found {}: particles would have no neighbours", radius));
}

/// A surface is made of all particles of a frame.
void requireSurface(const Checker& at, const Case& c) {
  if (!c.output.surface) return;
  if (c.dimensions != 3)
    at.fail({"output", "surface"}, "found true in two dimensions; surfaces are those of three");
  if (c.output.pieces == OutputPieces::Each)
    at.fail(
        {"output", "surface"},
        "found true beside pieces = \"each\"; expected \"one\" or \"auto\", or `treacle surface` after the run");
}

/// Images across a periodic end would be at the same place of another frame.
void requireFrame(const Checker& at, const Case& c) {
  if (!c.frame) return;
  if (c.hasRigid()) at.fail({"frame"}, "found beside a rigid body; bodies in a frame that turns must be walls");
  const Vec<3> axis = c.frame->direction();
  for (int k = 0; k < c.dimensions; ++k)
    if (c.domain.periodic[static_cast<std::size_t>(k)] && std::abs(std::abs(axis[k]) - 1) > 1e-12)
      at.fail(
          {"domain", "periodic"},
          fmt::format("found a periodic axis {}; in a frame that turns only an axis along that of the frame may "
                      "be periodic",
                      "xyz"[k]));
}

/// Gas has not been tried with the published scheme of MPH-I.
void requireGas(const Checker& at, const Case& c) {
  if (!c.gas) return;
  if (c.method.kind == MethodKind::MphI && !c.isAccurate())
    at.fail({"gas"}, "expected method.scheme = \"accurate\" beside it");
  double cells = 1;
  for (int k = 0; k < c.dimensions; ++k) cells *= (c.domain.max[k] - c.domain.min[k]) / c.spacing;
  constexpr double most = 2e8;  // some 50 bytes each
  if (cells > most)
    at.fail({"gas"},
            fmt::format("the domain has {:.3g} cells of a spacing, in which gas is looked for, expected at "
                        "most {:.3g}: take a smaller domain",
                        cells, most));
}

/// Solvers that assemble the matrix take all particles in reach for neighbours.
void requireThinSheets(const Checker& at, const Case& c) {
  if (!c.hasThinSheets()) return;
  if (c.gas) at.fail({"gas"}, "found beside a thin sheet, which gas is not divided by; a case can have only one");
  if (c.method.kind != MethodKind::MphI) return;
  if (!c.isAccurate())
    at.fail({"method", "scheme"}, "found \"published\" beside a thin sheet; expected \"accurate\"");
  if (c.solver.operatorKind == OperatorKind::Assembled)
    at.fail({"solver", "operator"}, "found \"assembled\" beside a thin sheet; expected \"matrix-free\"");
  if (c.solver.preconditioner == PreconditionerKind::BucketMultigrid)
    at.fail({"solver", "preconditioner"}, "found \"bucket-multigrid\" beside a thin sheet; expected another one");
}

/// What assembles the matrix takes elements along walls, too (MphPairs::alongWall).
void requireSlip(const Checker& at, const Case& c) {
  if (c.hasSmoothWalls() && c.solver.operatorKind == OperatorKind::Assembled)
    at.fail({"solver", "operator"}, "found \"assembled\" beside a slip_length; expected \"matrix-free\"");
}

void requireSound(const Checker& at, const Case& c) {
  if (c.heat && c.method.kind != MethodKind::MphI) at.fail({"heat"}, heatOfMphI);
  if (std::ranges::none_of(c.bodies, &Body::holdsFluid))
    at.fail({"body"}, "no fluid: expected at least one [[body]] with type = \"fluid\" or \"inflow\"");
  at.requireFinite({"gravity", "acceleration"}, c.gravityInTime);
  requireMaterials(at, c);
  requireDomainSize(at, c);
  requirePeriodicLength(at, c);
  requireSurface(at, c);
  requireFrame(at, c);
  requireGas(at, c);
  requireThinSheets(at, c);
  requireSlip(at, c);
  for (const auto& [key, interval] :
       {std::pair("interval", c.output.interval), std::pair("checkpoint_interval", c.output.checkpointInterval)})
    if (interval > 0 && c.time.end / interval > maxSteps)
      at.fail({"output", key}, fmt::format("{:.3g} intervals to the end are too many", c.time.end / interval));
}

void requireValid(const Case& c) { Checker(c, {}).check(c); }

void requireValid(const Width& width, const Case& c) { Checker(c, {"width"}).check(width); }

void requireValidMaterialsAndInflows(const Case& c) {
  for (const Material& m : c.materials) Checker(c, {"material", m.name}).check(m);
  for (const Body& b : c.bodies)
    if (b.kind == BodyKind::Inflow) Checker(c, {"body", b.name}).check(b);
}

}  // namespace treacle
