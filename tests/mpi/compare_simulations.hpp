#pragma once

#include "mpi/job.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/frames/arrangement.hpp"
#include "treacle/io/frames/frame.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace treacle::test {

struct Settings {
  const char* file;
  int steps;
  std::vector<std::string> keys;

  Case read() const { return readCase(casesDirectory() + "/" + file, keys); }
};

template <int D>
Particles<D> made(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<D>(c, notes);
}

/// What this process begins with.
template <int D>
Particles<D> partOf(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<D>(c, notes, nullptr,
                            {static_cast<std::uint32_t>(job().rank()), static_cast<std::uint32_t>(job().size())});
}

/// Of two sums or coordinates that may be zero; `scale`: what they are made of.
inline void expectNear(double a, double b, double scale, const char* what, std::int64_t step,
                       double rounding = 1e-9) {
  if (a == b) return;  // infinities, too
  EXPECT_NEAR(a, b, rounding * scale) << what << " in step " << step;
}

/// Of sums in another order, after some steps. ISPH rounds gradients to single precision, and damps by the root of
/// pressures that may be nothing but rounding.
inline double roundingOf(const Case& c) { return c.method.kind == MethodKind::Isph ? 1e-7 : 1e-9; }

inline void expectSame(const Case& c, const StepReport& a, const StepReport& b, bool alone) {
  if (alone) {
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy);
    EXPECT_EQ(a.diagnostics.frontX, b.diagnostics.frontX);
    return;
  }
  // Two iterations, as on processors with AVX-512, or two of the hundred that tolerances of 1e-22 take.
  EXPECT_NEAR(a.iterations, b.iterations, std::max(2.0, 0.02 * b.iterations)) << "step " << b.step;
  const Diagnostics &p = a.diagnostics, &q = b.diagnostics;
  double extent = 0;
  for (int k = 0; k < c.dimensions; ++k) extent = std::max(extent, c.domain.max[k] - c.domain.min[k]);
  const double rounding = roundingOf(c);
  expectNear(p.kineticEnergy, q.kineticEnergy, q.kineticEnergy, "kinetic energy", b.step, rounding);
  expectNear(p.potentialEnergy, q.potentialEnergy, std::abs(q.potentialEnergy), "potential energy", b.step,
             rounding);
  expectNear(p.elasticEnergy, q.elasticEnergy, q.elasticEnergy + q.kineticEnergy, "elastic energy", b.step,
             rounding);
  expectNear(p.frontX, q.frontX, extent, "front", b.step, rounding);
  expectNear(p.top, q.top, extent, "top", b.step, rounding);
  expectNear(p.maxSpeed, q.maxSpeed, q.maxSpeed, "speed", b.step, rounding);
  EXPECT_EQ(p.insideWalls, q.insideWalls);
  EXPECT_EQ(p.interiorParticles, q.interiorParticles);
  expectNear(p.meanDensityRatio, q.meanDensityRatio, 1, "density", b.step);
  expectNear(p.meanDensityError, q.meanDensityError, 1, "density error", b.step);
  ASSERT_EQ(a.flow.has_value(), b.flow.has_value());
  if (a.flow) {
    EXPECT_EQ(a.flow->particles, b.flow->particles);
    EXPECT_EQ(a.flow->in, b.flow->in);
    EXPECT_EQ(a.flow->out, b.flow->out);
  }
  ASSERT_EQ(a.balance.has_value(), b.balance.has_value());
  if (!a.balance) return;
  const double power = std::abs(q.gravityPower) + b.balance->shearDissipation;
  expectNear(a.balance->shearDissipation, b.balance->shearDissipation, power, "shear", b.step);
  expectNear(a.balance->bulkDissipation, b.balance->bulkDissipation, power, "bulk", b.step);
  expectNear(a.balance->elasticPower, b.balance->elasticPower, power, "elastic power", b.step);
  expectNear(a.balance->repulsionPower, b.balance->repulsionPower, power, "repulsion", b.step);
  expectNear(a.balance->shiftPower, b.balance->shiftPower, power, "shift", b.step);
  expectNear(a.balance->surfacePower, b.balance->surfacePower, power, "surface power", b.step);
  expectNear(a.balance->buoyancyPower, b.balance->buoyancyPower, power, "buoyancy", b.step);
  expectNear(a.balance->surfaceEnergy, b.balance->surfaceEnergy, b.balance->surfaceEnergy, "surface energy",
             b.step);
}

/// Particles by identifier.
template <int D>
std::vector<std::uint32_t> placeOfId(const Particles<D>& p) {
  const std::uint32_t last = p.count > 0 ? *std::max_element(p.id.begin(), p.id.end()) : 0;
  std::vector<std::uint32_t> place(std::size_t{last} + 1);
  for (std::uint32_t i = 0; i < p.count; ++i) place[p.id[i]] = i;
  return place;
}

/// All fields of all particles, which the first process has.
template <int D>
void expectSameFields(const Case& c, const Particles<D>& a, const Particles<D>& b) {
  ASSERT_EQ(a.numbers(), b.numbers());
  EXPECT_EQ(a.steps.last, b.steps.last);
  EXPECT_EQ(a.modes.age.due, b.modes.age.due);
  const std::vector<std::uint32_t> inA = placeOfId(a);
  double speed = 0, stress = 0;
  for (std::uint32_t i = 0; i < b.count; ++i)
    speed = std::max(speed, norm(b.velocity[i])), stress = std::max(stress, std::abs(b.pressure[i]));
  for (std::uint32_t j = 0; j < b.count; ++j) {
    const std::uint32_t id = b.id[j];
    ASSERT_LT(id, inA.size());
    const std::uint32_t i = inA[id];
    ASSERT_EQ(a.id[i], id);
    ASSERT_EQ(i < a.fluidCount, j < b.fluidCount);
    EXPECT_EQ(a.material[i], b.material[j]);
    EXPECT_EQ(a.body[i], b.body[j]);
    ASSERT_LT(norm(a.position[i] - b.position[j]), 20 * roundingOf(c) * c.spacing) << id;
    ASSERT_LT(norm(a.velocity[i] - b.velocity[j]), 1e-6 * speed) << id;
    // Wall particles without fluid in reach have a density and a pressure only where one beside them in the sort
    // has fluid.
    const bool wall = i >= a.fluidCount, unknown = a.numberDensity[i] == 0 || b.numberDensity[j] == 0;
    if (!wall || !unknown) {
      ASSERT_NEAR(a.pressure[i], b.pressure[j], 1e-4 * stress) << id;  // the bulk viscosity amplifies what is left
      ASSERT_NEAR(a.numberDensity[i], b.numberDensity[j], 10 * roundingOf(c) * b.numberDensity[j]) << id;
    }
    if (wall) continue;
    ASSERT_LT(norm(a.acceleration[i] - b.acceleration[j]) * c.time.step, 1e-6 * speed) << id;
    ASSERT_EQ(norm2(a.jerk[i]) > 0, norm2(b.jerk[j]) > 0) << id;
    if (a.has.temperatures) {
      ASSERT_NEAR(a.temperature[i], b.temperature[j], 1e-8 * b.temperature[j]) << id;
    }
    if (a.has.viscosityFactors) {
      ASSERT_EQ(a.viscosityFactor[i], b.viscosityFactor[j]) << id;
    }
    ASSERT_EQ(a.has.elasticModes, b.has.elasticModes);
    for (std::size_t k = 0; k < a.has.elasticModes; ++k)
      for (int n = 0; n < SymmetricBlock<D>::size; ++n)
        ASSERT_NEAR(a.conformation[k][i].a[n], b.conformation[k][j].a[n], 1e-6) << id;
    ASSERT_EQ(a.has.states, b.has.states);
    for (std::size_t k = 0; k < a.has.states; ++k) ASSERT_NEAR(a.states[k][i], b.states[k][j], 1e-6) << id;
    if (a.has.shearRates) {
      ASSERT_NEAR(a.shearRate[i], b.shearRate[j], 1e-6 * speed / c.spacing) << id;
    }
  }
}

/// What the processes show of a simulation, each its own part, against all particles, which the first process has:
/// every particle is one process's, with the same fields, and has found the same nearest one.
template <int D, class Backend>
void expectOwnParticles(const Case& c, const Simulation<D, Backend>& shared, const Particles<D>& whole) {
  if (job().size() == 1) return;
  Particles<D> own;
  const std::uint32_t ownWalls = shared.copyOwnParticles(own), walls = own.wallBegin();
  EXPECT_LE(ownWalls, own.wallCount());
  std::vector<Vec<3>> others;
  for (std::uint32_t i = own.fluidCount; i < own.count; ++i)
    if (!own.has.sides || !(own.side[i] & sides::ofSheet)) others.push_back(resized<3>(own.position[i]));
  Frame fluid = makeFrame(own, 0, own.fluidCount, 0);
  measureArrangementPart(fluid, others, c.domain, c.spacing);
  const bool first = job().rank() == 0;
  const auto at = [&]<class T>(std::span<const T> values, const std::vector<std::uint32_t>& ids) {
    std::vector<T> byId(std::size_t{*std::max_element(whole.id.begin(), whole.id.end())} + 1);
    for (std::size_t k = 0; k < ids.size(); ++k) byId[ids[k]] = values[k];
    return byId;
  };
  const auto compareGroup = [&](std::uint32_t begin, std::uint32_t count, std::uint32_t wholeBegin,
                                std::uint32_t wholeCount) {
    const auto ids = job().collect(std::span<const std::uint32_t>(own.id.span().subspan(begin, count)));
    std::vector<std::uint32_t> found = ids,
                               expected(whole.id.begin() + wholeBegin, whole.id.begin() + wholeBegin + wholeCount);
    std::ranges::sort(found), std::ranges::sort(expected);
    const bool complete = !first || found == expected;
    EXPECT_TRUE(complete);  // who ends here would leave the others waiting
    forEachSharedFieldOf(
        [&]<class T>(const Buffer<T>& mine, const Buffer<T>& all) {
          const std::vector<T> parts = job().collect(std::span<const T>(mine.span().subspan(begin, count)));
          if (!first || !complete) return;
          const std::vector<T> byId = at(std::span<const T>(parts), ids);
          for (std::uint32_t i = wholeBegin; i < wholeBegin + wholeCount; ++i)
            ASSERT_EQ(byId[whole.id[i]], all[i]) << whole.id[i];
        },
        own, whole);
  };
  compareGroup(0, own.fluidCount, 0, whole.fluidCount);
  compareGroup(walls, ownWalls, whole.wallBegin(), whole.wallCount());
  const std::vector<double> distances = job().collect(std::span<const double>(fluid.nearestDistance));
  const std::vector<std::uint32_t> ids = job().collect(std::span<const std::uint32_t>(fluid.id));
  if (!first) return;
  Frame allFluid = makeFrame(whole, 0, whole.fluidCount, 0);
  measureArrangement(allFluid, solidWalls(c, makeFrame(whole, whole.wallBegin(), whole.count, 0)), c.domain,
                     c.spacing);
  const std::vector<double> byId = at(std::span<const double>(distances), ids);
  for (std::size_t k = 0; k < allFluid.id.size(); ++k)
    ASSERT_EQ(byId[allFluid.id[k]], allFluid.nearestDistance[k]) << allFluid.id[k];
}

/// A simulation that the processes share against one that each of them makes for itself: iterations, energies and
/// extents of every step; all fields at the end.
template <int D, class Backend = Cpu>
void compare(const Settings& settings) {
  SCOPED_TRACE(settings.file);
  const Case c = settings.read();
  Simulation<D, Backend> shared(c, partOf<D>(c), 0, 0, &job());
  Simulation<D, Backend> alone(c, made<D>(c));
  for (int k = 0; k < settings.steps; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    expectSame(c, a, b, job().size() == 1);
  }
  Particles<D> whole, expected;
  shared.copyParticles(whole);
  alone.copyParticles(expected);
  if (job().rank() == 0)
    expectSameFields(c, whole, expected);
  else
    whole.has = expected.has;  // all gather the same fields
  expectOwnParticles(c, shared, whole);
}

/// Walls that are far from the fluid of all processes are held by none, and all take in the same ones.
inline void compareWallsThatComeAndGo(const Case& c) {
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  const std::uint32_t start = shared.particles().wallCount();
  bool changed = false;
  for (int k = 0; k < 20; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    expectSame(c, a, b, job().size() == 1);
    ASSERT_EQ(shared.particles().wallCount(), alone.particles().wallCount()) << "step " << k;
    changed = changed || shared.particles().wallCount() != start;
  }
  EXPECT_TRUE(changed);
  EXPECT_LT(start, shared.numbers().wall);
  Particles<2> whole, expected;
  shared.copyParticles(whole);
  alone.copyParticles(expected);
  if (job().rank() == 0)
    expectSameFields(c, whole, expected);
  else
    whole.has = expected.has;  // all gather the same fields
  expectOwnParticles(c, shared, whole);
}

/// Ten steps, and again.
template <class Backend = Cpu>
void expectSameBitsAgain(const char* file) {
  const Case c = Settings{file, 0, {}}.read();
  Simulation<2, Backend> one(c, partOf<2>(c), 0, 0, &job()), other(c, partOf<2>(c), 0, 0, &job());
  for (int k = 0; k < 10; ++k) {
    const StepReport a = one.advance(), b = other.advance();
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.residual, b.residual);
    EXPECT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy);
  }
  Particles<2> p, q;
  one.copyParticles(p);
  other.copyParticles(q);
  ASSERT_EQ(p.numbers(), q.numbers());
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) EXPECT_EQ(p.velocity[i], q.velocity[i]);
}

/// A particle that leaves an open domain is one process's: all end with its words, and keep the state before.
template <class Backend = Cpu>
void expectAgreementOnAParticleThatLeaves() {
  Case c = Settings{"dam-break-2d.toml", 0, {"domain.periodic=false", "watch.courant=0"}}.read();
  c.gravity = {1e5, 0, 0};
  Simulation<2, Backend> shared(c, partOf<2>(c), 0, 0, &job());
  std::string error;
  try {
    for (int k = 0; k < 50; ++k) shared.advance();
  } catch (const RunError& e) {
    error = e.what();
  }
  EXPECT_NE(error.find("left the domain"), std::string::npos) << error;
  EXPECT_EQ(error.rfind("rank ", 0) == 0, job().size() > 1) << error;
  Particles<2> whole;
  shared.copyParticles(whole);
  if (job().rank() > 0) return;
  for (std::uint32_t i = 0; i < whole.fluidCount; ++i) EXPECT_LE(whole.position[i][0], c.domain.max[0]);
}

}  // namespace treacle::test
