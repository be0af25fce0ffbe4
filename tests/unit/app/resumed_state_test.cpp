#include "resume.hpp"

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "command.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;

/// A checkpoint of the small case, its particles in an order that is not that of their ids.
struct Resumed {
  Workshop shop;
  Case c;
  MadeParticles made;
  Particles<2> saved;
  MethodKind method = MethodKind::MphI;

  Resumed() {
    shop.put("case.toml", smallCase);
    c = readCase(shop / "case.toml");
    std::vector<std::string> notes;
    made = MadeParticles::of(c, notes);
    saved = createParticles<2>(c, notes);
    forEachFluidFieldOf(
        [](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); }, saved);
    std::reverse(saved.id.begin(), saved.id.begin() + saved.fluidCount);
    std::reverse(saved.id.begin() + saved.fluidCount, saved.id.end());
  }

  StartState state(std::int64_t step, double time) {
    writeCheckpoint<2>(shop / "c.h5", saved, step, time, method);
    return resumedState(c, shop / "c.h5", made);
  }

  std::string message(std::int64_t step, double time) {
    return messageOf<InputError>([&] { state(step, time); });
  }
};

TEST(resumedState, takesStepAndTimeFromTheFileWhereStepsVary) {
  Resumed r;
  EXPECT_EQ(r.state(77, 1e-3).step, 1);
  EXPECT_THAT(r.message(77, 1.234e-3), HasSubstr("is not a whole number of steps"));
  r.c.time.courant = 0.2;
  const StartState state = r.state(77, 1.234e-3);
  EXPECT_EQ(state.step, 77);
  EXPECT_EQ(state.time, 1.234e-3);
  EXPECT_THAT(r.message(1, 2e-3), HasSubstr("its time 0.002 s is not before the end of the run"));
}

TEST(resumedState, refusesTimesThatNoNumberOfStepsReaches) {
  Resumed r;
  EXPECT_THAT(r.message(1, 1e300), HasSubstr("its time 1e+300 s is more steps of 0.001 s than can be counted"));
  r.c.time.courant = 0.2;
  EXPECT_THAT(r.message(1, 1e300), HasSubstr("its time 1e+300 s is not before the end of the run"));
}

TEST(resumedState, refusesTheStateOfAnotherMethod) {
  Resumed r;
  r.method = MethodKind::Isph;
  EXPECT_THAT(r.message(1, 1e-3),
              HasSubstr("c.h5: a state of the method 'isph', but that of the case is 'mph-i'"));
}

/// Of several processes each takes a part, with the surfaces of its walls.
TEST(resumedState, takesAPart) {
  Resumed r;
  const StartState all = r.state(1, 1e-3);
  const Particles<2>& whole = all.particles.of<2>();
  std::vector<std::uint32_t> place(whole.count);
  for (std::uint32_t i = 0; i < whole.count; ++i) place[whole.id[i]] = i;
  std::vector<int> taken(whole.count);
  for (std::uint32_t k = 0; k < 3; ++k) {
    std::vector<std::string> notes;
    r.made = MadeParticles::of(r.c, notes, {k, 3});
    const StartState state = r.state(1, 1e-3);
    const Particles<2>& p = state.particles.of<2>();
    EXPECT_EQ(p.wallSurface.size(), whole.wallSurface.empty() ? 0 : p.wallCount());
    for (std::uint32_t i = 0; i < p.count; ++i) {
      const std::uint32_t j = place[p.id[i]];
      ++taken[j];
      EXPECT_EQ(i < p.fluidCount, j < whole.fluidCount);
      EXPECT_EQ(p.position[i], whole.position[j]);
      EXPECT_EQ(p.body[i], whole.body[j]);
      if (i >= p.fluidCount && !p.wallSurface.empty()) {
        EXPECT_EQ(p.wallSurface[i - p.fluidCount], whole.wallSurface[j - whole.fluidCount]);
      }
    }
  }
  EXPECT_THAT(taken, testing::Each(1));
}

TEST(resumedState, refusesBodiesThatTheCaseDoesNotHave) {
  Resumed r;
  r.saved.body[3] = 2;
  EXPECT_THAT(r.message(1, 1e-3), HasSubstr("belongs to body 2, which is no fluid body of the case"));
  r.saved.body[3] = 0;
  r.saved.body[r.saved.fluidCount] = 0;
  EXPECT_THAT(r.message(1, 1e-3), HasSubstr("belongs to body 0, which is no wall body of the case"));
}

/// A run of the small case up to 2 ms.
struct Interrupted {
  Workshop shop;

  Interrupted() {
    shop.put("small.toml", smallCase);
    EXPECT_EQ(shop.call("run small.toml -o first" + options).exitCode, 0);
  }
  Outcome resume(const std::string& text, const std::string& more = " --end-time 0.004") {
    shop.put("next.toml", text);
    return shop.call("run next.toml -o next --force --resume first/checkpoint.h5" + options + more);
  }
  Checkpoint<2> state(const char* directory) { return readCheckpoint<2>(shop / directory / "checkpoint.h5"); }

  const std::string options = " --backend cpu --threads 1";
};

std::string bodyText(const char* name, const char* type, const char* min, const char* max) {
  return fmt::format(
      "\n[[body]]\nname = \"{}\"\ntype = \"{}\"\nmaterial = \"syrup\"\nshape = \"box\"\nmin = {}\nmax = {}\n",
      name, type, min, max);
}

const std::string post = bodyText("post", "wall", "[9e-3, 0]", "[12e-3, 5e-3]");
const std::string drop = bodyText("drop", "fluid", "[1e-3, 8e-3]", "[4e-3, 10e-3]") + "velocity = [0, -0.1]\n";

/// What was there before goes on as it was, and what is added is there.
TEST(ResumedState, AddsBodies) {
  Interrupted run;
  const Outcome outcome = run.resume(smallCase + post + drop);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("--resume: body 'post' is added"));
  EXPECT_THAT(outcome.err, HasSubstr("--resume: body 'drop' is added"));
  const Checkpoint<2> before = run.state("first"), after = run.state("next");
  EXPECT_EQ(after.particles.fluidCount, before.particles.fluidCount + 6);
  EXPECT_EQ(after.particles.wallCount(), before.particles.wallCount() + 15);
  EXPECT_EQ(after.time, 4e-3);
  int drops = 0;
  for (std::uint32_t i = 0; i < after.particles.fluidCount; ++i)
    if (after.particles.body[i] == 3) {
      ++drops;
      EXPECT_LT(after.particles.velocity[i][1], -0.02);
    }
  EXPECT_EQ(drops, 6);
}

TEST(ResumedState, AddsAndLeavesOut) {
  Interrupted run;
  ASSERT_EQ(run.resume(smallCase + post + drop).exitCode, 0);
  std::filesystem::rename(run.shop / "next", run.shop / "first2");
  std::filesystem::remove_all(run.shop / "first");
  std::filesystem::rename(run.shop / "first2", run.shop / "first");
  const Outcome outcome = run.resume(smallCase + drop, " --end-time 0.006");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("--resume: body 'post' of the run is left out"));
  const Checkpoint<2> before = run.state("first"), after = run.state("next");
  EXPECT_EQ(after.particles.fluidCount, before.particles.fluidCount);
  EXPECT_EQ(after.particles.wallCount(), before.particles.wallCount() - 15);
  // Bodies have the numbers of the case.
  EXPECT_EQ(std::ranges::count(after.particles.body, 2), 6);
}

/// A rigid body that is put in falls; without it all goes on.
TEST(ResumedState, AddsRigidBodies) {
  Interrupted run;
  const std::string above = bodyText("block", "rigid", "[9e-3, 4e-3]", "[12e-3, 8e-3]");
  const Outcome outcome = run.resume(smallCase + above);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Checkpoint<2> after = run.state("next");
  ASSERT_EQ(after.particles.rigid.bodies.size(), 3u);
  EXPECT_NEAR(after.particles.rigid.bodies[2].mass, 12e-3, 1e-9);
  EXPECT_NEAR(after.particles.rigid.bodies[2].velocity[1], -10 * 2e-3, 6e-3);
}

TEST(ResumedState, SaysWhichBodiesDoNotFit) {
  Interrupted run;
  const auto message = [&](const std::string& text) {
    const Outcome outcome = run.resume(text);
    EXPECT_EQ(outcome.exitCode, 2);
    return outcome.err;
  };
  // What shape the fluid has had in the case does not matter: it is where the run has left it.
  const std::string elsewhere =
      replaced(smallCase, "min = [0, 0]\nmax = [6e-3, 6e-3]", "min = [0, 8e-3]\nmax = [6e-3, 9e-3]");
  EXPECT_THAT(message(elsewhere + replaced(post, "9e-3, 0]", "5e-3, 0]")),
              HasSubstr("body 'post' is added where fluid of the run is, at ("));
  const std::string wider = replaced(smallCase, "max = [12e-3, 0]", "max = [11e-3, 0]");
  EXPECT_THAT(message(wider + post),
              HasSubstr("body 'floor' has 64 wall particles in the run and 60 in the case"));
}

}  // namespace
}  // namespace treacle::test
