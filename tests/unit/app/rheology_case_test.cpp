#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/app/command.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// The small case with a fluid of this rheology.
std::string textWith(const std::string& rheology) {
  return replaced(smallCase, "dynamic_viscosity = 10", "rheology = { " + rheology + " }");
}

Case caseWith(const std::string& rheology, const std::vector<std::string>& overrides = {}) {
  Workshop shop;
  shop.put("case.toml", textWith(rheology));
  return readCase(shop / "case.toml", overrides);
}

const std::string bingham = "model = 'bingham', yield_stress = 20, plastic_viscosity = 2, regularisation = 50";

struct Good {
  const char* text;
  Rheology rheology;
};
const Good models[] = {
    {"model = 'power-law', consistency = 3, flow_index = 0.5, min_viscosity = 0.1, max_viscosity = 100",
     {.model = RheologyModel::PowerLaw,
      .consistency = 3,
      .flowIndex = 0.5,
      .leastViscosity = 0.1,
      .mostViscosity = 100}},
    {"model = 'cross', zero_viscosity = 30, time_constant = 2, flow_index = 0.25",
     {.model = RheologyModel::Cross, .flowIndex = 0.25, .zeroViscosity = 30, .timeConstant = 2}},
    {"model = 'carreau-yasuda', zero_viscosity = 30, infinite_viscosity = 1, time_constant = 2, flow_index = "
     "0.25, "
     "transition = 1.5",
     {.model = RheologyModel::CarreauYasuda,
      .flowIndex = 0.25,
      .zeroViscosity = 30,
      .infiniteViscosity = 1,
      .timeConstant = 2,
      .transition = 1.5}},
    {"model = 'bingham', yield_stress = 20, plastic_viscosity = 2, regularisation = 50",
     {.model = RheologyModel::Bingham, .yieldStress = 20, .plasticViscosity = 2, .regularisation = 50}},
    {"model = 'herschel-bulkley', yield_stress = 20, consistency = 2, flow_index = 0.5, regularisation = 50, "
     "max_viscosity = 1e3",
     {.model = RheologyModel::HerschelBulkley,
      .consistency = 2,
      .flowIndex = 0.5,
      .yieldStress = 20,
      .regularisation = 50,
      .mostViscosity = 1e3}},
    {"model = 'casson', yield_stress = 20, plastic_viscosity = 2, regularisation = 50",
     {.model = RheologyModel::Casson, .yieldStress = 20, .plasticViscosity = 2, .regularisation = 50}},
};

TEST(RheologyCase, EveryModelIsReadAndWritten) {
  Workshop shop;
  for (const Good& good : models) {
    const Case c = caseWith(good.text);
    EXPECT_EQ(c.materials[0].rheology, good.rheology) << good.text;
    EXPECT_EQ(c.materials[0].dynamicViscosity, 0);
    shop.put("written.toml", caseText(c));
    EXPECT_EQ(readCase(shop / "written.toml"), c) << good.text;
  }
}

TEST(RheologyCase, OverridesAndSettings) {
  const Case c = caseWith(bingham, {"syrup.rheology.yield_stress=5", "rheology.iterations=7"});
  EXPECT_EQ(c.materials[0].rheology->yieldStress, 5);
  EXPECT_EQ(c.rheology.iterations, 7);
  EXPECT_THAT(messageOf<InputError>([&] { caseWith(bingham, {"rheology.iterations=0"}); }),
              EndsWith("iterations in [rheology]: expected a whole number from 1 to 100, found 0"));
  EXPECT_THAT(messageOf<InputError>([&] { caseWith(bingham, {"rheology.tolerance=2"}); }),
              EndsWith("tolerance in [rheology]: expected a number from 0 to 1, found 2"));
}

struct Bad {
  const char* text;
  const char* message;
};
const Bad mistakes[] = {
    {"yield_stress = 2", "model in the rheology of [[material]] 'syrup': missing; expected a string"},
    {"model = 'maxwell'",
     "model in the rheology of [[material]] 'syrup': expected 'power-law', 'cross', 'carreau-yasuda', 'bingham', "
     "'herschel-bulkley' or 'casson', found 'maxwell'"},
    {"model = 'bingham', yield_stress = 20, plastic_viscosity = 2",
     "regularisation in the rheology of [[material]] 'syrup' (bingham): missing; expected a positive number [s]"},
    {"model = 'bingham', yield_stress = 20, plastic_viscosity = 2, regularisation = 0",
     "regularisation in the rheology of [[material]] 'syrup' (bingham): expected a positive number [s], found 0: "
     "a "
     "yield stress without it would make a fluid at rest infinitely viscous"},
    {"model = 'bingham', yield_stress = -1, plastic_viscosity = 2, regularisation = 1",
     "yield_stress in the rheology of [[material]] 'syrup' (bingham): expected a positive number [Pa], found -1"},
    {"model = 'casson', yield_stress = 20, plastic_viscosity = 0, regularisation = 1",
     "plastic_viscosity in the rheology of [[material]] 'syrup' (casson): expected a positive number [Pa s], "
     "found "
     "0"},
    {"model = 'power-law', consistency = 3, flow_index = 0.5",
     "max_viscosity in the rheology of [[material]] 'syrup' (power-law): expected a positive number [Pa s]: with "
     "flow_index = 0.5 < 1 a fluid at rest would be infinitely viscous"},
    {"model = 'herschel-bulkley', yield_stress = 1, regularisation = 1, consistency = 3, flow_index = 0.5",
     "max_viscosity in the rheology of [[material]] 'syrup' (herschel-bulkley): expected a positive number [Pa "
     "s]: "
     "with flow_index = 0.5 < 1 a fluid at rest would be infinitely viscous"},
    {"model = 'power-law', consistency = 3, flow_index = 1.5",
     "min_viscosity in the rheology of [[material]] 'syrup' (power-law): expected a positive number [Pa s]: with "
     "flow_index = 1.5 > 1 a fluid at rest would have no viscosity"},
    {"model = 'power-law', consistency = 3, flow_index = 0",
     "flow_index in the rheology of [[material]] 'syrup' (power-law): expected a number between 0 and 5, found 0"},
    {"model = 'power-law', consistency = 0, flow_index = 1",
     "consistency in the rheology of [[material]] 'syrup' (power-law): expected a positive number [Pa s^n], found "
     "0"},
    {"model = 'power-law', consistency = 3, flow_index = 1, min_viscosity = 3, max_viscosity = 2",
     "max_viscosity in the rheology of [[material]] 'syrup' (power-law): expected more than min_viscosity = 3, "
     "found 2"},
    {"model = 'cross', zero_viscosity = 3, infinite_viscosity = 4, time_constant = 1, flow_index = 0.5",
     "infinite_viscosity in the rheology of [[material]] 'syrup' (cross): expected at most zero_viscosity = 3, "
     "found 4"},
    {"model = 'carreau-yasuda', zero_viscosity = 3, time_constant = 1, flow_index = 1.5",
     "flow_index in the rheology of [[material]] 'syrup' (carreau-yasuda): expected at most 1 between two "
     "plateaus, found 1.5"},
    {"model = 'cross', zero_viscosity = 3, time_constant = 0, flow_index = 0.5",
     "time_constant in the rheology of [[material]] 'syrup' (cross): expected a positive number [s], found 0"},
    {"model = 'carreau-yasuda', zero_viscosity = 3, time_constant = 1, flow_index = 0.5, transition = 0",
     "transition in the rheology of [[material]] 'syrup' (carreau-yasuda): expected a number between 0 and 20, "
     "found "
     "0"},
    {"model = 'bingham', yield_stress = 20, plastic_viscosity = 2, regularisation = 1, max_viscosity = 2",
     "max_viscosity in the rheology of [[material]] 'syrup' (bingham): expected more than plastic_viscosity = 2, "
     "found 2"},
    {"model = 'cross', zero_viscosity = 3, infinite_viscosity = 1, time_constant = 1, flow_index = 0.5, "
     "max_viscosity = 0.5",
     "max_viscosity in the rheology of [[material]] 'syrup' (cross): expected more than infinite_viscosity = 1, "
     "found "
     "0.5"},
};

TEST(RheologyCase, MistakesSayWhereAndWhatIsExpected) {
  for (const Bad& bad : mistakes) {
    const std::string message = messageOf<InputError>([&] { caseWith(bad.text); });
    EXPECT_THAT(message, EndsWith(bad.message));
    EXPECT_THAT(message, HasSubstr("case.toml:15:"));
  }
  EXPECT_THAT(messageOf<InputError>([&] { caseWith("model = 'bingham', consistency = 1"); }),
              HasSubstr("unknown key 'consistency' in the rheology of [[material]] 'syrup' (bingham)"));
}

TEST(RheologyCase, ExcludesAViscosity) {
  const std::string text = "the viscosity is that of the rheology; expected one of them";
  EXPECT_THAT(messageOf<InputError>([&] { caseWith(bingham, {"syrup.dynamic_viscosity=3"}); }),
              EndsWith("dynamic_viscosity in [[material]] 'syrup': " + text));
  Case c = caseWith(bingham);
  c.materials[0].dynamicViscosity = 3;
  try {
    requireValid(c);
    FAIL() << "both were taken";
  } catch (const CaseError& error) {
    EXPECT_EQ(error.path(), (CasePath{"material", "syrup", "dynamic_viscosity"}));
    EXPECT_EQ(error.text(), text);
  }
  EXPECT_THAT(
      messageOf<InputError>([] {
        Workshop shop;
        shop.put("case.toml", replaced(smallCase, "dynamic_viscosity = 10\n", ""));
        readCase(shop / "case.toml");
      }),
      EndsWith("dynamic_viscosity in [[material]] 'syrup': missing; expected a number not less than 0 [Pa s]"));
}

TEST(RheologyCase, IsNotForIsph) {
  Workshop shop;
  shop.put("case.toml", replaced(smallIsphCase, "dynamic_viscosity = 10", "rheology = { " + bingham + " }"));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "case.toml"); }),
              HasSubstr("unknown key 'rheology' in [[material]] 'syrup': it belongs to the method 'mph-i'"));
  shop.put("good.toml", smallIsphCase);
  Case c = readCase(shop / "good.toml");
  c.materials[0].dynamicViscosity = 0;
  c.materials[0].rheology = Rheology::newtonian(1);
  try {
    requireValid(c);
    FAIL() << "ISPH took a rheology";
  } catch (const CaseError& error) {
    EXPECT_EQ(error.path(), (CasePath{"material", "syrup", "rheology"}));
    EXPECT_EQ(error.text(), "only the method 'mph-i' has fluids that are not Newtonian, found 'isph'");
  }
}

TEST(RheologyCase, RunsShowViscosityAndShearRate) {
  Workshop shop;
  shop.put("paste.toml", textWith(bingham));
  shop.put("syrup.toml", smallCase);
  EXPECT_EQ(shop.call("run paste.toml --quiet").exitCode, 0);
  EXPECT_EQ(shop.call("run syrup.toml --quiet").exitCode, 0);
  const std::string paste = shop.content("paste-run/frames/fluid_000001.vtp"),
                    syrup = shop.content("syrup-run/frames/fluid_000001.vtp");
  for (const char* field : {"Name=\"dynamic_viscosity\"", "Name=\"shear_rate\""}) {
    EXPECT_NE(paste.find(field), paste.npos);
    EXPECT_EQ(syrup.find(field), syrup.npos);
  }
}

}  // namespace
}  // namespace treacle::test
