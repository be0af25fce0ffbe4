#include "support/loaded_walls.hpp"
#include "support/oracle.hpp"
#include "support/state_of.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/model/particles/lattice_sum.hpp"
#include "treacle/mph/cover.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace treacle::test {
namespace {

/// Momenta of the fluid [kg m/s, kg m2/s; per metre of depth in 2D], the second about the origin.
struct Momenta {
  Vec<3> linear{}, angular{};
  double mass = 0;
  Vec<3> moment{};  // sum of m x

  /// About places that are `ahead` seconds ahead of those of the particles [s].
  template <int D>
  Momenta(const Case& c, const Particles<D>& p, double ahead = 0) {
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const double m = c.materials[p.material[i]].density * std::pow(c.spacing, D);
      const Vec<3> u = resized<3>(p.velocity[i]), x = resized<3>(p.position[i]) + ahead * u;
      linear += m * u, angular += m * cross(x, u), moment += m * x;
      mass += m;
    }
  }
};

template <int D>
void checkEnergyBalance(const Case& c, Simulation<D>& s) {
  const Diagnostics before = s.diagnostics();
  const StepReport report = s.advance();
  const Balance& b = *report.balance;
  const StepEnergy energy(before, report);
  const double dt = report.velocityStep, scale = energy.scale();
  EXPECT_NEAR(energy.gained + energy.lost, energy.given, 5e-12 * scale);  // measured: 4e-13
  EXPECT_NEAR(energy.fallen, report.timeStep * (report.diagnostics.gravityPower - b.shiftPower), 5e-12 * scale);
  // No term is so small that it could be missed.
  for (const double term : {b.inertialLoss, b.shearDissipation, b.bulkDissipation, b.elasticPower, b.wallPower})
    EXPECT_GT(std::abs(dt * term), 1e-6 * scale);
  EXPECT_GT(std::abs(energy.fallen), 1e-6 * scale);
  EXPECT_GT(b.elasticEnergy, 0);
  if (c.method.scheme == SchemeKind::Accurate)
    EXPECT_GT(std::abs(dt * b.repulsionPower), 1e-6 * scale);
  else
    EXPECT_EQ(b.repulsionPower, 0);
}

/// Forces belong to places x^k + s dt u^k, and x^{k+1} is x^k + dt u^{k+1}: what changes about these places is
/// sum m (x^k + s dt u^k) x (u^{k+1} - u^k), without what follows from the way of a particle after them.
template <int D>
Vec<3> angularChange(const Case& c, const Particles<D>& before, const Particles<D>& after, double ahead) {
  std::vector<std::uint32_t> place(after.count);
  for (std::uint32_t i = 0; i < after.fluidCount; ++i) place[after.id[i]] = i;
  Vec<3> sum{};
  for (std::uint32_t i = 0; i < before.fluidCount; ++i) {
    const double m = c.materials[before.material[i]].density * std::pow(c.spacing, D);
    const Vec<3> u = resized<3>(before.velocity[i]), x = resized<3>(before.position[i]) + ahead * u;
    sum += m * cross(x, resized<3>(after.velocity[place[before.id[i]]]) - u);
  }
  return sum;
}

constexpr double slipTolerance = 0.03;

template <int D>
void checkMomenta(const Case& c, Simulation<D>& s) {
  const Particles<D> start = stateOf(s);
  const Momenta began(c, start);
  const StepReport report = s.advance();
  const Momenta after(c, s.particles());
  const double dt = report.velocityStep, ahead = c.middleShare() * report.timeStep;
  const Momenta before(c, start, ahead);
  Vec<3> force = -before.mass * c.gravity, torque = cross(c.gravity, before.moment);
  double forces = norm(force), torques = norm(torque);
  for (const WallLoad& load : report.balance->walls) {
    EXPECT_GT(norm(load.force), 0);
    force += load.force, torque += load.torque;
    forces += norm(load.force), torques += norm(load.torque);
  }
  const Vec<3> linear = after.linear - before.linear, angular = angularChange(c, start, s.particles(), ahead);
  // By the way of a step the angular momentum itself is of first order.
  if (ahead == 0) {
    EXPECT_LE(norm(angular - (after.angular - began.angular)), 1e-12 * norm(after.angular));
  }
  // Measured: 2e-11 and 4e-11, with residuals of 1e-12.
  EXPECT_LE(norm(linear + dt * force), 2e-10 * (norm(linear) + dt * forces));
  // Walls bear pressures where their particles are, which is beside where fluid that slips feels them.
  EXPECT_LE(norm(angular + dt * torque),
            (c.hasSmoothWalls() ? slipTolerance : 2e-10) * (norm(angular) + dt * torques));
}

/// Both, for walls that rest, slide past each other, and oscillate with steps of unequal length.
template <int D, class Check>
void checkMotions(Check&& check) {
  for (const SchemeKind scheme : bothSchemes)
    for (const WallsMove how : {WallsMove::Apart, WallsMove::Oscillating}) {
      SCOPED_TRACE(nameOf(scheme));
      for (const double slip : {0.0, 4e-4}) {
        LoadedWalls<D> start(how, 1, scheme);
        start.c.materials[1].slipLength = slip;
        Simulation<D> s = start.template simulation<Cpu>();
        for (int k = 0; k < 3; ++k) check(start.c, s);
      }
    }
}

TEST(Balance, EnergyIsConserved) {
  checkMotions<2>(checkEnergyBalance<2>);
  checkMotions<3>(checkEnergyBalance<3>);
}

/// Walls that move take part: they are wetted.
template <int D>
void checkSurfaceTension() {
  LoadedWalls<D> start(WallsMove::Apart, 1, SchemeKind::Accurate);
  for (Material& m : start.c.materials) m.surfaceTension = 1, m.contactAngle = 50;
  Simulation<D> s = start.template simulation<Cpu>();
  for (int k = 0; k < 3; ++k) {
    const Diagnostics before = s.diagnostics();
    const Momenta momenta(start.c, s.particles());
    const StepReport report = s.advance();
    const StepEnergy energy(before, report);
    EXPECT_NEAR(energy.gained + energy.lost, energy.given, 5e-12 * energy.scale());
    EXPECT_GT(std::abs(report.timeStep * report.balance->surfacePower), 1e-6 * energy.scale());
    EXPECT_GT(report.balance->surfaceEnergy, 0);
    Vec<3> force = -momenta.mass * start.c.gravity;
    double forces = norm(force);
    for (const WallLoad& load : report.balance->walls) force += load.force, forces += norm(load.force);
    const Vec<3> gained = Momenta(start.c, s.particles()).linear - momenta.linear;
    EXPECT_LE(norm(gained + report.timeStep * force), 2e-10 * (norm(gained) + report.timeStep * forces));
  }
}

TEST(Balance, SurfaceTensionGivesWhatItsSurfaceHad) {
  checkSurfaceTension<2>();
  checkSurfaceTension<3>();
}

TEST(Balance, ForcesOnWallsAreTheMomentumThatTheFluidLoses) {
  checkMotions<2>(checkMomenta<2>);
  checkMotions<3>(checkMomenta<3>);
}

/// The balance of [K23 eqs. (3)-(10)] from the formulas over all pairs, for the velocities at the end of a step.
template <int D>
struct PlainBalance {
  const Scene<D>& s;
  Oracle<D> oracle{s};
  std::vector<Vec<D>> u;        // as the scene's particles
  std::vector<double> resists;  // f: the share of its lambda that a fluid particle has (Cover::resists)

  PlainBalance(const Scene<D>& scene, const Particles<D>& after) : s(scene), u(after.count) {
    if (s.c.isAccurate()) oracle.findSlipSides();
    for (std::uint32_t i = 0; i < after.count; ++i)
      for (int k = 0; k < D; ++k) u[after.id[i]][k] = after.velocity[i][k];
    for (std::uint32_t i = 0; i < s.particles.fluidCount; ++i)
      resists.push_back(s.c.keepsVolume() ? resistanceOf(i) : 1);
  }

  bool isFluid(std::uint32_t i) const { return i < s.particles.fluidCount; }

  /// That of the gradient, and the root of f.
  Matrix factorOfC(std::uint32_t i) const {
    return (isFluid(i) ? std::sqrt(resists[i]) : 1) * oracle.renormalisation(i);
  }

  /// Walls have the root of the geometric mean of f around them.
  double lambda(std::uint32_t i) const {
    const double whole = oracle.material(i).bulkViscosity;
    if (isFluid(i)) return whole;
    double sum = 0, weights = 0;
    for (std::uint32_t j = 0; j < s.particles.fluidCount; ++j) {
      const double w = oracle.densityWeight(norm(oracle.difference(i, j)));
      sum += w * std::log(std::max(1e-4, resists[j])), weights += w;
    }
    return std::exp(sum / std::max(weights, 0.01 * oracle.restDensity()) / 2) * whole;
  }

  double resistanceOf(std::uint32_t i) const {
    const auto v = [&](double r) { return std::pow(std::max(0.0, 1 - r * r / (oracle.hn * oracle.hn)), 3); };
    double n = 0, walls = 0, wide = 0;
    Vec<D> away{};
    for (std::uint32_t j = 0; j < oracle.count(); ++j) {
      if (j == i) continue;
      const Vec<D> d = oracle.difference(i, j);
      n += oracle.densityWeight(norm(d));
      if (!isFluid(j)) walls += oracle.densityWeight(norm(d));
      wide += v(norm(d));
      away += v(norm(d)) * d;
    }
    const double rest = oracle.restDensity(), open = oracle.densityWeight(0) * norm(away) / (rest * oracle.l);
    return Cover::resists(open, n / rest, wide / latticeSum<D>(oracle.hn, oracle.l, v), walls / rest);
  }

  /// u_ij.B_i e_ij w'_ij^p summed over all particles.
  double divergence(std::uint32_t i) const {
    const Matrix b = factorOfC(i);
    double sum = 0;
    for (std::uint32_t j = 0; j < oracle.count(); ++j) {
      if (j == i) continue;
      const Vec<D> d = oracle.difference(i, j);
      sum += dot(u[j] - u[i], oracle.acting(i, j, times(b, d))) / norm(d) * oracle.dw(norm(d), oracle.hp);
    }
    return sum;
  }
  double overDensity(std::uint32_t i, bool withFluid) const {
    double n = 0;
    for (std::uint32_t j = 0; j < oracle.count(); ++j)
      if (j != i && (withFluid || !isFluid(j))) n += oracle.densityWeight(norm(oracle.difference(i, j)));
    return std::max(0.0, n - oracle.restDensity());
  }
  double elasticPressure(std::uint32_t i) const { return oracle.material(i).bulkModulus * overDensity(i, true); }

  /// 2 (d+2) mu_ij (u_ij.e_ij) (-w'^v) / r_ij e_ij: on wall particle i, from fluid particle j [N/m3].
  Vec<D> drag(std::uint32_t i, std::uint32_t j) const {
    const Vec<D> d = oracle.difference(i, j);
    const double r = norm(d);
    const Vec<D> e = 1 / r * d;
    const double viscosity = oracle.mu(i, j) * oracle.pairScale(i, j) * oracle.wallFactor(i, j);
    return viscosity * oracle.viscousBlock(r) * r * r * dot(u[j] - u[i], e) * e;
  }

  /// Of floor and side, and the walls' power.
  Balance walls() const {
    const double volume = s.volume();
    std::vector<double> pressure;
    std::vector<Matrix> matrix;
    for (std::uint32_t i = 0; i < oracle.count(); ++i) {
      pressure.push_back(lambda(i) * divergence(i) + elasticPressure(i));
      matrix.push_back(factorOfC(i));
    }
    Balance b;
    b.walls.resize(2);
    for (std::uint32_t i = s.particles.fluidCount; i < oracle.count(); ++i)
      for (std::uint32_t j = 0; j < s.particles.fluidCount; ++j) {
        const Vec<D> d = oracle.difference(i, j);
        const Vec<D> pressed = pressure[i] * d + pressure[j] * times(matrix[j], d);
        const Vec<D> push = oracle.dw(norm(d), oracle.hp) / norm(d) * oracle.acting(i, j, pressed) + drag(i, j) +
                            oracle.repulsion(i, j);
        Vec<3> force{};
        for (int k = 0; k < D; ++k) force[k] = volume * push[k];
        WallLoad& load = b.walls[s.particles.body[i] - 1];
        load.force += force;
        load.torque += cross(resized<3>(s.particles.position[i]), force);
        b.wallPower -= volume * dot(push, u[i]);
      }
    return b;
  }
};

/// A scene for the oracle, where the forces of a step belong, and the state after the step.
template <int D>
struct Stepped {
  Scene<D> before;
  Simulation<D> simulation;
  Balance balance;
  PlainBalance<D> plain;

  explicit Stepped(const LoadedWalls<D>& start)
      : simulation(start.template simulation<Cpu>()),
        balance(*simulation.advance().balance),
        plain(filled(start), simulation.particles()) {}

 private:
  const Scene<D>& filled(const LoadedWalls<D>& start) {
    before.c = start.c;
    before.particles = start.copy();
    const double ahead = before.c.middleShare() * before.c.time.step;
    for (std::uint32_t i = 0; i < before.particles.count; ++i)
      before.particles.position[i] += ahead * before.particles.velocity[i];
    return before;
  }
};

template <int D>
void checkLoads(WallsMove how, SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  const Stepped<D> step{LoadedWalls<D>(how, 1, scheme)};
  const Balance expected = step.plain.walls();
  ASSERT_EQ(step.balance.walls.size(), 2u);
  ASSERT_EQ(expected.walls.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const WallLoad &a = expected.walls[k], &b = step.balance.walls[k];
    // Measured: 1e-12 and 2e-11.
    EXPECT_LE(norm(a.force - b.force), 1e-11 * norm(a.force));
    EXPECT_LE(norm(a.torque - b.torque), 1e-10 * norm(a.torque));
  }
  EXPECT_NEAR(step.balance.wallPower, expected.wallPower, 1e-10 * std::abs(expected.wallPower));
  EXPECT_EQ(step.balance.wallPower == 0, how == WallsMove::Not);
}

TEST(Balance, LoadsAreTheSumsOverPairsOfWallAndFluid) {
  for (const SchemeKind scheme : bothSchemes)
    for (const WallsMove how : {WallsMove::Not, WallsMove::Apart}) {
      checkLoads<2>(how, scheme);
      checkLoads<3>(how, scheme);
    }
}

/// A wall that turns, however slowly, has its torque about its centre, wherever its velocity has carried that.
TEST(Balance, TorquesAreAboutTheCentreOfRotation) {
  LoadedWalls<2> sliding(WallsMove::Apart), turning(WallsMove::Apart);
  const Vec<3> center{0.01, -0.02, 0};
  turning.c.bodies[2].rotation = Rotation{.center = center, .speed = 1e-30};
  Simulation<2> a = sliding.simulation<Cpu>(), b = turning.simulation<Cpu>();
  for (int k = 0; k < 3; ++k) {
    const WallLoad origin = a.advance().balance->walls[1], load = b.advance().balance->walls[1];
    const Vec<3> now = center + (k * sliding.c.time.step) * sliding.c.bodies[2].velocity;
    EXPECT_GT(norm(cross(now, load.force)), 1e-3 * norm(origin.torque));
    EXPECT_LE(norm(origin.torque - cross(now, load.force) - load.torque), operatorTolerance * norm(origin.torque));
  }
}

/// Between walls at rest the dissipations are twice Rayleigh's function, together and each without the other.
template <int D>
void checkDissipations(SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  const LoadedWalls<D> start(WallsMove::Not, 1, scheme);
  const auto twiceRayleigh = [](const Stepped<D>& step) {
    return 2 * step.plain.oracle.dissipation(
                   flat<D>(step.plain.u), [&](std::uint32_t i) { return step.plain.factorOfC(i); },
                   [&](std::uint32_t i) { return step.plain.lambda(i); });
  };
  const Stepped<D> both(start);
  const double whole = twiceRayleigh(both);
  EXPECT_NEAR(both.balance.shearDissipation + both.balance.bulkDissipation, whole, operatorTolerance * whole);

  LoadedWalls<D> thin(WallsMove::Not, 1, scheme);
  for (Material& m : thin.c.materials) m.dynamicViscosity = m.bulkModulus = 0;
  const Stepped<D> bulkOnly(thin);
  EXPECT_EQ(bulkOnly.balance.shearDissipation, 0);
  EXPECT_GT(bulkOnly.balance.bulkDissipation, 0);

  LoadedWalls<D> soft(WallsMove::Not, 1, scheme);
  for (Material& m : soft.c.materials) m.bulkViscosity = m.bulkModulus = 0;
  const Stepped<D> shearOnly(soft);
  const double shear = twiceRayleigh(shearOnly);
  EXPECT_EQ(shearOnly.balance.bulkDissipation, 0);
  EXPECT_NEAR(shearOnly.balance.shearDissipation, shear, operatorTolerance * shear);
}

TEST(Balance, DissipationsAreTwiceRayleighsFunction) {
  for (const SchemeKind scheme : bothSchemes) {
    checkDissipations<2>(scheme);
    checkDissipations<3>(scheme);
  }
}

template <int D>
void checkElasticEnergy() {
  const Stepped<D> step{LoadedWalls<D>(WallsMove::Apart)};
  double energy = 0;
  for (std::uint32_t i = 0; i < step.plain.oracle.count(); ++i) {
    const double all = step.plain.overDensity(i, true);
    const double ofWalls = step.plain.isFluid(i) ? 0 : step.plain.overDensity(i, false);
    energy += step.plain.oracle.material(i).bulkModulus / 2 * (all * all - ofWalls * ofWalls);
  }
  energy *= step.before.volume();
  EXPECT_NEAR(step.balance.elasticEnergy, energy, operatorTolerance * energy);
}

TEST(Balance, ElasticEnergyIsThatOfTheDensities) {
  checkElasticEnergy<2>();
  checkElasticEnergy<3>();
}

TEST(Balance, ElasticPowerIsWhatTheElasticEnergyLoses) {
  LoadedWalls<2> start(WallsMove::Not);
  start.c.time.step = 1e-7;
  Simulation<2> s = start.simulation<Cpu>();
  const Balance first = *s.advance().balance, second = *s.advance().balance;
  const double lost = (first.elasticEnergy - second.elasticEnergy) / start.c.time.step;
  EXPECT_NEAR(first.elasticPower, lost, 1e-3 * std::abs(lost));
}

TEST(Balance, DoesNotDependOnTheNumberOfThreads) {
  LoadedWalls<2> start(WallsMove::Apart, 10);
  start.c.solver.tolerance = 1e-8;
  // Every loop runs on all threads, and dot products are sums over several chunks.
  ASSERT_GT(start.particles.fluidCount, reductionChunk);
  ASSERT_GT(start.particles.wallCount(), reductionChunk);
  const auto balance = [&](int threads) {
    omp_set_num_threads(threads);
    Simulation<2> s = start.simulation<Cpu>();
    const Balance b = *s.advance().balance;
    omp_set_num_threads(1);
    return b;
  };
  const Balance one = balance(1), three = balance(3);
  EXPECT_EQ(one.shearDissipation, three.shearDissipation);
  EXPECT_EQ(one.bulkDissipation, three.bulkDissipation);
  EXPECT_EQ(one.inertialLoss, three.inertialLoss);
  EXPECT_EQ(one.elasticPower, three.elasticPower);
  EXPECT_EQ(one.elasticEnergy, three.elasticEnergy);
  EXPECT_EQ(one.wallPower, three.wallPower);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one.walls[k].force, three.walls[k].force);
    EXPECT_EQ(one.walls[k].torque, three.walls[k].torque);
  }
}

TEST(Balance, IsMadeOnlyWhereItIsWanted) {
  LoadedWalls<2> start(WallsMove::Not);
  Simulation<2> with = start.simulation<Cpu>();
  start.c.output.balance = false;
  Simulation<2> without = start.simulation<Cpu>();
  EXPECT_TRUE(with.advance().balance.has_value());
  EXPECT_FALSE(without.advance().balance.has_value());
  EXPECT_GT(with.bytes(), without.bytes());
  for (std::uint32_t i = 0; i < with.particles().count; ++i)
    ASSERT_EQ(with.particles().position[i], without.particles().position[i]);
}

}  // namespace
}  // namespace treacle::test
