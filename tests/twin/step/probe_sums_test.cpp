#include "treacle/step/readings/probe_sums.hpp"

#include "support/drop_case.hpp"
#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/isph_scene.hpp"
#include "support/open_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/readings/wall_patch.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

namespace treacle::test {
namespace {

void expectNear(const PartSums& a, const PartSums& b) {
  const auto x = std::bit_cast<std::array<double, PartSums::count>>(a),
             y = std::bit_cast<std::array<double, PartSums::count>>(b);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], y[k], 1e-10 * std::abs(x[k]) + 1e-25) << k;
}

/// What probes of a jet read on both, each of the state that it has itself.
template <int D>
void compareProbes() {
  Case c = jetCase(D);
  c.materials[0].dynamicViscosity = 0;
  c.materials[0].rheology = Rheology{.model = RheologyModel::PowerLaw};
  c.materials[0].rheology->consistency = 3, c.materials[0].rheology->flowIndex = 0.5;
  c.materials[0].rheology->leastViscosity = 0.1, c.materials[0].rheology->mostViscosity = 100;
  c.gravity[1] = -2;
  c.solver.tolerance = 1e-20;
  c.solver.deflation = 0;
  c.probes = {{.name = "all", .kind = ProbeKind::Region},
              {.name = "left", .kind = ProbeKind::Region, .point = {5.3e-3, 0, 0}, .normal = {1, 0.2, 0}},
              {.name = "through", .kind = ProbeKind::Flow, .point = {6e-3, 0, 0}, .normal = {1, 0, 0}},
              {.name = "there", .kind = ProbeKind::Point, .point = {5e-3, 0, 0}}};
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int k = 0; k < 30; ++k) cpu.advance(), cuda.advance();
  const std::vector<ProbeReading> a = cpu.measure(0b1111), b = cuda.measure(0b1111), some = cuda.measure(0b0100);
  ASSERT_EQ(a.size(), 4u);
  ASSERT_EQ(b.size(), 4u);
  ASSERT_EQ(some.size(), 1u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(a[k].sums.volume, 0);
    EXPECT_NEAR(a[k].sums.volume, b[k].sums.volume, 1e-6 * a[k].sums.volume);
    EXPECT_NEAR(a[k].sums.flow[0], b[k].sums.flow[0], 1e-6 * a[k].sums.flow[0]);
    EXPECT_NEAR(a[k].sums.viscosity, b[k].sums.viscosity, 1e-4 * a[k].sums.viscosity);
  }
  expectNear(some[0].sums, b[2].sums);
  const Particles<D>&p = a[3].particles.template of<D>(), &q = b[3].particles.template of<D>();
  EXPECT_GT(p.fluidCount, 5u);
  EXPECT_EQ(p.fluidCount, q.fluidCount);
}

TEST(ProbesTwin, ReadWhatTheCpuReads) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareProbes<2>();
  compareProbes<3>();
}

TEST(FrameTwin, TurnsAsOnTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const bool isph : {false, true}) {
    Case c = dropCase(3, {12e-3, 5e-3, 3e-3}, isph);
    c.frame =
        Rotation{.center = {1e-3, 0, 0}, .axis = {1, 2, 2}, .angle = TimeFunction{.expression = "sin(50*t)"}};
    c.gravity = {0, -1, 0.5};
    c.solver.tolerance = 1e-20;
    Simulation<3> cpu(c, created<3>(c));
    Simulation<3, Cuda> cuda(c, created<3>(c));
    for (int k = 0; k < 20; ++k) {
      const Diagnostics a = cpu.advance().diagnostics, b = cuda.advance().diagnostics;
      EXPECT_NEAR(a.kineticEnergy, b.kineticEnergy, 1e-8 * a.kineticEnergy);
      EXPECT_NEAR(a.potentialEnergy, b.potentialEnergy, 1e-8 * std::abs(a.potentialEnergy));
    }
  }
}

/// The same sums of the same particles.
TEST(ProbesTwin, SumsAreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cpu> host;
  Context<Cuda> device;
  Case c;
  c.dimensions = 3, c.spacing = 0.1;
  c.materials.resize(2);
  c.materials[0].name = "a", c.materials[1].name = "b";
  const Probe probe{
      .kind = ProbeKind::Region, .normal = {1, 2, 3}, .box = ProbeBox{{-0.8, -0.7, -0.9}, {0.5, 1, 1}}};
  for (const std::size_t count : {0, 1, 33, 20011}) {
    const std::vector<Vec<3>> x = randomVelocities<3>(count, 5), u = randomVelocities<3>(count, 6);
    std::vector<std::uint8_t> material;
    std::vector<double> rate, warm;
    for (std::size_t i = 0; i < count; ++i)
      material.push_back(i % 3 == 0), rate.push_back(1 + std::abs(x[i][0])), warm.push_back(300 + u[i][1]);
    PartTerms<3> terms{};
    terms.weight = PartWeight<3>::of(probe, c);
    terms.density[0] = 1000, terms.density[1] = 2000;
    std::vector<FormulaStep> formulas;
    terms.viscosities = RheologyTable::make(c, formulas);
    terms.viscosities.of[0] = Rheology::newtonian(2), terms.viscosities.of[1] = Rheology::newtonian(5);
    terms.volume = 1e-3;
    PartTerms<3> there = terms;
    terms.position = x, terms.velocity = u, terms.pressure = warm, terms.material = material;
    terms.shearRate = rate, terms.temperature = warm;
    const auto y = copyToDevice(device, std::span<const Vec<3>>(x)),
               v = copyToDevice(device, std::span<const Vec<3>>(u));
    const auto m = copyToDevice(device, std::span<const std::uint8_t>(material));
    const auto r = copyToDevice(device, std::span<const double>(rate)),
               w = copyToDevice(device, std::span<const double>(warm));
    there.position = y, there.velocity = v, there.pressure = w, there.material = m;
    there.shearRate = r, there.temperature = w;
    expectNear(sumPart<3>(host, terms), sumPart<3>(device, there));
  }
}

TEST(ProbesTwin, PressuresOnPatchesAreThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cpu> host;
  Context<Cuda> device;
  Case c;
  c.dimensions = 3, c.spacing = 0.1;
  c.domain.max = {2.5, 2.5, 2.5}, c.domain.periodic = {true, false, false};
  c.bodies.resize(2);
  c.bodies[1].name = "wall";
  const Probe probe{.kind = ProbeKind::WallPressure,
                    .corner = {-0.3, -0.2, 0.1},
                    .along = {0.6, 0.2, 0},
                    .up = {-0.2, 0.6, 0},
                    .body = "wall"};
  for (const std::size_t count : {1, 33, 20011}) {
    const std::vector<Vec<3>> x = randomVelocities<3>(count, 5), f = randomVelocities<3>(count, 6);
    std::vector<std::uint8_t> body;
    for (std::size_t i = 0; i < count; ++i) body.push_back(i % 3 > 0);
    WallPatch<3> patch = WallPatch<3>::of(probe, c);
    patch.depth = 0.5;
    const auto y = copyToDevice(device, std::span<const Vec<3>>(x)),
               g = copyToDevice(device, std::span<const Vec<3>>(f));
    const auto b = copyToDevice(device, std::span<const std::uint8_t>(body));
    const double found = patchPressure<3>(device, {patch, b.span(), y.span(), g.span()}),
                 expected = patchPressure<3>(host, {patch, body, x, f});
    EXPECT_EQ(std::isnan(found), std::isnan(expected));
    if (count > 1000) {
      EXPECT_NEAR(found, expected, 1e-10 * std::abs(expected));
    }
  }
}

}  // namespace
}  // namespace treacle::test
