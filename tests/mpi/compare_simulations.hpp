#pragma once

#include "mpi/job.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/create.hpp"
#include "treacle/step/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Of two sums or coordinates that may be zero; `scale`: what they are made of.
inline void expectNear(double a, double b, double scale, const char* what, std::int64_t step) {
  if (a == b) return;  // infinities, too
  EXPECT_NEAR(a, b, 1e-9 * scale) << what << " in step " << step;
}

inline void expectSame(const Case& c, const StepReport& a, const StepReport& b, bool alone) {
  if (alone) {
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy);
    EXPECT_EQ(a.diagnostics.frontX, b.diagnostics.frontX);
    return;
  }
  // One iteration, or two of the hundred that tolerances of 1e-22 take.
  EXPECT_NEAR(a.iterations, b.iterations, std::max(1.0, 0.02 * b.iterations)) << "step " << b.step;
  const Diagnostics &p = a.diagnostics, &q = b.diagnostics;
  double extent = 0;
  for (int k = 0; k < c.dimensions; ++k) extent = std::max(extent, c.domain.max[k] - c.domain.min[k]);
  expectNear(p.kineticEnergy, q.kineticEnergy, q.kineticEnergy, "kinetic energy", b.step);
  expectNear(p.potentialEnergy, q.potentialEnergy, std::abs(q.potentialEnergy), "potential energy", b.step);
  expectNear(p.elasticEnergy, q.elasticEnergy, q.elasticEnergy + q.kineticEnergy, "elastic energy", b.step);
  expectNear(p.frontX, q.frontX, extent, "front", b.step);
  expectNear(p.top, q.top, extent, "top", b.step);
  expectNear(p.maxSpeed, q.maxSpeed, q.maxSpeed, "speed", b.step);
  EXPECT_EQ(p.insideWalls, q.insideWalls);
  EXPECT_EQ(p.interiorParticles, q.interiorParticles);
  expectNear(p.meanDensityRatio, q.meanDensityRatio, 1, "density", b.step);
  expectNear(p.meanDensityError, q.meanDensityError, 1, "density error", b.step);
  ASSERT_EQ(a.balance.has_value(), b.balance.has_value());
  if (!a.balance) return;
  const double power = std::abs(q.gravityPower) + b.balance->shearDissipation;
  expectNear(a.balance->shearDissipation, b.balance->shearDissipation, power, "shear", b.step);
  expectNear(a.balance->bulkDissipation, b.balance->bulkDissipation, power, "bulk", b.step);
  expectNear(a.balance->elasticPower, b.balance->elasticPower, power, "elastic power", b.step);
  expectNear(a.balance->repulsionPower, b.balance->repulsionPower, power, "repulsion", b.step);
}

/// Particles by identifier.
template <int D>
std::vector<std::uint32_t> placeOfId(const Particles<D>& p) {
  std::vector<std::uint32_t> place(p.count);
  for (std::uint32_t i = 0; i < p.count; ++i) place[p.id[i]] = i;
  return place;
}

/// All fields of all particles, which the first process has.
template <int D>
void expectSameFields(const Case& c, const Particles<D>& a, const Particles<D>& b) {
  ASSERT_EQ(a.numbers(), b.numbers());
  EXPECT_EQ(a.steps.last, b.steps.last);
  EXPECT_EQ(a.modes.age.due, b.modes.age.due);
  const std::vector<std::uint32_t> inA = placeOfId(a), inB = placeOfId(b);
  double speed = 0, stress = 0;
  for (std::uint32_t i = 0; i < b.count; ++i)
    speed = std::max(speed, norm(b.velocity[i])), stress = std::max(stress, std::abs(b.pressure[i]));
  for (std::uint32_t id = 0; id < b.count; ++id) {
    const std::uint32_t i = inA[id], j = inB[id];
    ASSERT_EQ(i < a.fluidCount, j < b.fluidCount);
    EXPECT_EQ(a.material[i], b.material[j]);
    EXPECT_EQ(a.body[i], b.body[j]);
    ASSERT_LT(norm(a.position[i] - b.position[j]), 1e-8 * c.spacing) << id;
    ASSERT_LT(norm(a.velocity[i] - b.velocity[j]), 1e-6 * speed) << id;
    ASSERT_NEAR(a.pressure[i], b.pressure[j], 1e-4 * stress) << id;  // the bulk viscosity amplifies what is left
    // Wall particles without fluid in reach have a density only where one beside them in the sort has fluid.
    const bool wall = i >= a.fluidCount, unknown = a.numberDensity[i] == 0 || b.numberDensity[j] == 0;
    if (!wall || !unknown) {
      ASSERT_NEAR(a.numberDensity[i], b.numberDensity[j], 1e-8 * b.numberDensity[j]) << id;
    }
    if (wall) continue;
    ASSERT_LT(norm(a.acceleration[i] - b.acceleration[j]) * c.time.step, 1e-6 * speed) << id;
    ASSERT_EQ(norm2(a.jerk[i]) > 0, norm2(b.jerk[j]) > 0) << id;
    if (a.hasShearRates) {
      ASSERT_NEAR(a.shearRate[i], b.shearRate[j], 1e-6 * speed / c.spacing) << id;
    }
  }
}

/// A simulation that the processes share against one that each of them makes for itself: iterations, energies and
/// extents of every step; all fields at the end.
template <int D, class Backend = Cpu>
void compare(const Settings& settings) {
  SCOPED_TRACE(settings.file);
  const Case c = settings.read();
  Simulation<D, Backend> shared(c, made<D>(c), 0, 0, &job());
  Simulation<D, Backend> alone(c, made<D>(c));
  for (int k = 0; k < settings.steps; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    expectSame(c, a, b, job().size() == 1);
  }
  Particles<D> whole, expected;
  shared.copyParticles(whole);
  alone.copyParticles(expected);
  if (job().rank() == 0) expectSameFields(c, whole, expected);
}

}  // namespace treacle::test
