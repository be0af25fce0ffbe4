#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string dam = "run " TREACLE_CASES "/dam-break-2d.toml --threads 1 --end-time 0.1 ";

/// Ends with the reason, what helps, and the state before the step from which it was seen.
void expectEnded(const std::string& arguments, const std::string& why, const std::string& advice) {
  SCOPED_TRACE(arguments);
  Workshop shop;
  const Outcome outcome = shop.call(arguments + " -o run --force");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("error: after step "), HasSubstr(why), HasSubstr(advice),
                                 HasSubstr("Continue from the last checkpoint with --resume")));
  EXPECT_THAT(shop.content("run/summary.json"), AllOf(HasSubstr("\"failed\""), HasSubstr(why)));
  EXPECT_THAT(shop.content("run/run.log"), HasSubstr("watch, largest of all steps: energy "));
  EXPECT_TRUE(std::filesystem::exists(shop / "run/checkpoint.h5"));
}

TEST(WatchedRun, EndsWhereBulkConstantsMakeTheStepUnstable) {
  for (const std::string scheme : {"published", "accurate"}) {
    const std::string run = dam + "--set method.scheme=" + scheme + " --set fluid.";
    const std::string most =
        scheme == "published" ? "bulk_viscosity / step = 1e+07" : "0.5 bulk_viscosity / step = 5e+06";
    expectEnded(run + "bulk_modulus=1e12", "the step is unstable",
                "take bulk_modulus <= " + most + " for 'fluid', or time.step <= ");
    expectEnded(run + "bulk_viscosity=0", "the step is unstable", "give 'fluid' a bulk_viscosity of at least");
  }
}

TEST(WatchedRun, SeesTheSameByTheEnergyAlone) {
  expectEnded(
      dam + "--set fluid.bulk_modulus=1e12 --set watch.courant=0 --set watch.inside_walls=0 --set watch.density=0",
      "energy of the fluid have risen by", "watch.energy = 1 is exceeded");
}

const std::string drop = R"(dimensions = 2
spacing = 1e-3
gravity = {acceleration = [0, -10]}
domain = {periodic = [true, false], min = [-0.03, -0.01], max = [0.03, 0.05]}
time = {step = 1e-3, end = 0.01}
material = [{name = "m", density = 1400, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6}]
body = [
  {name = "drop", type = "fluid", material = "m", shape = "sphere", center = [0, 0.02], radius = 0.01, velocity = [0, -100]},
  {name = "floor", type = "wall", material = "m", shape = "box", min = [-0.03, -0.01], max = [0.03, 0]},
]
)";

TEST(WatchedRun, EndsWhereADropIsTooFastForItsSteps) {
  Workshop shop;
  shop.put("drop.toml", drop);
  Outcome outcome = shop.call("check drop.toml");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, HasSubstr("the Courant number of steps of 0.001 s is 100, more than 1"));
  outcome = shop.call("run drop.toml");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("after step 0 (t = 0 s): the fastest particle goes at 100 m/s, 100 spacings in a "
                        "step of 0.001 s, which the case gives; take time.step <= 5e-06 or time.courant = 0.5"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("--resume"))) << "it would fail in the same step again";
  // What is advised does it, although the impact compresses the drop.
  outcome = shop.call("run drop.toml --force --end-time 2e-4 --set time.courant=0.5");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

TEST(WatchedRun, WarnsBeforeItEnds) {
  Workshop shop;
  shop.put("drop.toml", drop);
  const Outcome outcome =
      shop.call("run drop.toml --set time.step=5e-5 --end-time 1e-4 --set watch.courant=15 --set watch.energy=0");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::string warning =
      "warning: step 1: the fastest particle goes at 100 m/s, 5 spacings in a step of 5e-05 s, which the case "
      "gives; take time.step <= "
      "5e-06";
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(warning), HasSubstr("the run ends above watch.courant = 15"),
                                 Not(HasSubstr("step 2"))));
  EXPECT_THAT(shop.content("drop-run/run.log"), HasSubstr(warning));
}

TEST(WatchedRun, EndsWhereFluidHasFallenIntoAWall) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  // A fluid with next to no pressure.
  const Outcome outcome = shop.call(
      "run case.toml --end-time 0.3 --set syrup.bulk_modulus=0 --set syrup.bulk_viscosity=1e-3 --set "
      "syrup.dynamic_viscosity=0.1 --set "
      "watch.density=0 "
      "--set 'domain.min=[-4e-3,-0.1]'");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("fluid particles are inside walls: the pressure does not hold them back"),
                    HasSubstr("watch.inside_walls = 0.05 is exceeded")));
}

/// To go on from the last checkpoint is of no use then.
TEST(WatchedRun, EndsWhenNoFluidIsLeft) {
  Workshop shop;
  shop.put("case.toml",
           smallCase +
               "\n[[outflow]]\nname = \"below\"\nshape = \"box\"\nmin = [-4e-3, -3e-3]\nmax = [12e-3, -1e-3]\n");
  const Outcome outcome = shop.call("run case.toml --threads 1 --end-time 0.1 --set 'floor.max=[12e-3,-3.5e-3]'");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("no fluid is left: all of it has gone out by the outflows"),
                                 Not(HasSubstr("--resume"))));
}

TEST(WatchedRun, SaysThatMovingWallsPressFluidTogether) {
  Workshop shop;
  shop.put("press.toml", R"(dimensions = 2
spacing = 1e-3
domain = { min = [0, 0], max = [0.02, 0.03] }
time = { step = 5e-4, end = 0.3 }
material = [{ name = "honey", density = 1400, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6 }]
body = [
  { name = "pool", type = "fluid", material = "honey", shape = "box", min = [4e-3, 4e-3], max = [16e-3, 12e-3] },
  { name = "cup", type = "wall", material = "honey", shape = "box", min = [0, 0], max = [0.02, 0.03], where = "x < 4e-3 || x > 16e-3 || y < 4e-3" },
  { name = "lid", type = "wall", material = "honey", shape = "box", min = [4e-3, 13e-3], max = [16e-3, 17e-3], velocity = [0, -0.1] },
]
)");
  const Outcome outcome = shop.call("run press.toml --threads 1");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, HasSubstr("walls that move or fluid that comes in press it together. Where there is no "
                                     "room for it, stop them sooner or "
                                     "let it out; elsewhere raise bulk_modulus"));
}

/// The light one is as stiff as the heavy one, but has next to no inertia and viscosity to keep its particles in
/// order: the heavy one sinks in, and the density rises.
TEST(WatchedRun, EndsWhereAHeavyFluidSinksIntoALightOne) {
  Workshop shop;
  shop.put("layers.toml", R"(dimensions=2
spacing=1e-3
gravity={acceleration=[0,-9.81]}
domain={min=[-0.004,-0.004],max=[0.024,0.03]}
time={step=1e-3,end=0.2}
material=[
{name="heavy",density=1000,dynamic_viscosity=10,bulk_viscosity=1e4,bulk_modulus=1e6},
{name="light",density=1,dynamic_viscosity=1e-3,bulk_viscosity=1,bulk_modulus=500},
]
body=[
{name="below",type="fluid",material="light",shape="box",min=[0,0],max=[0.02,0.01]},
{name="above",type="fluid",material="heavy",shape="box",min=[0,0.01],max=[0.02,0.02]},
{name="floor",type="wall",material="heavy",shape="box",min=[-0.004,-0.004],max=[0.024,0]},
{name="left",type="wall",material="heavy",shape="box",min=[-0.004,0],max=[0,0.024]},
{name="right",type="wall",material="heavy",shape="box",min=[0.02,0],max=[0.024,0.024]},
]
)");
  const Outcome outcome = shop.call("run layers.toml --set method.scheme=published");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("warning: fluid 'below' is too light and too thin for the heavier fluid on it"),
                    HasSubstr("a dynamic_viscosity of 'light' of at least 0.078 Pa s"),
                    HasSubstr("warning: fluid 'below' is too soft for the weight that it carries"),
                    HasSubstr("watch.density = 0.25 is exceeded")));
  const Outcome carried = shop.call(
      "run layers.toml --force --end-time 0.02 --set method.scheme=published --set light.dynamic_viscosity=0.08 "
      "--set light.bulk_viscosity=100 --set light.bulk_modulus=1e4");
  EXPECT_EQ(carried.exitCode, 0);
  EXPECT_THAT(carried.err, IsEmpty());
}

TEST(WatchedRun, AFullTankOfIsphIsWithinAllBounds) {
  Workshop shop;
  shop.put("full.toml", R"(dimensions=2
spacing=1e-3
gravity={acceleration=[0,-10]}
domain={min=[-0.006,-0.006],max=[0.026,0.026]}
time={courant=0.2,step=1e-3,end=0.3}
material=[{name="m",density=1000,dynamic_viscosity=1e-3}]
method={name="isph"}
body=[
{name="a",type="fluid",material="m",shape="box",min=[0,0],max=[0.02,0.02]},
{name="floor",type="wall",material="m",shape="box",min=[-0.004,-0.004],max=[0.024,0]},
{name="l",type="wall",material="m",shape="box",min=[-0.004,0],max=[0,0.024]},
{name="r",type="wall",material="m",shape="box",min=[0.02,0],max=[0.024,0.024]},
{name="roof",type="wall",material="m",shape="box",min=[0,0.02],max=[0.02,0.024]},
]
)");
  for (const char* domain : {"true", "false"}) {
    const Outcome outcome = shop.call(std::string("run full.toml --force --set domain.periodic=") + domain);
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace treacle::test
