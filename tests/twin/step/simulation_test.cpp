#include "treacle/step/run/simulation.hpp"
#include "support/deep_layer.hpp"
#include "support/equal_blocks.hpp"
#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/layer_with_gap.hpp"
#include "support/ring_in_drum.hpp"
#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "support/stretched_body.hpp"
#include "support/torn_cluster.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace treacle::test {
namespace {

/// A jittered body of fluid on a floor that moves.
template <int D>
Particles<D> bodyOnFloor(const Case& c, double floorSpeed) {
  const double l = c.spacing;
  Particles<D> p = jitteredLattice<D>(
      c, 0.1, 1, [&](const Vec<D>& x) { return x[D - 1] >= 4 * l && x[D - 1] < 9 * l && x[0] < 8 * l; },
      [&](const Vec<D>& x) { return x[D - 1] < 4 * l; });
  for (std::uint32_t i = 0; i < p.count; ++i) p.velocity[i] = {};
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i) p.velocity[i][0] = floorSpeed;
  return p;
}

Case stepCase(int dimensions, const SolverSettings& solver, SchemeKind scheme = SchemeKind::Published) {
  Case c = sceneCase(dimensions, true, scheme);
  c.time.step = 5e-4;
  c.gravity[dimensions - 1] = -10;
  c.solver = solver;
  return c;
}

std::vector<SolverSettings> allSolvers() {
  std::vector<SolverSettings> all;
  for (const auto k : {PreconditionerKind::None, PreconditionerKind::Jacobi, PreconditionerKind::BlockJacobi,
                       PreconditionerKind::BucketMultigrid, PreconditionerKind::ProjectedMultigrid})
    for (const auto krylov : {KrylovKind::Cg, KrylovKind::Cr}) {
      SolverSettings s;
      s.preconditioner = k;
      s.krylov = krylov;
      s.precision = Precision::Double;
      all.push_back(s);
      s.precision = Precision::Mixed;
      all.push_back(s);
    }
  SolverSettings papers;
  papers.preconditioner = PreconditionerKind::BucketMultigrid;
  papers.krylov = KrylovKind::Cr;
  papers.precision = Precision::Double;
  SolverSettings s = papers;
  s.operatorKind = OperatorKind::Assembled;
  all.push_back(s);
  s.multigrid.coarseOperators = CoarseKind::Spgemm;
  all.push_back(s);
  s.multigrid.particleDiagonal = SmootherDiagonal::ExtendedJacobi;
  all.push_back(s);
  s = papers;
  s.neighbours = NeighbourKind::Ranges;
  all.push_back(s);
  return all;
}

template <int D>
double farthest(const Particles<D>& a, const Particles<D>& b) {
  std::vector<Vec<D>> x(a.count);
  for (std::uint32_t i = 0; i < a.count; ++i) x[a.id[i]] = a.position[i];
  double distance = 0;
  for (std::uint32_t i = 0; i < b.count; ++i) distance = std::max(distance, norm(b.position[i] - x[b.id[i]]));
  return distance;
}

/// Distance of positions in spacings, and relative difference of energies, after some steps: what solves to
/// residuals of `tightTolerance` leave.
constexpr double agreement = 1e-8, tightTolerance = 1e-22;

template <int D>
void compareSteps(const SolverSettings& settings, SchemeKind scheme) {
  // Residuals of CG go up and down; in single precision the CPU's own variants (matrix-free, assembled) differ by
  // 9 %. CR in double precision, this near to the limit of rounding, took 149 for 154.
  const bool rough = settings.krylov == KrylovKind::Cg || settings.precision == Precision::Mixed;
  const double spread = rough ? 0.15 : 0.05;
  Case c = stepCase(D, settings, scheme);
  c.solver.tolerance = tightTolerance;
  Simulation<D> cpu(c, bodyOnFloor<D>(c, 0.02));
  Simulation<D, Cuda> cuda(c, bodyOnFloor<D>(c, 0.02));
  // Solves of many iterations take the CPU minutes.
  const int steps = settings.preconditioner == PreconditionerKind::ProjectedMultigrid ? 5 : 2;
  for (int step = 0; step < steps; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_NEAR(b.iterations, a.iterations, std::max(1.0, spread * a.iterations));
    EXPECT_LE(b.residual, c.solver.tolerance);
    EXPECT_NEAR(b.diagnostics.kineticEnergy, a.diagnostics.kineticEnergy, agreement * a.diagnostics.kineticEnergy);
    EXPECT_NEAR(b.diagnostics.frontX, a.diagnostics.frontX, agreement * c.spacing);
  }
  Particles<D> found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(stateOf(cpu), found), agreement * c.spacing);
}

TEST(SimulationTwin, StepsLikeTheCpuWithEverySolver) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SolverSettings& s : allSolvers()) {
    SCOPED_TRACE(testing::Message() << "preconditioner " << static_cast<int>(s.preconditioner) << ", krylov "
                                    << static_cast<int>(s.krylov) << ", precision "
                                    << static_cast<int>(s.precision) << ", operator "
                                    << static_cast<int>(s.operatorKind) << ", coarse "
                                    << static_cast<int>(s.multigrid.coarseOperators) << ", neighbours "
                                    << static_cast<int>(s.neighbours));
    for (const SchemeKind scheme : bothSchemes) {
      SCOPED_TRACE(nameOf(scheme));
      compareSteps<2>(s, scheme);
      compareSteps<3>(s, scheme);
    }
  }
}

/// A ring of fluid that falls in its drum: fluid under tension, which is shifted.
TEST(SimulationTwin, BearsTensionLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = ringInDrum();
  c.gravity = {0, -9.81, 0};
  c.solver.tolerance = tightTolerance;
  c.solver.precision = Precision::Double;
  Simulation<2> cpu(c, created<2>(c));
  Simulation<2, Cuda> cuda(c, created<2>(c));
  for (int step = 0; step < 20; ++step) cpu.advance(), cuda.advance();
  Particles<2> found;
  cuda.copyParticles(found);
  const double least = *std::min_element(found.heldPressure.begin(), found.heldPressure.end());
  EXPECT_LT(least, -1) << "none bears tension";
  EXPECT_LE(farthest(stateOf(cpu), found), 1e-6 * c.spacing);
}

/// Steps in which the weight of the fluid moves its particles by more than a spacing.
template <int D>
void compareLongSteps(Case c, Precision precision) {
  c.solver.tolerance = tightTolerance;
  c.solver.precision = precision;
  c.output.balance = true;
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int step = 0; step < 8; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_NEAR(b.diagnostics.kineticEnergy, a.diagnostics.kineticEnergy, 1e-6 * a.diagnostics.kineticEnergy);
    ASSERT_EQ(b.balance->walls.size(), a.balance->walls.size());
    for (std::size_t k = 0; k < a.balance->walls.size(); ++k)
      EXPECT_LE(norm(b.balance->walls[k].force - a.balance->walls[k].force),
                1e-6 * norm(a.balance->walls[k].force));
  }
  EXPECT_LE(farthest(stateOf(cpu), stateOf(cuda)), agreement * c.spacing);
}

TEST(SimulationTwin, TakesLongStepsUnderPressureLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const Precision precision : {Precision::Mixed, Precision::Double}) {
    compareLongSteps<2>(deepLayer(2), precision);
    compareLongSteps<3>(deepLayer(3), precision);
    compareLongSteps<2>(layerOnAir(2), precision);
    compareLongSteps<2>(fullVessel(2), precision);
    Case c = deepLayer(2);
    c.materials[0].rheology = {
        .model = RheologyModel::Cross, .flowIndex = 0.5, .zeroViscosity = 1, .timeConstant = 0.1};
    compareLongSteps<2>(c, precision);
    c.materials[0].elastic = {
        {.name = "a", .model = ElasticModel::OldroydB, .viscosity = 1, .relaxationTime = 0.05}};
    compareLongSteps<2>(c, precision);
  }
}

/// Until the gap is closed and after.
void compareGaps(bool onTheFloor) {
  Case c = layerWithGap(onTheFloor);
  c.solver.tolerance = tightTolerance;
  c.solver.precision = Precision::Double;
  Simulation<2> cpu(c, created<2>(c));
  Simulation<2, Cuda> cuda(c, created<2>(c));
  for (int step = 0; step < 20; ++step) cpu.advance(), cuda.advance();
  EXPECT_LE(farthest(stateOf(cpu), stateOf(cuda)), 1e-6 * c.spacing);
}

TEST(SimulationTwin, ClosesGapsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool onTheFloor : {false, true}) compareGaps(onTheFloor);
}

/// A Bingham fluid alone, and one beside another fluid.
template <int D>
void compareRheology(int materials, Precision precision) {
  SolverSettings settings;
  settings.precision = precision;
  Case c = stepCase(D, settings, SchemeKind::Accurate);
  c.solver.tolerance = tightTolerance;
  c.rheology = {3, 0};  // always as many solves
  c.materials[0].dynamicViscosity = 0;
  c.materials[0].rheology =
      Rheology{.model = RheologyModel::Bingham, .yieldStress = 5, .plasticViscosity = 5, .regularisation = 10};
  c.materials.resize(static_cast<std::size_t>(materials));
  const auto start = [&] {
    Particles<D> p = bodyOnFloor<D>(c, 0.02);
    for (auto& m : p.material) m = std::min<std::uint8_t>(m, static_cast<std::uint8_t>(materials - 1));
    return p;
  };
  Simulation<D> cpu(c, start());
  Simulation<D, Cuda> cuda(c, start());
  for (int step = 0; step < 5; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_NEAR(b.diagnostics.kineticEnergy, a.diagnostics.kineticEnergy, agreement * a.diagnostics.kineticEnergy);
  }
  Particles<D> expected = stateOf(cpu), found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(expected, found), agreement * c.spacing);
  std::vector<double> rate(expected.fluidCount);
  for (std::uint32_t i = 0; i < expected.fluidCount; ++i) rate[expected.id[i]] = expected.shearRate[i];
  const double most = *std::max_element(rate.begin(), rate.end());
  ASSERT_TRUE(found.has.shearRates);
  for (std::uint32_t i = 0; i < found.fluidCount; ++i)
    ASSERT_NEAR(found.shearRate[i], rate[found.id[i]], 1e-6 * most);
}

TEST(SimulationTwin, StepsLikeTheCpuWithARheology) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const int materials : {1, 2})
    for (const Precision precision : {Precision::Mixed, Precision::Double}) {
      compareRheology<2>(materials, precision);
      compareRheology<3>(materials, precision);
    }
}

/// Two fluids with heat and states, one's viscosity following it, on a floor that they cool at, in warm
/// surroundings.
template <int D>
void compareHeat(Precision precision, bool freezes) {
  SolverSettings settings;
  settings.precision = precision;
  Case c = stepCase(D, settings, SchemeKind::Accurate);
  c.solver.tolerance = tightTolerance;
  c.output.balance = true;
  c.heat = HeatSettings{.ambient = 500, .transfer = 30, .tolerance = 1e-24};
  for (Material& m : c.materials) m.specificHeat = 2, m.conductivity = 0.7, m.emissivity = 0.9;
  c.materials[0].viscosityShift =
      ViscosityShift{.model = ShiftModel::Arrhenius, .reference = 400, .activationEnergy = 3e4};
  // One fluid cures, both have structure.
  c.materials[0].states = {{.name = "cure",
                            .law = StateLaw::KamalSourour,
                            .a1 = 1e7,
                            .e1 = 4e4,
                            .a2 = 3e7,
                            .e2 = 4e4,
                            .m = 0.7,
                            .n = 1.5,
                            .heat = 20},
                           {.name = "structure", .law = StateLaw::Houska, .buildUp = 30, .breakDown = 1}};
  c.materials[0].gelling = Gelling{.state = "cure", .conversion = 0.6, .a = 1.5, .b = 1};
  c.materials[1].states = {{.name = "structure", .rate = "shear_rate*T/400 - t", .start = 0.5}};
  c.materials[1].viscosityFactor = "1 + structure/(1 + abs(structure))";
  c.bodies.resize(1);
  c.bodies[0].kind = BodyKind::Wall;
  c.bodies[0].temperature = 400;
  if (freezes) {
    c.materials[1].freezing = Freezing{.solidus = 415,
                                       .liquidus = 425,
                                       .latentHeat = 30,
                                       .solidConductivity = 2,
                                       .solidSpecificHeat = 1.5,
                                       .solidFactor = 20};
    c.materials[0].thermalExpansion = 0.01;
  }
  const auto start = [&] {
    Particles<D> p = bodyOnFloor<D>(c, 0.02);
    p.has.temperatures = true;
    p.temperature.resize(p.fluidCount);
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) p.temperature[i] = 400 + 5e3 * p.position[i][0];
    p.has.states = 2;
    for (std::size_t k = 0; k < 2; ++k) {
      p.states[k].resize(p.fluidCount);
      for (std::uint32_t i = 0; i < p.fluidCount; ++i) p.states[k][i] = 0.3 * static_cast<double>(k);
    }
    return p;
  };
  Simulation<D> cpu(c, start());
  Simulation<D, Cuda> cuda(c, start());
  for (int step = 0; step < 5; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_NEAR(b.diagnostics.kineticEnergy, a.diagnostics.kineticEnergy, agreement * a.diagnostics.kineticEnergy);
    const HeatBalance &x = *a.balance->heat, &y = *b.balance->heat;
    EXPECT_NEAR(y.energy, x.energy, 1e-10 * x.energy);
    EXPECT_NEAR(y.heating, x.heating, 1e-7 * x.heating);
    EXPECT_NEAR(y.surface, x.surface, 1e-7 * std::abs(x.surface));
    EXPECT_GT(x.states, 0);
    EXPECT_NEAR(y.states, x.states, 1e-7 * x.states);
    EXPECT_NEAR(b.balance->buoyancyPower, a.balance->buoyancyPower, 1e-6 * std::abs(a.balance->buoyancyPower));
  }
  Particles<D> expected = stateOf(cpu), found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(expected, found), agreement * c.spacing);
  std::vector<double> T(expected.fluidCount), cure(expected.fluidCount), structure(expected.fluidCount);
  for (std::uint32_t i = 0; i < expected.fluidCount; ++i) {
    const std::uint32_t id = expected.id[i];
    T[id] = expected.temperature[i], cure[id] = expected.states[0][i], structure[id] = expected.states[1][i];
  }
  EXPECT_GT(*std::ranges::max_element(cure), 0.01);
  ASSERT_TRUE(found.has.temperatures);
  for (std::uint32_t i = 0; i < found.fluidCount; ++i) {
    ASSERT_NEAR(found.temperature[i], T[found.id[i]], 1e-7);
    ASSERT_NEAR(found.states[0][i], cure[found.id[i]], 1e-9);
    ASSERT_NEAR(found.states[1][i], structure[found.id[i]], 1e-7);
  }
}

TEST(SimulationTwin, StepsLikeTheCpuWithHeatAndStates) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const Precision precision : {Precision::Mixed, Precision::Double}) {
    compareHeat<2>(precision, false);
    compareHeat<3>(precision, false);
  }
}

TEST(SimulationTwin, StepsLikeTheCpuWhereFluidFreezesAndRises) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const Precision precision : {Precision::Mixed, Precision::Double}) {
    compareHeat<2>(precision, true);
    compareHeat<3>(precision, true);
  }
}

/// Two fluids, of which one has two elastic modes, on a floor that moves. Warm ones have temperatures that modes
/// follow and heat, and that one fluid expands with.
template <int D>
void compareElasticity(Precision precision, bool warm) {
  SolverSettings settings;
  settings.precision = precision;
  Case c = stepCase(D, settings, SchemeKind::Accurate);
  c.solver.tolerance = tightTolerance;
  c.output.balance = true;
  c.materials[0].elastic = {
      {.name = "a", .model = ElasticModel::Giesekus, .viscosity = 5, .relaxationTime = 0.02, .mobility = 0.2},
      {.name = "b", .model = ElasticModel::OldroydB, .viscosity = 1, .relaxationTime = 1e-3}};
  c.bodies.resize(1);
  c.bodies[0].kind = BodyKind::Wall;
  if (warm) c.heat.emplace();
  for (Material& m : c.materials) m.specificHeat = 1, m.conductivity = 0.1;
  if (warm)
    c.materials[0].viscosityShift =
        ViscosityShift{.model = ShiftModel::Table, .temperatures = {300, 400}, .factors = {3, 0.3}};
  if (warm) c.materials[1].volumeFactor = "1 + 5e-4*(T - 350)";
  const auto start = [&] {
    Particles<D> p = bodyOnFloor<D>(c, 0.02);
    p.has.elasticModes = 2;
    p.has.temperatures = warm;
    if (warm) p.temperature.resize(p.fluidCount);
    for (std::uint32_t i = 0; i < (warm ? p.fluidCount : 0); ++i)
      p.temperature[i] = 350 + 40 * std::sin(2e3 * p.position[i][0]);
    for (std::size_t k = 0; k < 2; ++k) {
      p.conformation[k].resize(p.fluidCount);
      for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
        p.conformation[k][i] = SymmetricBlock<D>::identity();
        p.conformation[k][i](0, D - 1) = 0.3 * std::sin(1e3 * p.position[i][0]);
      }
    }
    return p;
  };
  Simulation<D> cpu(c, start());
  Simulation<D, Cuda> cuda(c, start());
  for (int step = 0; step < 5; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_NEAR(b.diagnostics.kineticEnergy, a.diagnostics.kineticEnergy, agreement * a.diagnostics.kineticEnergy);
    EXPECT_NEAR(b.balance->elasticPower, a.balance->elasticPower, 1e-6 * std::abs(a.balance->elasticPower));
  }
  Particles<D> expected = stateOf(cpu), found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(expected, found), agreement * c.spacing);
  ASSERT_EQ(found.has.elasticModes, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<SymmetricBlock<D>> of(expected.fluidCount);
    for (std::uint32_t i = 0; i < expected.fluidCount; ++i) of[expected.id[i]] = expected.conformation[k][i];
    for (std::uint32_t i = 0; i < found.fluidCount; ++i)
      for (int n = 0; n < SymmetricBlock<D>::size; ++n)
        ASSERT_NEAR(found.conformation[k][i].a[n], of[found.id[i]].a[n], 1e-7);
  }
  if (!warm) return;
  std::vector<double> of(expected.fluidCount);
  for (std::uint32_t i = 0; i < expected.fluidCount; ++i) of[expected.id[i]] = expected.temperature[i];
  for (std::uint32_t i = 0; i < found.fluidCount; ++i) ASSERT_NEAR(found.temperature[i], of[found.id[i]], 1e-6);
}

/// In a drum that turns around a cylinder at rest.
TEST(SimulationTwin, TurnsElasticFluidLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = ringInDrum();
  c.solver.tolerance = tightTolerance;
  c.materials[0].elastic = {
      {.name = "polymer", .model = ElasticModel::OldroydB, .viscosity = 8, .relaxationTime = 2e-3}};
  Body cylinder = c.bodies[1];
  cylinder.name = "cylinder", cylinder.shape.radius = 0.01, cylinder.shape.innerRadius = 0;
  c.bodies.push_back(cylinder);
  c.bodies[1].rotation = Rotation{{}, {0, 0, 1}, 10};
  for (const char* name : {"drum", "cylinder"}) {
    c.probes.emplace_back();
    c.probes.back().name = name, c.probes.back().body = name, c.probes.back().kind = ProbeKind::Load;
  }
  Simulation<2> cpu(c, created<2>(c));
  Simulation<2, Cuda> cuda(c, created<2>(c));
  for (int step = 0; step < 5; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(b.loads[k].torque[2], a.loads[k].torque[2], 1e-6 * std::abs(a.loads[k].torque[2]));
      EXPECT_NEAR(b.loads[k].power, a.loads[k].power, 1e-6 * std::abs(a.loads[0].power));
    }
  }
  Particles<2> found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(stateOf(cpu), found), agreement * c.spacing);
}

TEST(SimulationTwin, StepsLikeTheCpuWithElasticFluid) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const Precision precision : {Precision::Mixed, Precision::Double}) {
    for (const bool warm : {false, true}) {
      compareElasticity<2>(precision, warm);
      compareElasticity<3>(precision, warm);
    }
  }
}

TEST(SimulationTwin, StepsLikeTheCpuWhereAClusterIsTorn) {
  TREACLE_SKIP_WITHOUT_GPU();
  const auto checkSteps = [](const SolverSettings& settings) {
    Case c = tornClusterCase();
    c.solver = settings;
    c.solver.tolerance = tightTolerance;
    Simulation<2> cpu(c, tornClusterParticles(c));
    Simulation<2, Cuda> cuda(c, tornClusterParticles(c));
    for (int step = 0; step < 3; ++step) {
      const StepReport a = cpu.advance(), b = cuda.advance();
      EXPECT_EQ(b.fallbacks, 0) << b.failures;
      EXPECT_NEAR(b.iterations, a.iterations, std::max(1.0, 0.03 * a.iterations));
    }
    Particles<2> found;
    cuda.copyParticles(found);
    EXPECT_LE(farthest(stateOf(cpu), found), agreement * c.spacing);
  };
  SolverSettings s;
  checkSteps(s);
  s.precision = Precision::Double;
  checkSteps(s);
  s.preconditioner = PreconditionerKind::BucketMultigrid;
  s.krylov = KrylovKind::Cr;
  checkSteps(s);
  s.operatorKind = OperatorKind::Assembled;
  checkSteps(s);
}

TEST(SimulationTwin, DeflatesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  StretchedBody a, b;
  auto cpu = a.start(8);
  auto cuda = b.start<Cuda>(8);
  for (int step = 1; step <= 12; ++step) {
    const StepReport expected = cpu.advance(), found = cuda.advance();
    // A mode that one of the two has found a step earlier saves up to three.
    EXPECT_NEAR(found.iterations, expected.iterations, 3) << "step " << step;
    EXPECT_EQ(found.fallbacks, 0);
    // Values near the least one, and copies of values, may come and go.
    EXPECT_NEAR(cuda.particles().modeCount(), cpu.particles().modeCount(), 1) << "step " << step;
    EXPECT_EQ(cuda.particles().modes.age.due, cpu.particles().modes.age.due) << "step " << step;
  }
  EXPECT_GT(cuda.particles().modeCount(), 0u);
  Particles<2> found;
  cuda.copyParticles(found);
  EXPECT_EQ(found.modeCount(), cuda.particles().modeCount());
  // Modes are found while residuals fall, and the two need not find the same: that bounds the solves' tolerance
  // too.
  EXPECT_LE(farthest(stateOf(cpu), found), 1e-6 * a.c.spacing);
}

TEST(SimulationTwin, DeflatedStepsContinueFromACopyWithTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  StretchedBody body;
  auto whole = body.start<Cuda>(8);
  for (int step = 1; step <= 5; ++step) whole.advance();
  Particles<2> state;
  whole.copyParticles(state);
  Simulation<2, Cuda> resumed(body.c, std::move(state), whole.step(), whole.time());
  for (int step = 6; step <= 9; ++step) EXPECT_EQ(resumed.advance().iterations, whole.advance().iterations);
  Particles<2> a, b;
  whole.copyParticles(a);
  resumed.copyParticles(b);
  EXPECT_GT(a.modeCount(), 0u);
  EXPECT_EQ(a.modes.age, b.modes.age);
  forEachFieldOf(
      [](const auto& x, const auto& y) {
        const auto p = std::as_bytes(x.span()), q = std::as_bytes(y.span());
        EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end()));
      },
      a, b);
}

/// Planned lengths are few, so that what differs by rounding does not reach the steps.
TEST(SimulationTwin, ChoosesTheStepsOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = stepCase(2, {});
  c.solver.tolerance = tightTolerance;
  c.time.automatic = true;
  c.time.step = 4e-3, c.time.least = 1e-6, c.time.end = 0.02;
  Simulation<2> cpu(c, bodyOnFloor<2>(c, 0));
  Simulation<2, Cuda> cuda(c, bodyOnFloor<2>(c, 0));
  int rejected = 0;
  for (int step = 0; step < 6; ++step) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    EXPECT_EQ(a.timeStep, b.timeStep) << "step " << step;
    EXPECT_EQ(a.rejected, b.rejected) << "step " << step;
    EXPECT_NEAR(b.error, a.error, 1e-6 * a.error);
    rejected += a.rejected;
  }
  EXPECT_GT(rejected, 0);
  Particles<2> found;
  cuda.copyParticles(found);
  EXPECT_LE(farthest(stateOf(cpu), found), agreement * c.spacing);
  EXPECT_EQ(found.steps.planned, cpu.particles().steps.planned);
}

template <int D>
std::vector<std::byte> stateAfter(const Case& c, int steps) {
  Simulation<D, Cuda> s(c, bodyOnFloor<D>(c, 0));
  for (int step = 0; step < steps; ++step) s.advance();
  Particles<D> p;
  s.copyParticles(p);
  std::vector<std::byte> bits;
  p.forEachField([&](const auto& field) {
    const auto bytes = std::as_bytes(field.span());
    bits.insert(bits.end(), bytes.begin(), bytes.end());
  });
  return bits;
}

TEST(SimulationTwin, RunTwiceGivesTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    EXPECT_EQ(stateAfter<2>(stepCase(2, {}, scheme), 10), stateAfter<2>(stepCase(2, {}, scheme), 10));
    EXPECT_EQ(stateAfter<3>(stepCase(3, {}, scheme), 5), stateAfter<3>(stepCase(3, {}, scheme), 5));
  }
}

TEST(SimulationTwin, KeepsTheLastGoodStateWhenTheSolverFails) {
  TREACLE_SKIP_WITHOUT_GPU();
  SolverSettings settings;
  settings.tolerance = 1e-30;  // out of reach for every stage of the solver
  settings.maxIterations = 3;
  const Case c = stepCase(2, settings);
  Simulation<2, Cuda> s(c, bodyOnFloor<2>(c, 0));
  Particles<2> before, after;
  s.copyParticles(before);
  EXPECT_THROW(s.advance(), RunError);
  s.copyParticles(after);
  EXPECT_EQ(farthest(before, after), 0);
  EXPECT_EQ(s.step(), 0);
}

TEST(SimulationTwin, NamesTheParticleThatLeavesAnOpenDomain) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = stepCase(2, {});
  c.domain.periodic = {};
  Particles<2> p = bodyOnFloor<2>(c, 0);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) p.velocity[i][0] = -10;
  Simulation<2, Cuda> s(c, std::move(p));
  try {
    s.advance();
    FAIL() << "nothing was thrown";
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("left the domain"), std::string::npos) << e.what();
  }
  EXPECT_EQ(s.step(), 0);
}

}  // namespace
}  // namespace treacle::test
