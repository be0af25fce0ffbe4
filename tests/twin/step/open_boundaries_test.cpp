#include "support/gas_case.hpp"
#include "support/gpu.hpp"
#include "support/isph_cases.hpp"
#include "support/open_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/sheet_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/flow/outflow.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <map>

namespace treacle::test {
namespace {

TEST(OutflowTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cpu> host;
  Context<Cuda> device;
  for (const std::size_t count : {0, 1, 31, 33, 20011}) {
    const std::vector<Vec<3>> x = randomVelocities<3>(count, 5);
    std::vector<std::uint8_t> material, gone(count, 9);
    for (std::size_t i = 0; i < count; ++i) material.push_back(static_cast<std::uint8_t>(i % 5));
    const std::vector<OutflowRegion<3>> regions = {
        OutflowRegion<3>::of({"box", OutflowKind::Box, {-0.5, -0.5, -1}, {0.2, 0.5, 1}, {}, {}}),
        OutflowRegion<3>::of({"plane", OutflowKind::Plane, {}, {}, {0.1, 0, 0}, {1, 2, -1}})};
    const auto counts = markOutflow<3>(host, {regions, x, material}, gone);
    const Buffer<OutflowRegion<3>, Cuda> there = copyToDevice(device, std::span<const OutflowRegion<3>>(regions));
    Buffer<Vec<3>, Cuda> y = copyToDevice(device, std::span<const Vec<3>>(x));
    Buffer<std::uint8_t, Cuda> m = copyToDevice(device, std::span<const std::uint8_t>(material)),
                               found(device, count);
    EXPECT_EQ(markOutflow<3>(device, {there.span(), y.span(), m.span()}, found.span()), counts);
    const Buffer<std::uint8_t> copy = copyToHost(device, found);
    EXPECT_TRUE(std::equal(gone.begin(), gone.end(), copy.begin()));
  }
}

template <int D>
void compareJets(Case c) {
  c.gravity[1] = -2;
  c.solver.tolerance = 1e-22;
  c.solver.deflation = 0;
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int k = 0; k < 80; ++k) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    ASSERT_EQ(a.flow->particles, b.flow->particles);
    ASSERT_EQ(a.flow->in, b.flow->in);
    ASSERT_EQ(a.flow->out, b.flow->out);
  }
  EXPECT_GT(cuda.particles().flow.out().particles, 0u);
  const Particles<D> p = stateOf(cpu), q = stateOf(cuda);
  ASSERT_EQ(p.numbers(), q.numbers());
  std::map<std::uint32_t, Vec<D>> places;
  for (std::uint32_t i = 0; i < p.count; ++i) places[p.id[i]] = p.position[i];
  for (std::uint32_t i = 0; i < q.count; ++i) {
    ASSERT_TRUE(places.contains(q.id[i]));
    ASSERT_LE(norm(q.position[i] - places[q.id[i]]), 1e-6 * c.spacing);
  }
}

TEST(OpenBoundariesTwin, StepsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareJets<2>(jetCase(2));
  compareJets<3>(jetCase(3));
  compareJets<2>(jetCase(2, MethodKind::MphI, SchemeKind::Published));
  compareJets<2>(jetCase(2, MethodKind::Isph));
  for (const int dimensions : {2, 3}) {
    Case c = jetCase(dimensions);
    c.bodies[0].inflow.profile = "parabolic";
    dimensions == 2 ? compareJets<2>(c) : compareJets<3>(c);
  }
}

TEST(OpeningsTwin, StepLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareJets<2>(channelCase(2));
  compareJets<3>(channelCase(3));
  compareJets<2>(channelCase(2, MethodKind::Isph));
  Case pumped = channelCase(2);
  pumped.openings[0].pressure.reset();
  pumped.openings[0].flowRate = TimeFunction{5e-4};
  compareJets<2>(pumped);
}

template <int D>
void compareGas(Case c) {
  c.solver.tolerance = 1e-22;
  c.solver.deflation = 0;
  const double rounding =
      c.method.kind == MethodKind::Isph ? 1e-5 : 1e-8;  // ISPH has gradients in single precision
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int k = 0; k < 20; ++k) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    ASSERT_EQ(a.gas->pockets, b.gas->pockets);
    ASSERT_NEAR(a.gas->volume, b.gas->volume, rounding * a.gas->volume);
    ASSERT_NEAR(a.gas->pressure, b.gas->pressure, 100 * rounding * c.gas->pressure);
    for (std::size_t body = 0; body < a.rigid.size(); ++body)
      ASSERT_LT(norm(a.rigid[body].center - b.rigid[body].center), 1e-5 * c.spacing);
  }
  EXPECT_EQ(cuda.particles().gas.cells, cpu.particles().gas.cells);
}

TEST(GasTwin, StepsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareGas<2>(plugOnGas(2));
  compareGas<3>(plugOnGas(3));
}

/// A rigid body that gas carries, by both methods.
TEST(GasTwin, CarriesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  compareGas<2>(bellInHoney(450));
  Case isph = withIsph(bellInHoney(450), 0.5);
  isph.time.step = 5e-4;
  compareGas<2>(isph);
}

template <int D>
void comparePaddles(MethodKind method) {
  Case c = paddleTank(D, method);
  c.solver.tolerance = 1e-22;
  c.solver.deflation = 0;
  Simulation<D> cpu(c, created<D>(c));
  Simulation<D, Cuda> cuda(c, created<D>(c));
  for (int k = 0; k < 10; ++k) {
    const StepReport a = cpu.advance(), b = cuda.advance();
    ASSERT_NEAR(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy, 1e-8 * a.diagnostics.kineticEnergy);
  }
  const Particles<D> here = stateOf(cpu), there = stateOf(cuda);
  std::vector<std::uint32_t> side(here.count);
  for (std::uint32_t i = 0; i < here.count; ++i) side[here.id[i]] = here.side[i];
  for (std::uint32_t i = 0; i < there.count; ++i) ASSERT_EQ(there.side[i], side[there.id[i]]) << there.id[i];
}

TEST(ThinSheetTwin, StepsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  comparePaddles<2>(MethodKind::MphI);
  comparePaddles<3>(MethodKind::MphI);
  comparePaddles<2>(MethodKind::Isph);
  comparePaddles<3>(MethodKind::Isph);
}

TEST(OpenBoundariesTwin, ContinueFromACopyWithTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  Case c = jetCase(2);
  c.gravity[1] = -2;
  Simulation<2, Cuda> whole(c, created<2>(c));
  for (int k = 0; k < 45; ++k) whole.advance();
  Simulation<2, Cuda> rest(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 45; ++k) whole.advance(), rest.advance();
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
}

}  // namespace
}  // namespace treacle::test
