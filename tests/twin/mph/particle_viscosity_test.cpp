#include "treacle/mph/particle_viscosity.hpp"
#include "support/gpu.hpp"
#include "support/scene.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/cuda.hpp"

#include <gtest/gtest.h>

#include <random>

namespace treacle::test {
namespace {

/// Two materials with rheologies, one of which follows the temperature, and a Newtonian one that does.
Case threeFluids() {
  Case c = sceneCase(2);
  c.materials.push_back({"water", 1000, 1e-3, 1, 1});
  c.materials[0].rheology =
      Rheology{.model = RheologyModel::PowerLaw, .consistency = 3, .flowIndex = 2, .leastViscosity = 1e-2};
  c.materials[1].rheology =
      Rheology{.model = RheologyModel::Casson, .yieldStress = 5, .plasticViscosity = 0.1, .regularisation = 100};
  c.heat.emplace();
  c.materials[0].viscosityShift = ViscosityShift{.model = ShiftModel::Wlf, .reference = 350, .c1 = 10, .c2 = 60};
  c.materials[2].viscosityShift =
      ViscosityShift{.model = ShiftModel::Table, .temperatures = {300, 320, 390}, .factors = {10, 1, 0.1}};
  return c;
}

/// What the loops read and write; the first particles are fluid.
struct Fields {
  std::vector<std::uint8_t> material, kind;
  std::vector<double> rate, found, share, viscosity, scaled, temperature, factor;

  Fields(std::size_t fluid, std::size_t walls) : kind(fluid + walls), viscosity(fluid), scaled(fluid) {
    std::mt19937 random(static_cast<unsigned>(fluid));
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t i = 0; i < fluid + walls; ++i) material.push_back(static_cast<std::uint8_t>(random() % 3));
    for (std::size_t i = 0; i < fluid; ++i) {
      rate.push_back(i % 7 == 0 ? 0 : std::pow(10, 8 * unit(random) - 4));
      found.push_back(std::pow(10, 8 * unit(random) - 4));
      share.push_back(1 + unit(random));
      temperature.push_back(280 + 120 * unit(random));
      factor.push_back(0.1 + unit(random));
    }
  }
};

void expectClose(const std::vector<double>& expected, Context<Cuda>& context, const Buffer<double, Cuda>& found) {
  std::vector<double> onHost(expected.size());
  copyToHost(context, found.span(), onHost.data());
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_NEAR(onHost[i], expected[i], operatorTolerance * expected[i]) << i;
}

TEST(ParticleViscosityTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  const Case c = threeFluids();
  const auto classes = ViscosityClasses::make(c);
  for (const std::size_t fluid : {0u, 1u, 31u, 33u, 20011u}) {
    SCOPED_TRACE(fluid);
    Fields f(fluid, 40);
    Context<Cpu> cpu;
    Context<Cuda> cuda;
    const auto material = copyToDevice<std::uint8_t>(cuda, f.material);
    auto rate = copyToDevice<double>(cuda, f.rate);
    const auto found = copyToDevice<double>(cuda, f.found), share = copyToDevice<double>(cuda, f.share);
    const auto temperature = copyToDevice<double>(cuda, f.temperature),
               factor = copyToDevice<double>(cuda, f.factor);
    std::vector<FormulaStep> formulas;
    RheologyTable table = RheologyTable::make(c, formulas), onDevice = table;
    table.temperature = f.temperature, onDevice.temperature = temperature.span();
    table.factor = f.factor, onDevice.factor = factor.span();
    Buffer<double, Cuda> viscosity(cuda, fluid), scaled(cuda, fluid);
    Buffer<std::uint8_t, Cuda> kind(cuda, f.kind.size());

    setViscosities(cpu, {table, 0.5, f.material, f.rate, f.share, f.viscosity, f.scaled});
    setViscosities(cuda,
                   {onDevice, 0.5, material.span(), rate.span(), share.span(), viscosity.span(), scaled.span()});
    expectClose(f.viscosity, cuda, viscosity);
    expectClose(f.scaled, cuda, scaled);

    setClasses(cpu, {classes, f.material, f.viscosity, f.kind});
    setClasses(cuda, {classes, material.span(), viscosity.span(), kind.span()});
    std::vector<std::uint8_t> kinds(f.kind.size());
    copyToHost(cuda, std::span<const std::uint8_t>(kind), kinds.data());
    std::size_t others = 0;  // at the end of a class a rounding decides
    for (std::size_t i = 0; i < kinds.size(); ++i) others += kinds[i] != f.kind[i];
    EXPECT_LE(others, kinds.size() / 1000);

    const double expected = nextRates(cpu, {table, f.material, f.rate, f.found, f.viscosity, f.rate});
    const double change =
        nextRates(cuda, {onDevice, material.span(), rate.span(), found.span(), viscosity.span(), rate.span()});
    EXPECT_NEAR(change, expected, operatorTolerance * expected);
    expectClose(f.rate, cuda, rate);
  }
}

}  // namespace
}  // namespace treacle::test
