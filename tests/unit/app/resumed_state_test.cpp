#include "resume.hpp"

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace treacle::test
