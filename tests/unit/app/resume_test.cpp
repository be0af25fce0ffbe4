#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "command.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A workshop with 8 steps of the small case on a moving floor in case.toml.
Workshop& withMovingFloor(Workshop& shop) {
  shop.put("case.toml", replaced(replaced(smallCase, "max = [12e-3, 0]", "max = [12e-3, 0]\nvelocity = [0.05, 0]"),
                                 "end = 2e-3", "end = 8e-3"));
  return shop;
}

std::string frame(const std::string& run, const std::string& group, std::size_t number) {
  return fmt::format("{}/frames/{}_{:06}.vtp", run, group, number);
}

void expectSameFrames(const Workshop& shop, std::size_t whole, std::size_t resumed) {
  for (const char* group : {"fluid", "walls"})
    EXPECT_EQ(shop.content(frame("whole", group, whole)), shop.content(frame("resumed", group, resumed))) << group;
}

void expectRefused(const Workshop& shop, const std::string& arguments, const std::string& message) {
  const Outcome outcome = shop.call("run case.toml -o other --resume " + arguments);
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, StartsWith("treacle: error: "));
  EXPECT_THAT(outcome.err, HasSubstr(message));
  EXPECT_FALSE(std::filesystem::exists(shop / "other"));
}

void checkBits(const std::string& more) {
  Workshop shop;
  const std::string options = " --set output.precision=double --set time.step=7e-4 --threads 1" + more;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole --end-time 7e-3" + options).exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o half --end-time 3.5e-3" + options).exitCode, 0);
  const Outcome outcome =
      shop.call("run case.toml -o resumed --end-time 7e-3 --resume half/checkpoint.h5" + options);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("continues after step 5 (t = 0.0035 s)"));

  const auto whole = readHistory(shop / "whole/history.csv"), resumed = readHistory(shop / "resumed/history.csv");
  ASSERT_EQ(whole.size(), 10u);
  ASSERT_EQ(resumed.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(resumed[k].step, whole[5 + k].step);
    EXPECT_EQ(resumed[k].time, whole[5 + k].time);
    EXPECT_EQ(resumed[k].iterations, whole[5 + k].iterations);
    EXPECT_EQ(resumed[k].residual, whole[5 + k].residual);
    EXPECT_EQ(resumed[k].kineticEnergy, whole[5 + k].kineticEnergy);
  }
  EXPECT_EQ(shop.content("whole/checkpoint.h5"), shop.content("resumed/checkpoint.h5"));
  // Frames fall to steps 0, 1, 3, 4, 6, 7, 9 (6.3 ms), 10; that of the state resumed from is an extra one.
  const auto first = RunDirectory::open(shop / "whole"), second = RunDirectory::open(shop / "resumed");
  ASSERT_EQ(first.frameCount(), 8u);
  ASSERT_EQ(second.frameCount(), 5u);
  for (std::size_t k = 1; k < 5; ++k) expectSameFrames(shop, 3 + k, k);
  EXPECT_EQ(second.frameTime(0), 5 * 7e-4);
}

TEST(resume, givesTheSameBitsAsAnUnbrokenRun) { checkBits(""); }
TEST(resume, givesTheSameBitsWhereWallsHaveSurfaces) { checkBits(" --set method.scheme=accurate"); }

TEST(resume, givesTheSameBitsWithStepsThatVary) {
  Workshop shop;
  const std::string options = " --set output.precision=double --set time.courant=0.01 --threads 1";
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole" + options).exitCode, 0);
  const auto whole = readHistory(shop / "whole/history.csv");
  ASSERT_GT(whole.size(), 8u);
  // After the first step: a later one would be cut to meet the end, and differ by rounding.
  ASSERT_EQ(shop.call(fmt::format("run case.toml -o first --end-time {}{}", whole[0].time, options)).exitCode, 0);
  const Outcome outcome = shop.call("run case.toml -o resumed --resume first/checkpoint.h5" + options);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("continues after step 1 (t = "));
  const auto resumed = readHistory(shop / "resumed/history.csv");
  ASSERT_EQ(resumed.size() + 1, whole.size());
  for (std::size_t k = 0; k < resumed.size(); ++k) {
    EXPECT_EQ(resumed[k].step, whole[1 + k].step);
    EXPECT_EQ(resumed[k].time, whole[1 + k].time);
    EXPECT_EQ(resumed[k].timeStep, whole[1 + k].timeStep);
  }
  EXPECT_TRUE(shop.content("whole/checkpoint.h5") == shop.content("resumed/checkpoint.h5"));
}

TEST(resume, givesTheSameBitsWithAutomaticSteps) {
  Workshop shop;
  const std::string options = " --set output.precision=double --set time.step=auto --threads 1";
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole" + options).exitCode, 0);
  // Ended where the whole run has a frame, which its steps meet, too.
  ASSERT_EQ(shop.call("run case.toml -o half --end-time 3e-3" + options).exitCode, 0);
  const Outcome outcome = shop.call("run case.toml -o resumed --resume half/checkpoint.h5" + options);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto whole = readHistory(shop / "whole/history.csv"), resumed = readHistory(shop / "resumed/history.csv");
  ASSERT_LT(resumed.size(), whole.size());
  const std::size_t done = whole.size() - resumed.size();
  EXPECT_EQ(whole[done - 1].time, 3e-3);
  for (std::size_t k = 0; k < resumed.size(); ++k) {
    EXPECT_EQ(resumed[k].step, whole[done + k].step);
    EXPECT_EQ(resumed[k].time, whole[done + k].time);
    EXPECT_EQ(resumed[k].timeStep, whole[done + k].timeStep);
    EXPECT_EQ(resumed[k].kineticEnergy, whole[done + k].kineticEnergy);
  }
  EXPECT_TRUE(shop.content("whole/checkpoint.h5") == shop.content("resumed/checkpoint.h5"));
}

TEST(resume, takesUpAutomaticStepsWhereEqualOnesEnded) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o equal --threads 1 --end-time 4e-3").exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o other --threads 1 --set time.step=auto --set time.tolerance=0.5 "
                      "--set output.interval=0 --resume equal/checkpoint.h5")
                .exitCode,
            0);
  const auto rows = readHistory(shop / "other/history.csv");
  EXPECT_EQ(rows.front().step, 5);
  EXPECT_NEAR(rows.front().timeStep, 1e-3, 1e-9);
  EXPECT_EQ(rows.back().time, 8e-3);
}

TEST(resume, startsWithTheFrameThatTheRunEndedWith) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole --threads 1 --end-time 4e-3").exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o resumed --threads 1 --resume whole/checkpoint.h5").exitCode, 0);
  expectSameFrames(shop, 4, 0);
}

TEST(resume, continuesAFailedRun) {
  Workshop shop;
  const Outcome failed =
      withMovingFloor(shop).call("run case.toml -o failed --threads 1 --set solver.max_iterations=3");
  EXPECT_EQ(failed.exitCode, 3);
  EXPECT_THAT(failed.err, HasSubstr("after step 0 (t = 0 s): the linear solver did not converge"));
  ASSERT_EQ(shop.call("run case.toml -o resumed --threads 1 --resume failed/checkpoint.h5").exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o whole --threads 1").exitCode, 0);
  expectSameFrames(shop, 8, 8);
}

TEST(resume, continuesWithAShorterStep) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole --threads 1 --end-time 4e-3").exitCode, 0);
  ASSERT_EQ(
      shop.call("run case.toml -o finer --threads 1 --set time.step=5e-4 --resume whole/checkpoint.h5").exitCode,
      0);
  const auto rows = readHistory(shop / "finer/history.csv");
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows[0].step, 9);
  EXPECT_EQ(rows[0].time, 9 * 5e-4);
}

TEST(resume, checkpointsFollowTheirInterval) {
  Workshop shop;
  // Ended at once, without the time to write a last one: the checkpoint is that of a multiple of 3 ms.
  const std::string script =
      "run case.toml -o out --threads 1 --quiet --end-time 30 --set output.checkpoint_interval=3e-3 "
      "--set output.interval=0 --set 'floor.velocity=[0, 0]' --set 'gravity.acceleration=[0, -1e-3]' & run=$!; "
      "while [ ! -s out/checkpoint.h5 ]; do sleep 0.05; done; kill -KILL $run; wait $run";
  withMovingFloor(shop).call(script);
  const Checkpoint<2> checkpoint = readCheckpoint<2>(shop / "out/checkpoint.h5");
  EXPECT_GT(checkpoint.step, 0);
  EXPECT_EQ(checkpoint.step % 3, 0);
}

TEST(resume, refusesWhatDoesNotFit) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o whole --threads 1 --end-time 3e-3").exitCode, 0);
  shop.put("text.h5", "no checkpoint");
  shop.put("cut.h5", shop.content("whole/checkpoint.h5").substr(0, 4000));
  expectRefused(shop, "none.h5", "none.h5: No such file or directory");
  expectRefused(shop, "text.h5", "text.h5: not a treacle checkpoint: not an HDF5 file");
  expectRefused(shop, "cut.h5", "cut.h5: no usable checkpoint: its checksum is missing: it is cut off");
  expectRefused(shop, "whole/checkpoint.h5 --end-time 3e-3",
                "its time 0.003 s is not before the end of the run, 0.003 s; choose a later one with --end-time");
  expectRefused(shop, "whole/checkpoint.h5 --set time.step=2e-3",
                "its time 0.003 s is not a whole number of steps of 0.002 s (time.step)");
  expectRefused(shop, "whole/checkpoint.h5 --set resolution=2",
                "36 fluid and 64 wall particles, but the case has 144 and 256");
  expectRefused(shop, "whole/checkpoint.h5 --set column.viscosity_factor=5",
                "a state without factors of the viscosity, but a body of the case has a viscosity_factor");
  ASSERT_EQ(
      shop.call("run case.toml -o factors --threads 1 --end-time 3e-3 --set column.viscosity_factor=5").exitCode,
      0);
  expectRefused(shop, "factors/checkpoint.h5",
                "a state with factors of the viscosity, but no body of the case has a viscosity_factor");
  shop.put("curing.toml",
           replaced(smallCase, "density = 1000",
                    "density = 1000\nstate = [{ name = \"cure\", law = \"expression\", rate = \"1\" }]"));
  EXPECT_THAT(
      shop.call("run curing.toml -o curing --threads 1 --resume whole/checkpoint.h5 --end-time 4e-3").err,
      HasSubstr("a state whose materials have the states none, but those of the case have 'cure'; expected "
                "the case.toml of the run"));
}

TEST(resume, findsMaterialsByTheirNames) {
  Workshop shop;
  const auto material = [](const std::string& name, int viscosity) {
    return fmt::format(
        "[[material]]\nname = \"{}\"\ndensity = 1000\ndynamic_viscosity = {}\n"
        "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n\n",
        name, viscosity);
  };
  const std::string syrup = material("syrup", 10), oil = material("oil", 1);
  const auto put = [&](const std::string& name, const std::string& materials) {
    shop.put(name, replaced(smallCase, syrup.substr(0, syrup.size() - 1), materials));
  };
  put("case.toml", syrup + oil);
  put("turned.toml", oil + syrup);
  const std::string options =
      " --threads 1 --set output.precision=double --end-time 4e-3 --resume half/checkpoint.h5";
  ASSERT_EQ(shop.call("run case.toml -o half --threads 1 --end-time 2e-3").exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o same" + options).exitCode, 0);
  ASSERT_EQ(shop.call("run turned.toml -o turned" + options).exitCode, 0);
  EXPECT_EQ(shop.call("compare same turned --bound 0").exitCode, 0);
  put("case.toml", material("honey", 10) + oil);
  shop.put("case.toml",
           replaced(replaced(shop.content("case.toml"), "material = \"syrup\"", "material = \"honey\""),
                    "material = \"syrup\"", "material = \"honey\""));
  expectRefused(
      shop, "half/checkpoint.h5 --end-time 4e-3",
      "its particles are of the material 'syrup', but the case has 'honey', 'oil'; expected the materials of "
      "the run, in any order");
}

TEST(resume, refusesOtherBodiesAndTakesOtherVelocitiesOfWalls) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml -o half --threads 1 --end-time 3e-3").exitCode, 0);
  ASSERT_EQ(
      shop.call("run case.toml -o faster --threads 1 --resume half/checkpoint.h5 --set 'floor.velocity=[0.06, 0]' "
                "--end-time 5e-3")
          .exitCode,
      0);
  const Checkpoint<2> before = readCheckpoint<2>(shop / "half/checkpoint.h5"),
                      after = readCheckpoint<2>(shop / "faster/checkpoint.h5");
  const std::uint32_t wall = before.particles.fluidCount;
  const std::uint32_t id = before.particles.id[wall];
  const auto place = std::ranges::find(after.particles.id, id) - after.particles.id.begin();
  EXPECT_EQ(after.particles.velocity[place], (Vec<2>{0.06, 0}));
  EXPECT_NEAR(after.particles.position[place][0] - before.particles.position[wall][0], 0.06 * 2e-3, 1e-12);
  shop.put("case.toml", replaced(shop.content("case.toml"), "name = \"column\"", "name = \"pile\""));
  expectRefused(
      shop, "half/checkpoint.h5 --end-time 4e-3",
      "its bodies are 'column', 'floor', but the case has 'pile', 'floor': none of its fluid would be left");
}

/// Of a hundred bytes, the most that they may have.
TEST(resume, findsBodiesWithLongNames) {
  Workshop shop;
  shop.put("case.toml", replaced(smallCase, "\"column\"", '"' + std::string(100, 'c') + '"'));
  ASSERT_EQ(shop.call("run case.toml --threads 1").exitCode, 0);
  EXPECT_EQ(
      shop.call("run case.toml --threads 1 -o rest --end-time 4e-3 --resume case-run/checkpoint.h5").exitCode, 0);
}

/// A rigid body beside the fluid.
const std::string stoneCase = smallCase + R"(
[[body]]
name = "stone"
type = "rigid"
material = "syrup"
shape = "box"
min = [8e-3, 4e-3]
max = [10e-3, 6e-3]
)";

TEST(resume, takesOtherMassesOfRigidBodies) {
  Workshop shop;
  shop.put("case.toml", stoneCase);
  const auto height = [&](const std::string& arguments) {
    const Outcome outcome = shop.call("run case.toml --threads 1 --force " + arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::string rows = shop.content("rest/rigid_bodies.csv");
    return rows.substr(rows.rfind("\n", rows.size() - 2));
  };
  height("-o rest --end-time 6e-3");
  ASSERT_EQ(shop.call("run case.toml --threads 1 --end-time 4e-3 -o part --set 'stone.force=[0.05,0]'").exitCode,
            0);
  const std::string resume = "-o rest --end-time 6e-3 --resume part/checkpoint.h5 --set 'stone.force=[0.05,0]'";
  const std::string same = height(resume), heavier = height(resume + " --set stone.mass=5"),
                    again = height(resume + " --set stone.mass=4e-3");  // of its particles
  EXPECT_NE(heavier, same);
  EXPECT_EQ(again, same);
}

/// Whatever its speed was.
TEST(resume, holdsBodiesUntilALaterRelease) {
  Workshop shop;
  shop.put("case.toml", stoneCase);
  ASSERT_EQ(shop.call("run case.toml --threads 1 --end-time 4e-3 -o part").exitCode, 0);
  const RigidBody falling = readCheckpoint<2>(shop / "part/checkpoint.h5").particles.rigid.bodies[2];
  EXPECT_LT(falling.velocity[1], -0.01);
  const std::string rest = "run case.toml --threads 1 --force -o rest --end-time 8e-3 --resume part/checkpoint.h5";
  const Outcome outcome = shop.call(rest + " --set stone.release=0.1");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("--resume: body 'stone' is held and stands still until its release at t = 0.1 s"));
  const RigidBody held = readCheckpoint<2>(shop / "rest/checkpoint.h5").particles.rigid.bodies[2];
  EXPECT_EQ(held.center, falling.center);
  EXPECT_EQ(held.velocity, Vec<3>{});
  EXPECT_THAT(shop.call(rest + " --set stone.release=1e-3").err, Not(HasSubstr("is held")));
}

TEST(resume, refusesTheStateOfAnotherMethod) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  ASSERT_EQ(shop.call("run case.toml -o whole --threads 1 --end-time 1e-3").exitCode, 0);
  shop.put("case.toml", smallIsphCase);
  expectRefused(shop, "whole/checkpoint.h5", "a state of the method 'mph-i', but that of the case is 'isph'");
}

TEST(resume, takesNoEmptyName) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  const Outcome outcome = shop.call("run case.toml --resume ''");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--resume: expected a name, found \"\""));
}

/// A run that begins with a frame of the run that it would replace.
TEST(resume, refusesToReplaceWhatItBeginsWith) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  ASSERT_EQ(shop.call("run case.toml --threads 1 -o first").exitCode, 0);
  shop.put("second.toml", replaced(smallCase, "shape = \"box\"\nmin = [0, 0]\nmax = [6e-3, 6e-3]",
                                   "shape = \"particles\"\nfile = \"first/frames/fluid_000001.vtp\""));
  const Outcome outcome = shop.call("run second.toml --threads 1 -o first --force");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("fluid_000001.vtp lies in the run directory"));
  EXPECT_EQ(shop.call("run second.toml --threads 1 -o other").exitCode, 0);
}

TEST(resume, refusesToReplaceItsOwnCheckpoint) {
  Workshop shop;
  ASSERT_EQ(withMovingFloor(shop).call("run case.toml --threads 1 --end-time 3e-3").exitCode, 0);
  const Outcome outcome = shop.call("run case.toml --force --resume ./case-run/checkpoint.h5");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("lies in the run directory; choose another one with --output"));
  EXPECT_EQ(readCheckpoint<2>(shop / "case-run/checkpoint.h5").step, 3);
}

TEST(resume, refusesOtherDimensionsMaterialsAndDomains) {
  Workshop shop;
  withMovingFloor(shop);
  const auto put = [&](auto change) {
    Particles<2> p;
    p.resize(36, 64);
    p.forEachField([](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); });
    for (std::uint32_t i = 0; i < p.count; ++i)
      p.position[i] = {{1e-3, 1e-3}}, p.id[i] = i, p.body[i] = i < 36 ? 0 : 1;
    change(p);
    writeCheckpoint<2>(shop / "c.h5", p, 1, 1e-3, MethodKind::MphI);
  };
  put([](Particles<2>& p) { p.material[7] = 1; });
  expectRefused(shop, "c.h5", "particle 7 has material 1, but the case has only 1");
  put([](Particles<2>& p) { p.position[99][1] = 13e-3; });
  expectRefused(shop, "c.h5", "particle 99 lies outside the domain of the case");
  writeCheckpoint<3>(shop / "c.h5", Particles<3>{}, 1, 1e-3, MethodKind::MphI);
  expectRefused(shop, "c.h5", "3 dimensions, expected 2");
}

}  // namespace
}  // namespace treacle::test
