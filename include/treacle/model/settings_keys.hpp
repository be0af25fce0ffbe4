#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/key.hpp"

namespace treacle::keys {

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
  v({"compression"}, o.compression);
  v({"pieces"}, o.pieces);
  v({"surface"}, o.surface);
  if (c.method.kind == MethodKind::MphI) v({"balance"}, o.balance);
}

void visit(auto& v, Like<WatchSettings> auto& w, const Case&) {
  v({"energy", optional, "", notNegative}, w.energy);
  v({"courant", optional, "", notNegative}, w.courant);
  v({"inside_walls", optional, "", {0, 1}}, w.insideWalls);
  v({"density", optional, "", notNegative}, w.density);
}

}  // namespace treacle::keys
