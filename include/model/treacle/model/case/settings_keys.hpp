#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/key.hpp"

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
  v({"kernel", "Kernel; both reach 2 h"}, i.kernel);
  v({"smoothing_ratio", "Smoothing length h", optional, "spacings", smoothingRatio}, i.smoothingRatio);
  v({"alpha", "Share of the density error that a step corrects", optional, "", {0, 1}}, i.alpha);
  v({"walls", "Whether fluid sticks to walls or slides along them"}, i.walls);
  v({"viscosity", "How the viscous step is made; auto: implicit where the explicit step would be unstable"},
    i.viscosity);
  v({"smagorinsky",
     "Constant C of the turbulence model of Smagorinsky, with the law of the wall; 0: laminar",
     optional,
     "",
     {0, 0.3}},
    i.smagorinsky);
  v({"shifting", "Coefficient of particle shifting, which keeps particles evenly spread; 0: off", optional, "",
     notNegative},
    i.shifting);
  v({"negative_pressure", "Whether negative pressures stay, so that fluid can pull; else they are cut to zero"},
    i.negativePressure);
}

void visit(auto& v, Like<MethodSettings> auto& m, const Case& c) {
  v({"name", "Moving particle hydrodynamics for highly viscous flow, or incompressible SPH by projection"},
    m.kind);
  v({"scheme",
     "Formulas that converge, or those of the papers [K23], [O23]; for MPH-I it sets defaults of the radii"},
    m.scheme);
  if (c.method.kind == MethodKind::Isph) return visit(v, m.isph, c);
  v({"pressure_radius",
     "Radius h_p of divergence and pressure gradient; 3.5 with rigid bodies in the accurate scheme", optional,
     "spacings", radius},
    m.pressureRadius);
  v({"density_radius",
     "Radius h_n of the number density; where it is less than pressure_radius it is that",
     optional,
     "spacings",
     {0, radius.most}},
    m.densityRadius);
  v({"viscosity_radius", "Radius h_v of the shear viscosity", optional, "spacings", radius}, m.viscosityRadius);
  v({"viscosity_correction",
     "Share of the viscosity of missing neighbours, at a free surface, that a particle gets from those it has",
     optional,
     "",
     {0, 1}},
    m.viscosityCorrection);
  v({"tension_limit",
     "The fluid bears tensions up to this one where it has no free surface, and parts beyond; 0: it bears any; of "
     "the accurate scheme",
     optional, "Pa", notNegative},
    m.tensionLimit);
  v({"background_pressure",
     "Pressure of fluid that is neither compressed nor stretched, for vessels that fluid fills", optional, "Pa",
     notNegative},
    m.backgroundPressure);
}

void visit(auto& v, Like<RheologySettings> auto& r, const Case&) {
  v({"iterations", "Largest number of solves in a step", optional, "", {1, 100}}, r.iterations);
  v({"tolerance",
     "Mean relative change of the viscosity, weighted with the dissipation, that no further solve follows",
     optional,
     "",
     {0, 1}},
    r.tolerance);
}

void visit(auto& v, Like<HeatSettings> auto& h, const Case&) {
  v({"ambient_temperature", "Temperature of what is around the fluid", optional, "K", positive}, h.ambient);
  v({"heat_transfer", "Heat transfer coefficient of free surfaces, by convection", optional, "W/(m2 K)",
     notNegative},
    h.transfer);
  v({"viscous_heating", "Whether what the viscosity takes from the motion heats the fluid"}, h.viscousHeating);
  v({"tolerance", "Bound on |r|^2/|b|^2 of the solve for temperatures", optional, "", {0, 1, true}}, h.tolerance);
  v({"max_iterations", "Largest number of iterations of that solve", optional, "", iterations}, h.maxIterations);
}

void visit(auto& v, Like<Vent> auto& vent, const Case&) {
  v({"name", "Name of the vent, unique among them", required}, vent.name);
  v({"min", "Corner of a box with the least coordinates", required, "m"}, vent.min);
  v({"max", "Corner of the box with the largest coordinates", required, "m"}, vent.max);
}

void visit(auto& v, Like<GasSettings> auto& g, const Case&) {
  v({"pressure", "Pressure of the air around the fluid, absolute", optional, "Pa", positive}, g.pressure);
  v({"exponent", "Exponent k of p V^k = const in a pocket: 1 at one temperature, 1.4 without exchange of heat",
     optional, "", positive},
    g.exponent);
  v({"vents", "Boxes through which trapped gas gets out", optional, "", {0, maxVents}}, g.vents);
}

void visit(auto& v, Like<MultigridSettings> auto& m, const Case&) {
  v({"finest_sweeps", "Smoothing sweeps before and after the coarse correction on the finest buckets", optional,
     "", sweeps},
    m.finestSweeps);
  v({"middle_sweeps", "The same on the levels between", optional, "", sweeps}, m.middleSweeps);
  v({"coarsest_sweeps", "Sweeps on the coarsest level", optional, "", sweeps}, m.coarsestSweeps);
  v({"particle_diagonal",
     "Diagonal on the particles: that of the matrix, or half the sum of absolute values of a row"},
    m.particleDiagonal);
  v({"coarse_operators",
     "On a GPU: coarse operators from sums of pair terms, or as products of sparse matrices; auto is direct"},
    m.coarseOperators);
}

void visit(auto& v, Like<ProjectedSettings> auto& p, const Case&) {
  v({"pressure_degree", "Degree of the smoother of the pressures on the particles; 0: chosen by the program",
     optional, "", degree},
    p.pressureDegree);
  v({"grid_degree", "Degree of the smoother of the pressures on the background grids; 0: chosen by the program",
     optional, "", degree},
    p.gridDegree);
  v({"velocity_degree", "Degree of the smoother of the velocities on the particles; 0: chosen by the program",
     optional, "", degree},
    p.velocityDegree);
  v({"iteration_bound", "A solve that needs more iterations, or breaks down, goes on in another way", optional, "",
     iterations},
    p.iterationBound);
}

void visit(auto& v, Like<CellSettings> auto& s, const Case&) {
  v({"levels", "Number of coarse levels; 0: down to the coarsest cells", optional, "", {0, 100}}, s.levels);
  v({"sweeps", "Smoothing sweeps before and after each coarse correction", optional, "", sweeps}, s.sweeps);
}

void visit(auto& v, Like<HatSettings> auto& h, const Case&) {
  v({"grid_degree", "Degree of the smoothers on the background grids; 0: chosen by the program", optional, "",
     degree},
    h.gridDegree);
  v({"iteration_bound", "A solve that needs more iterations, or breaks down, goes on in another way", optional, "",
     iterations},
    h.iterationBound);
}

void visit(auto& v, Like<SolverSettings> auto& s, const Case& c) {
  const auto fitsMethod = [&](auto word) { return fits(word, c.method.kind); };
  v({"krylov", "Conjugate gradients or conjugate residuals"}, s.krylov);
  v({"preconditioner", "Preconditioner of the linear system"}, s.preconditioner, fitsMethod);
  v({"tolerance", "Bound on |r|^2/|b|^2 at which a solve ends", optional, "", {0, 1, true}}, s.tolerance);
  v({"max_iterations", "A solve that needs more ends the run", optional, "", iterations}, s.maxIterations);
  v({"precision", "Whether the preconditioner works in single precision where that is enough"}, s.precision);
  v({"first_guess", "Where a solve starts: at the last values, or at those of two or three steps extrapolated"},
    s.firstGuess, fitsMethod);
  v({"divided_nodes",
     "Grids with more nodes than that are divided between the processes that share a case",
     optional,
     "",
     {0, 1e9}},
    s.dividedNodes);
  if (c.method.kind == MethodKind::Isph) {
    v({"cells", "Settings of cell-multigrid"}, s.cells);
    v({"hats", "Settings of hat-multigrid"}, s.hats);
    return;
  }
  v({"operator", "Products from sums over neighbours, or by the stored matrix"}, s.operatorKind);
  v({"neighbours",
     "On a GPU: neighbours from lists, or from ranges of cells, which take less memory and more time"},
    s.neighbours);
  v({"deflation",
     "Largest number of modes that conjugate gradients with projected-multigrid are deflated by; 0: off",
     optional,
     "",
     {0, maxModes}},
    s.deflation);
  v({"multigrid", "Settings of bucket-multigrid"}, s.multigrid);
  v({"projected", "Settings of projected-multigrid"}, s.projected);
}

void visit(auto& v, Like<OutputSettings> auto& o, const Case& c) {
  OutputFormat format{};
  v({"interval", "Simulation time between frames; 0: first and last state only", optional, "s", notNegative},
    o.interval);
  v({"checkpoint_interval", "Simulation time between checkpoints; 0: only when the run ends", optional, "s",
     notNegative},
    o.checkpointInterval);
  v({"fields",
     "Fields in the frames; dynamic_viscosity, shear_rate, temperature and viscosity_factor are there where the "
     "case has them"},
    o.fields);
  v({"format", "Format of the frames: VTK XML PolyData"}, format);
  v({"precision", "Precision of positions and fields in the frames"}, o.precision);
  v({"compression", "Compression of the arrays in the frames, without loss"}, o.compression);
  v({"pieces",
     "Of a run that several processes share: one file per frame, or a piece by each process; auto: pieces from 2 "
     "million particles on"},
    o.pieces);
  v({"surface", "Whether the surface of the fluid is written beside each frame as triangles, in three dimensions"},
    o.surface);
  if (c.method.kind == MethodKind::MphI)
    v({"balance", "Whether the energy balance and the forces on walls of every step are written"}, o.balance);
}

void visit(auto& v, Like<WatchSettings> auto& w, const Case&) {
  v({"energy",
     "Rise of kinetic and potential energy over what start and gravity have given, beyond which the run ends; 0: "
     "not looked at",
     optional, "", notNegative},
    w.energy);
  v({"courant", "Way of the fastest particle in a step, in spacings, beyond which the run ends; 0: not looked at",
     optional, "", notNegative},
    w.courant);
  v({"inside_walls",
     "Share of fluid particles inside walls beyond which the run ends; 0: not looked at",
     optional,
     "",
     {0, 1}},
    w.insideWalls);
  v({"density", "Mean excess of the density beyond which the run ends; 0: not looked at", optional, "",
     notNegative},
    w.density);
}

}  // namespace treacle::keys
