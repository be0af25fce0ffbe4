#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/app/command.hpp"
#include "unit/app/mistakes.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// The small case with heat.
const std::string warmCase =
    "heat = { heat_transfer = 5 }\n" +
    replaced(replaced(replaced(smallCase, "bulk_modulus = 1e6",
                               "bulk_modulus = 1e6\nspecific_heat = 2000\nconductivity = 0.3"),
                      "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\ntemperature = 310"),
             "max = [12e-3, 0]", "max = [12e-3, 0]\ntemperature = 350\nwall_conductance = 100");

Case heatCaseWith(const std::vector<std::string>& overrides) {
  Workshop shop;
  shop.put("case.toml", warmCase);
  return readCase(shop / "case.toml", overrides);
}

TEST(HeatCase, IsReadAndWritten) {
  Workshop shop;
  const std::string shift = "syrup.viscosity_shift=";
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {},
           {"heat.ambient_temperature=280", "heat.viscous_heating=false", "heat.tolerance=1e-9"},
           {"column.temperature='300+1e3*x'", "syrup.emissivity=0.9", "floor.temperature=0",
            "floor.wall_conductance=0"},
           {shift + "{model='arrhenius', reference_temperature=300, activation_energy=5e4}"},
           {shift + "{model='vft', reference_temperature=300, b=500, t0=100, max_factor=1e3}"},
           {shift + "{model='wlf', reference_temperature=300, c1=17, c2=50}"},
           {shift + "{model='table', temperatures=[300, 310, 350], factors=[2, 1, 0.1]}"},
           {"syrup.thermal_expansion=5e-4", "syrup.expansion_temperature=310"},
           {"syrup.freezing={solidus=300, liquidus=301, latent_heat=2e5}"},
           {"syrup.freezing={solidus=300, liquidus=301, latent_heat=0, solid_conductivity=2, "
            "solid_specific_heat=900, solid_factor=1e4}"}}) {
    const Case c = heatCaseWith(overrides);
    shop.put("written.toml", caseText(c));
    EXPECT_EQ(readCase(shop / "written.toml"), c) << caseText(c);
  }
  const Case c = heatCaseWith({});
  EXPECT_EQ(c.heat->transfer, 5);
  EXPECT_EQ(c.heat->ambient, 293.15);
  EXPECT_EQ(c.bodies[0].temperature, 310);
  EXPECT_EQ(c.bodies[1].wallConductance, 100);
  EXPECT_EQ(c.materials[0].specificHeat, 2000);
}

const Mistake heatMistakes[] = {
    {"syrup.specific_heat=0",
     "specific_heat in [[material]] 'syrup': expected a positive number [J/(kg K)], found 0"},
    {"syrup.emissivity=2", "emissivity in [[material]] 'syrup': expected a number from 0 to 1, found 2"},
    {"column.temperature=-3",
     "temperature in [[body]] 'column' (box): expected a positive number [K] or an expression, found -3"},
    {"column.wall_conductance=3", "unknown key 'wall_conductance' in [[body]] 'column' (box)"},
    {"floor.temperature='x'",
     "temperature in [[body]] 'floor' (box): expected a number not less than 0 [K], found the string \"x\""},
    {"floor.temperature=0",
     "temperature in [[body]] 'floor' (box): missing; expected that of what is behind a wall with "
     "wall_conductance: a "
     "positive number [K]"},
    {"heat.max_iterations=0", "max_iterations in [heat]: expected a whole number from 1 to 1000000, found 0"},
    {"syrup.expansion_temperature=300",
     "expansion_temperature in [[material]] 'syrup': the material has no thermal_expansion"},
    {"syrup.freezing={solidus=301, liquidus=301, latent_heat=2e5}",
     "liquidus in the freezing of [[material]] 'syrup': expected more than solidus = 301 K, found 301"},
    {"syrup.freezing={solidus=300, liquidus=301, latent_heat=-1}",
     "latent_heat in the freezing of [[material]] 'syrup': expected a number not less than 0 [J/kg], found -1"},
    {"syrup.freezing={solidus=300, liquidus=301}",
     "latent_heat in the freezing of [[material]] 'syrup': missing; expected a number not less than 0 [J/kg]"},
    {"syrup.freezing={solidus=300, liquidus=301, latent_heat=1, solid_factor=0.5}",
     "solid_factor in the freezing of [[material]] 'syrup': expected a number from 1 to 1000000000, found 0.5"},
    {"syrup.viscosity_shift={model='ideal'}",
     "model in the viscosity_shift of [[material]] 'syrup': expected 'arrhenius', 'vft', 'wlf' or 'table', found "
     "'ideal'"},
    {"syrup.viscosity_shift={model='wlf', reference_temperature=300, c1=17}",
     "c2 in the viscosity_shift of [[material]] 'syrup' (wlf): missing; expected a positive number [K]"},
    {"syrup.viscosity_shift={model='vft', reference_temperature=300, b=500, t0=400}",
     "t0 in the viscosity_shift of [[material]] 'syrup' (vft): expected less than reference_temperature = 300 K, "
     "found "
     "400"},
    {"syrup.viscosity_shift={model='arrhenius', reference_temperature=300, activation_energy=5e4, min_factor=2}",
     "min_factor in the viscosity_shift of [[material]] 'syrup' (arrhenius): expected at most 1, the factor at "
     "the "
     "reference, found 2"},
    {"syrup.viscosity_shift={model='arrhenius', reference_temperature=300, activation_energy=5e4, max_factor=0.5}",
     "max_factor in the viscosity_shift of [[material]] 'syrup' (arrhenius): expected at least 1, the factor at "
     "the "
     "reference, found 0.5"},
    {"syrup.viscosity_shift={model='table', temperatures=[300, 290], factors=[2, 1]}",
     "temperatures in the viscosity_shift of [[material]] 'syrup' (table): expected rising numbers, found 290 "
     "after 300"},
    {"syrup.viscosity_shift={model='table', temperatures=[300, 310], factors=[2]}",
     "factors in the viscosity_shift of [[material]] 'syrup' (table): expected as many numbers as temperatures, "
     "2, found 1"},
    {"syrup.viscosity_shift={model='table', temperatures=[300], factors=[2]}",
     "temperatures in the viscosity_shift of [[material]] 'syrup' (table): expected 2 to 16 numbers, found 1"},
    {"syrup.viscosity_shift={model='table', temperatures=300, factors=[2]}",
     "temperatures in the viscosity_shift of [[material]] 'syrup' (table): expected an array of positive numbers "
     "[K], found 300"},
};

TEST(HeatCase, MistakesSayWhereAndWhatIsExpected) { expectExplained(heatMistakes, heatCaseWith); }

TEST(HeatCase, KeysOfHeatBelongToCasesWithIt) {
  Workshop shop;
  shop.put("case.toml", replaced(warmCase, "heat = { heat_transfer = 5 }\n", ""));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "case.toml"); }),
              HasSubstr("in [[material]] 'syrup': it belongs to cases with [heat]"));
  const std::string freezing = "freezing = { solidus = 300, liquidus = 301, latent_heat = 1 }";
  shop.put("freezing.toml", replaced(smallCase, "bulk_modulus = 1e6", "bulk_modulus = 1e6\n" + freezing));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "freezing.toml"); }),
              HasSubstr("unknown key 'freezing' in [[material]] 'syrup': it belongs to cases with [heat]"));
  shop.put("missing.toml", replaced(warmCase, "temperature = 310", ""));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "missing.toml"); }),
              EndsWith("temperature in [[body]] 'column' (box): missing; expected a positive number [K] or an "
                       "expression"));
  shop.put("isph.toml", "heat = {}\n" + smallIsphCase);
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "isph.toml"); }),
              HasSubstr("only the method 'mph-i' has temperatures, found 'isph'"));
  shop.put("rheology.toml", "rheology = {}\n" + smallIsphCase);
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "rheology.toml"); }),
              HasSubstr("only the method 'mph-i' has fluids that are not Newtonian, found 'isph'"));
  Case cold = heatCaseWith({"syrup.freezing={solidus=300, liquidus=301, latent_heat=1}"});
  cold.heat.reset();
  EXPECT_THROW(requireValid(cold), CaseError);
  cold = heatCaseWith({"syrup.thermal_expansion=1e-4"});
  cold.heat.reset();
  EXPECT_THROW(requireValid(cold), CaseError);
  Case c = heatCaseWith({});
  c.method.kind = MethodKind::Isph;
  EXPECT_THROW(requireValid(c), CaseError);
}

/// Automatic steps follow from the viscosities under a heavier fluid, which a wrong table does not have.
TEST(HeatCase, WrongTablesAreExplainedWithAutomaticStepsToo) {
  const std::vector<std::string> layers = {
      R"(material=[{name="heavy", density=2000, dynamic_viscosity=1, bulk_viscosity=1e3, bulk_modulus=1e4, specific_heat=1, conductivity=1}])",
      R"(body=[{name="above", type="fluid", material="heavy", shape="box", min=[0, 6e-3], max=[6e-3, 8e-3], temperature=310}])",
      "syrup.viscosity_shift={model='table', temperatures=[300, 310], factors=[2]}", "time.step=auto"};
  EXPECT_THAT(messageOf<InputError>([&] { heatCaseWith(layers); }),
              HasSubstr("expected as many numbers as temperatures"));
}

TEST(HeatCase, FilesOfTemperaturesAreInPlaceOfOne) {
  Workshop shop;
  shop.put("given.csv", "x,y,temperature\n1e-3,1e-3,400\n2e-3,1e-3,410\n");
  const std::string given =
      replaced(warmCase, "shape = \"box\"\nmin = [0, 0]\nmax = [6e-3, 6e-3]\ntemperature = 310",
               "shape = \"particles\"\nfile = \"given.csv\"\nfile_temperatures = true");
  shop.put("case.toml", given);
  const std::vector<std::string> overrides = {
      "syrup.viscosity_shift={model='arrhenius', reference_temperature=350, activation_energy=5e4}"};
  const Case c = readCase(shop / "case.toml", overrides);
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  EXPECT_EQ(p.temperature[0], 400);
  EXPECT_EQ(p.temperature[1], 410);
  EXPECT_EQ(c.typicalShift(c.materials[0]), 1);  // that of the reference: the case does not say which they are
  shop.put("both.toml",
           replaced(given, "file_temperatures = true", "file_temperatures = true\ntemperature = 310"));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "both.toml"); }),
              HasSubstr("unknown key 'temperature'"));
}

TEST(HeatCase, RunsShowTemperaturesAndContinue) {
  Workshop shop;
  shop.put("warm.toml", warmCase);
  shop.put("cold.toml", smallCase);
  const std::string balance = " --set output.balance=true --quiet";
  EXPECT_EQ(shop.call("run warm.toml" + balance).exitCode, 0);
  EXPECT_EQ(shop.call("run cold.toml" + balance).exitCode, 0);
  EXPECT_NE(shop.content("warm-run/frames/fluid_000001.vtp").find("Name=\"temperature\""), std::string::npos);
  EXPECT_EQ(shop.content("cold-run/frames/fluid_000001.vtp").find("Name=\"temperature\""), std::string::npos);
  EXPECT_NE(shop.content("warm-run/balance.csv").find(",heat_energy,viscous_heating,heat_from_walls"),
            std::string::npos);
  EXPECT_EQ(shop.content("cold-run/balance.csv").find("heat"), std::string::npos);
  EXPECT_EQ(shop.call("plot warm-run --field temperature").exitCode, 0);
  EXPECT_EQ(shop.call("plot cold-run --field temperature").exitCode, 2);
  EXPECT_EQ(
      shop.call("run warm.toml --quiet --force --end-time 3e-3 --resume warm-run/checkpoint.h5 -o on").exitCode,
      0);
  const auto refused = shop.call("run warm.toml --quiet --end-time 3e-3 --resume cold-run/checkpoint.h5 -o off");
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_THAT(refused.err, HasSubstr("a state without temperatures, but the case has heat"));
}

}  // namespace
}  // namespace treacle::test
