#include "treacle/step/run/memory_plan.hpp"

#include "method/mph_solver.hpp"
#include "treacle/isph/isph_pairs.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/search/touching_cells.hpp"
#include "treacle/step/method/solve_stages.hpp"
#include "treacle/step/walls/near_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace treacle {
namespace {

template <int D>
CellGrid<D> gridOf(const Case& c) {
  return c.method.kind == MethodKind::Isph ? makeIsphPairs<D>(c).grid : makeMphPairs<D>(c).grid;
}

template <int D>
std::uint64_t fieldBytes(const ParticleNumbers& n) {
  std::uint64_t sum = 0;
  const auto add = [&](std::uint64_t count) {
    return [&sum, count]<class T>(const Buffer<T>&) { sum += count * sizeof(T); };
  };
  const Particles<D> none;
  forEachSharedFieldOf(add(n.fluid + n.ghosts + n.wall), none);
  forEachFluidFieldOf(add(n.fluid), none);
  add(n.has.starts ? n.fluid + n.ghosts + n.wall : 0)(none.start);
  add(n.has.sides ? n.fluid + n.wall : 0)(none.side);
  add(n.fluid * (n.has.shearRates + n.has.temperatures + n.has.viscosityFactors + n.has.states))(none.temperature);
  add(n.fluid * n.has.elasticModes)(none.conformation[0]);
  add(n.fluid * n.modes)(none.modes.vectors);
  forEachWallFieldOf(add(n.surfaces), none);
  return sum;
}

/// Modes that a solver may keep: in three dimensions it seldom finds any worth taking, and where there is no
/// memory for them it does without.
std::uint64_t modesOf(const Case& c) {
  const bool some = c.dimensions == 2 && c.method.kind == MethodKind::MphI && c.solver.deflates();
  return some ? static_cast<std::uint64_t>(c.solver.deflation) : 0;
}

/// Bytes where the CPU computes, and on a device.
struct Bytes {
  double host, device;

  double on(BackendKind backend) const { return backend == BackendKind::Cpu ? host : device; }
};

/// What a step of MPH-I takes for each fluid particle beside its state, as measured at dam breaks of 10^3 to
/// 4*10^6 fluid particles (docs/notes/performance.md#memory): with the projected multigrid, with that on buckets,
/// and with no coarse levels; more with the first in double precision; more with A as a matrix; less with
/// neighbours = "ranges".
struct MphBytes {
  Bytes projected, buckets, local, twice, matrix, ranges;
};
constexpr MphBytes accurate2{{2590, 960}, {1500, 730}, {1400, 560}, {230, 0}, {3600, 3250}, {0, 140}},
    accurate3{{8900, 1900}, {5000, 1310}, {4700, 1080}, {1250, -450}, {40000, 35000}, {0, 550}},
    published2{{1975, 655}, {1250, 610}, {1100, 430}, {360, 110}, {1490, 1500}, {0, 90}},
    published3{{6500, 1080}, {4100, 1220}, {3750, 950}, {1800, 0}, {14000, 13000}, {0, 300}};

/// What a step takes for each fluid particle, node of the finest background grid and wall particle next to fluid.
struct StepBytes {
  double fluid = 0, node = 0, wall = 0;
};

/// Per unknown of A by cuSPARSE's products of sparse matrices, whose memory only it knows.
double productBytes(const Case& c) { return c.dimensions == 2 ? 4300 : 27800; }

bool isDouble(const Case& c) { return solveStages(c).front().precision != Precision::Mixed; }

/// Whether fluids have an additional viscosity under their weight.
bool mayTakeLongSteps(const Case& c) {
  return std::ranges::any_of(
      c.materials, [&](const Material& m) { return additionalViscosity(c, m, pressureOfWeight(c, m)) > 0; });
}

/// For each neighbour within the radius of pressures beyond those of the default radius, as measured at floating
/// blocks and at spheres that settle.
constexpr Bytes perNearNeighbour{34, 10};

/// So many neighbours, of a particle in a full neighbourhood.
template <int D>
double neighboursBeyondDefault(const Case& c) {
  const auto within = [](double radius) {
    return D == 2 ? std::numbers::pi * radius * radius : 4 * std::numbers::pi / 3 * radius * radius * radius;
  };
  return within(c.method.pressureRadius) - within(defaultMethod(c.method.scheme).pressureRadius);
}

template <int D>
StepBytes mphBytes(const Case& c, BackendKind backend) {
  const SolverSettings& s = c.solver;
  const bool onDevice = backend == BackendKind::Cuda, accurate = c.isAccurate(),
             buckets = s.preconditioner == PreconditionerKind::BucketMultigrid,
             projected = s.preconditioner == PreconditionerKind::ProjectedMultigrid,
             products = onDevice && buckets && s.multigrid.coarseOperators == CoarseKind::Spgemm;
  const MphBytes& of = accurate ? (D == 2 ? accurate2 : accurate3) : (D == 2 ? published2 : published3);
  StepBytes bytes{(projected ? of.projected : buckets ? of.buckets : of.local).on(backend)};
  bytes.fluid += neighboursBeyondDefault<D>(c) * perNearNeighbour.on(backend);
  if (c.hasSurfaceTension()) bytes.fluid += D == 2 ? 200 : 350;
  if (c.hasOwnViscosities()) bytes.fluid += c.hasVolumeFactors() ? 78 : 70;
  if (mayTakeLongSteps(c)) bytes.fluid += 8 * (D * D + D * (D + 1) / 2 + D) + 25;  // StepStiffness
  if (c.heat) bytes.fluid += c.freezes() ? 228 : 180;
  if (modesOf(c) > 0) bytes.fluid += 128 * D;  // recorded vectors
  if (s.neighbours == NeighbourKind::Ranges) bytes.fluid -= of.ranges.on(backend);
  if (s.preconditioner == PreconditionerKind::None && onDevice) bytes.fluid -= 100 * (D - 1);
  // On the host a matrix may be there instead of the operator's coefficients.
  const bool instead = !onDevice && !projected && s.operatorKind == OperatorKind::Assembled;
  if (products || needsAssembled<Cpu>(s))
    bytes.fluid += (!instead ? 1 : D == 2 ? 0.6 : 0.75) * of.matrix.on(backend);
  if (products) bytes.fluid += D * productBytes(c);
  if (onDevice) bytes.wall = D == 2 ? 500 : accurate ? 1000 : 300;
  if (!projected) return bytes;
  if (isDouble(c)) bytes.fluid += of.twice.on(backend);
  if (accurate && isTooStiffToPack(makeMphPairs<D>(c))) bytes.fluid += onDevice ? 400 : D == 2 ? -250 : -1000;
  bytes.node = D == 2 ? 1100 : 5000;
  if (onDevice) bytes.node += (D == 2 ? 1360 : 20000) * (isDouble(c) ? 2 : 1);  // Galerkin products of half cells
  return bytes;
}

template <int D>
StepBytes isphBytes(const Case& c, BackendKind backend) {
  const bool onDevice = backend == BackendKind::Cuda;
  StepBytes bytes{D == 2 ? 430.0 : 740.0, 0, onDevice ? 150.0 : 0.0};
  if (c.solver.preconditioner == PreconditionerKind::HatMultigrid)
    bytes.node = D == 2 ? (onDevice ? 300 : 200) : (onDevice ? 900 : 500);
  if (c.solver.preconditioner == PreconditionerKind::CellMultigrid)
    bytes.fluid += (D == 2 ? 250 : 700) + (onDevice ? productBytes(c) / 4 : 0);
  if (isDouble(c)) bytes.fluid += D == 2 ? 100 : 260;
  if (c.method.scheme == SchemeKind::Accurate) {  // B and B', missing share, gradient, IsphArrangement
    bytes.fluid +=
        2 * sizeof(SymmetricBlock<D, float>) + sizeof(float) + sizeof(SmoothFlow<D>) + 24 + sizeof(Vec<D>);
    bytes.wall += sizeof(WallSurface<D>);
  }
  if (c.method.isph.smagorinsky > 0) bytes.fluid += 2 * sizeof(float);
  if (isViscousStepImplicit(c.method.isph.viscosity, explicitViscousLimit(makeIsphPairs<D>(c)), c.time.step))
    bytes.fluid += D == 2 ? 250 : 460;
  return bytes;
}

template <int D>
StepBytes stepBytes(const Case& c, BackendKind backend) {
  return c.method.kind == MethodKind::Isph ? isphBytes<D>(c, backend) : mphBytes<D>(c, backend);
}

template <int D>
MemoryCounts count(const Case& c, const Particles<D>& some, const Communicator* processes) {
  const CellGrid<D> cells = gridOf<D>(c);
  NearBlocks<D> near(c, cells);
  near.add(some);
  std::vector<std::uint8_t> filled(cells.cellCount());
  const auto cellOf = [&](const Vec<D>& x) { return cells.linear(cells.cellOf(x)); };
  for (const Vec<D>& x : some.position.span().first(some.fluidCount))
    if (isFinitePosition(x)) filled[cellOf(x)] = 1;  // of others the sort says so
  if (processes) near.unite(*processes), processes->anyOf(filled);
  std::vector<std::uint8_t> besideFluid(filled.size());
  for (std::size_t cell = 0; cell < filled.size(); ++cell)
    if (filled[cell])
      forEachAdjacentCell(cells, cells.cellAt(cell),
                          [&](const Vec<D, int>& at) { besideFluid[cells.linear(at)] = 1; });
  MemoryCounts n{.particles = some.numbers(), .cells = filled.size()};
  BodySet rigid;  // the particles do not know before the run
  for (std::size_t b = 0; b < c.bodies.size(); ++b)
    if (c.bodies[b].kind == BodyKind::Rigid) rigid.add(b);
  std::vector<std::uint32_t> bodies(rigid.isEmpty() ? 0 : filled.size());
  if (!rigid.isEmpty())
    addBodies<D>(cells, some.position.span().subspan(some.wallBegin()), some.body.span().subspan(some.wallBegin()),
                 rigid, bodies);
  n.filledCells = static_cast<std::uint64_t>(std::ranges::count(filled, 1));
  n.nodes = static_cast<std::uint64_t>(std::ranges::count(besideFluid, 1));
  for (std::uint32_t i = some.fluidCount; i < some.count; ++i) {
    n.nearWalls += !near.isFar(some, i);
    if (!isFinitePosition(some.position[i])) continue;
    const Vec<D, int> cell = cells.cellOf(some.position[i]);
    n.activeWalls +=
        besideFluid[cells.linear(cell)] || (!bodies.empty() && mayTouchAround(cells, bodies.data(), cell));
  }
  if (!processes) return n;
  std::array all{n.particles.fluid, n.particles.wall, n.particles.surfaces, n.nearWalls, n.activeWalls};
  processes->sum(std::span<std::uint64_t>(all));
  n.particles.fluid = all[0], n.particles.wall = all[1], n.particles.surfaces = all[2];
  n.nearWalls = all[3], n.activeWalls = all[4];
  return n;
}

}  // namespace

MemoryCounts MemoryCounts::share(const Case& c, std::uint64_t among) const {
  if (among <= 1) return *this;
  MemoryCounts one = *this;
  const auto shareOf = [&](std::uint64_t all) { return (all + among - 1) / among; };
  // A process has whole cells. Of the sides of a compact part 1 - P^(-1/D) are cuts, beside which there is a layer
  // of ghosts.
  const double all = std::max(1.0, static_cast<double>(filledCells)),
               own = std::ceil(all / static_cast<double>(among)),
               perCell = static_cast<double>(particles.fluid) / all, D = c.dimensions;
  const double layer = std::pow(std::pow(own, 1 / D) + 2, D) - own, cuts = 1 - std::pow(among, -1 / D);
  one.particles.fluid = static_cast<std::uint64_t>(own * perCell);
  one.particles.ghosts = static_cast<std::uint64_t>(std::min(cuts * layer, all - own) * perCell);
  one.particles.wall = nearWalls + shareOf(particles.wall - nearWalls);
  if (one.particles.surfaces > 0) one.particles.surfaces = one.particles.wall;
  one.activeWalls = shareOf(activeWalls);
  if (nodes > static_cast<std::uint64_t>(c.solver.dividedNodes)) one.nodes = shareOf(nodes);
  one.filledCells = static_cast<std::uint64_t>(own);
  return one;
}

std::uint64_t searchCells(const Case& c) {
  return c.dimensions == 2 ? gridOf<2>(c).cellCount() : gridOf<3>(c).cellCount();
}

MemoryCounts countForMemory(const Case& c, const AnyParticles& particles, const Communicator* processes) {
  return particles.visit([&]<int D>(const Particles<D>& some) { return count<D>(c, some, processes); });
}

std::uint64_t distantWallBytes(const Case& c, const MemoryCounts& n) {
  const std::uint64_t each = static_cast<std::uint64_t>(c.dimensions) * (n.particles.surfaces > 0 ? 16 : 8) + 6;
  return (n.particles.wall - n.nearWalls) * each;
}

std::uint64_t stateBytes(const Case& c, ParticleNumbers n) {
  n.modes = std::max(n.modes, modesOf(c));
  return c.dimensions == 2 ? fieldBytes<2>(n) : fieldBytes<3>(n);
}

std::uint64_t simulationBytes(const Case& c, const MemoryCounts& n, BackendKind backend) {
  constexpr double perCell = 26, perWall = 60, perGhost = 200;  // the last per dimension
  constexpr double ofDevice = 6 << 20;                          // coarsest levels, which are inverted
  ParticleNumbers state = n.particles;
  state.wall = n.nearWalls;
  if (state.surfaces > 0) state.surfaces = n.nearWalls;
  state.has = {c.hasOwnViscosities(), c.heat.has_value(), c.hasViscosityFactors(), c.middleShare() > 0};
  const StepBytes of = c.dimensions == 2 ? stepBytes<2>(c, backend) : stepBytes<3>(c, backend);
  const auto times = [](double bytes, std::uint64_t count) { return bytes * static_cast<double>(count); };
  const double step = times(of.fluid, n.particles.fluid) + times(of.node, n.nodes) +
                      times(of.wall, n.activeWalls) + times(perCell, n.cells) + times(perWall, n.nearWalls) +
                      times(perGhost * c.dimensions, n.particles.ghosts);
  return stateBytes(c, state) + static_cast<std::uint64_t>(step) +
         (backend == BackendKind::Cuda ? static_cast<std::uint64_t>(ofDevice) : distantWallBytes(c, n));
}

}  // namespace treacle
