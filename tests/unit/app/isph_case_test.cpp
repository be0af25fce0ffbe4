#include "treacle/io/case/case_reader.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "command.hpp"

namespace treacle::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Case shippedCase(const char* name, std::vector<std::string> overrides = {}) {
  return readCase(fs::path(TREACLE_CASES) / name, overrides);
}

/// Counts of the bodies, without a word of warning.
std::vector<std::uint32_t> countsOf(const Case& c) {
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  c.dimensions == 2 ? void(createParticles<2>(c, notes, &counts)) : void(createParticles<3>(c, notes, &counts));
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  std::vector<std::uint32_t> all;
  for (const BodyCount& body : counts) all.push_back(body.all());
  return all;
}

Case readText(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Workshop shop;
  shop.put("case.toml", text);
  return readCase(shop / "case.toml", overrides);
}

std::string messageFor(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    readText(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(isphCases, damBreakIsThatOfThePaper) {  // [O23 Table 1]
  const Case c = shippedCase("isph-dam-break.toml");
  EXPECT_EQ(c.spacing, 1);
  EXPECT_EQ(c.steps(), 4000);
  EXPECT_EQ(c.method.isph.alpha, 0.01);
  EXPECT_EQ(c.materials, (std::vector<Material>{{"water", 1e3, 1e-3, 0, 0}}));
  EXPECT_EQ(countsOf(c)[0], 58621u);
}

TEST(isphCases, widthOfTheDamBreakIsAFactor) {
  const Case one = shippedCase("isph-dam-break.toml"),
             four = shippedCase("isph-dam-break.toml", {"width.factor=4"});
  EXPECT_EQ(countsOf(four)[0], 4 * 58621u);
  const auto body = [](const Case& c, const char* name) {
    for (const Body& b : c.bodies)
      if (b.name == name) return b.shape;
    return Shape{};
  };
  EXPECT_EQ(body(four, "right side"), body(one, "right side"));
  EXPECT_EQ(body(four, "left side").min, (Vec<3>{0, 124, 0}));
  EXPECT_EQ(body(four, "left side").max, (Vec<3>{153, 127, 62}));
  EXPECT_EQ(body(four, "floor").max, (Vec<3>{156, 127, 0}));
  EXPECT_EQ(four.domain.min, one.domain.min);
  EXPECT_EQ(four.domain.max, (Vec<3>{159, 130, 68}));
  EXPECT_THAT(caseText(four), Not(HasSubstr("width")));
  EXPECT_EQ(readText(caseText(four)), four);
}

TEST(isphCases, thoseInTwoDimensionsDivideAtHalfAndHigherResolutions) {
  for (const char* name :
       {"isph-dam-break-2d.toml", "isph-floating-block-2d.toml", "isph-hydrostatic.toml", "isph-sloshing.toml"})
    for (const char* resolution : {"resolution=0.5", "resolution=1", "resolution=2"}) {
      SCOPED_TRACE(testing::Message() << name << ", " << resolution);
      countsOf(shippedCase(name, {resolution}));
    }
  EXPECT_EQ(countsOf(shippedCase("isph-dam-break-2d.toml"))[0], 40u * 80);
  EXPECT_EQ(countsOf(shippedCase("isph-floating-block-2d.toml"))[1], 80u * 50 - 20 * 10);
  EXPECT_EQ(countsOf(shippedCase("isph-hydrostatic.toml"))[0], 50u * 50);
  EXPECT_EQ(countsOf(shippedCase("isph-sloshing.toml"))[0], 90u * 30);
}

TEST(isphCases, sloshingStartsAtRestWithThePeriodOfItsFirstMode) {
  const Case c = shippedCase("isph-sloshing.toml");
  const Vec<3> extent = c.bodies[0].shape.max;
  const double k = std::numbers::pi / extent[0];
  const double period = 2 * std::numbers::pi / std::sqrt(9.81 * k * std::tanh(k * extent[1]));
  for (const Body& body : c.bodies) {
    if (body.kind == BodyKind::Fluid) continue;
    EXPECT_NEAR(body.oscillation.period, period, 1e-3 * period);
    EXPECT_NEAR(std::cos(body.oscillation.phase), 0, 1e-15);
    EXPECT_EQ(body.oscillation, c.bodies[1].oscillation);
  }
}

TEST(readIsph, takesEveryKey) {
  const std::string text = smallIsphCase + R"([solver]
krylov = "cr"
preconditioner = "cell-multigrid"
precision = "double"
first_guess = "last"
tolerance = 1e-9
max_iterations = 66
[solver.cells]
levels = 3
sweeps = 2
[solver.hats]
grid_degree = 5
iteration_bound = 44
)";
  Case expected = readText(smallIsphCase);
  expected.method.isph = {KernelKind::WendlandC2, 1.5,  0.2, WallSlip::FreeSlip,
                          ViscousStep::Implicit,  0.12, 0.3, true};
  expected.solver.krylov = KrylovKind::Cr;
  expected.solver.preconditioner = PreconditionerKind::CellMultigrid;
  expected.solver.precision = Precision::Double;
  expected.solver.tolerance = 1e-9;
  expected.solver.maxIterations = 66;
  expected.solver.cells = {3, 2};
  expected.solver.hats = {5, 44};
  const Case c =
      readText(replaced(text, "name = \"isph\"\n",
                        "name = \"isph\"\nkernel = \"wendland-c2\"\nsmoothing_ratio = 1.5\nalpha = 0.2\n"
                        "walls = \"free-slip\"\nviscosity = \"implicit\"\nsmagorinsky = 0.12\nshifting = 0.3\n"
                        "negative_pressure = true\n"));
  EXPECT_EQ(c, expected);
  EXPECT_EQ(readText(caseText(c)), c);
}

TEST(readIsph, defaultsAreThoseOfTheMethod) {
  const Case c = readText(smallIsphCase);
  EXPECT_EQ(c.method.kind, MethodKind::Isph);
  EXPECT_EQ(c.method.isph, IsphSettings{});
  EXPECT_EQ(c.solver.krylov, KrylovKind::Cg);
  EXPECT_EQ(c.solver.preconditioner, PreconditionerKind::HatMultigrid);
  EXPECT_EQ(c.solver.precision, Precision::Mixed);
  EXPECT_EQ(c.solver.firstGuess, FirstGuess::Last);
  EXPECT_EQ(c.solver.tolerance, 1e-12);
  EXPECT_EQ(readText(caseText(c)), c);
  // They do not depend on the preconditioner.
  EXPECT_EQ(readText(smallIsphCase, {"solver.preconditioner=jacobi"}).solver.krylov, KrylovKind::Cg);
}

TEST(readIsph, fluidsMayHaveNoViscosity) {
  EXPECT_EQ(readText(smallIsphCase, {"syrup.dynamic_viscosity=0"}).materials[0].dynamicViscosity, 0);
}

TEST(readIsph, turbulenceNeedsAViscosity) {
  EXPECT_THAT(messageFor(smallIsphCase, {"syrup.dynamic_viscosity=0", "method.smagorinsky=0.12"}),
              HasSubstr("found 0 with smagorinsky in [method] above 0: the law of the wall needs a viscosity"));
}

TEST(readIsph, resolvedTextHoldsNoKeyOfMph) {
  const std::string text = caseText(readText(smallIsphCase));
  for (const char* key :
       {"bulk_", "_radius", "operator", "neighbours", "[solver.multigrid]", "[solver.projected]"})
    EXPECT_THAT(text, Not(HasSubstr(key)));
  const std::string mph = caseText(readText(smallCase));
  for (const char* key : {"kernel", "alpha", "[solver.cells]", "[solver.hats]"})
    EXPECT_THAT(mph, Not(HasSubstr(key)));
}

TEST(readIsph, periodicAxesHoldThreeCellsOfTheKernelsReach) {
  const std::vector<std::string> periodic{"domain.periodic=true"};
  // 16 mm: enough for 3 x 4.8 mm, not for 3 x 5.4 mm.
  EXPECT_EQ(messageFor(smallIsphCase, {"domain.periodic=true", "spacing=2e-3"}), "no error");
  EXPECT_THAT(messageFor(smallIsphCase, {"domain.periodic=true", "spacing=2e-3", "method.smoothing_ratio=1.35"}),
              HasSubstr("3 search cells of edge 2 h = 5.4 mm: expected at least 16.2 mm"));
}

TEST(readCase, takesCourantNumberAndStepsLongerThanTheRun) {
  const Case c = readText(smallCase, {"time.courant=0.3", "time.step=1", "time.end=0.1"});
  EXPECT_EQ(c.time, (TimeSettings{1, 0.1, 0.3}));
}

TEST(readCase, takes255BodiesAndNoMore) {
  std::string text = smallCase;
  const auto append = [&](int number) {
    text += "\n[[body]]\nname = \"b" + std::to_string(number) +
            "\"\ntype = \"fluid\"\nmaterial = \"syrup\"\nshape = \"box\"\nmin = [0, 0]\nmax = [1e-3, 1e-3]\n";
  };
  for (int number = 3; number <= 255; ++number) append(number);
  EXPECT_EQ(readText(text).bodies.size(), 255u);
  append(256);
  EXPECT_THAT(messageFor(text), HasSubstr("body in the case file: expected at most 255, found 256"));
}

TEST(width, movesWhatIsBeyondAndScalesWhatIsBetween) {
  const std::string text = replaced(smallCase, "[time]", R"([[body]]
name = "drop"
type = "fluid"
material = "syrup"
shape = "sphere"
center = [9e-3, 3e-3]
radius = 1e-3

[[body]]
name = "rod"
type = "fluid"
material = "syrup"
shape = "cylinder"
start = [-1e-3, 8e-3]
end = [3e-3, 8e-3]
radius = 1e-3

[width]
axis = "x"
from = 0
to = 6e-3

[time])");
  const Case one = readText(text), two = readText(text, {"width.factor=2"});
  EXPECT_EQ(readText(text, {"width.factor=1"}), one);
  Case expected = one;
  expected.domain.max[0] = 18e-3;
  expected.bodies[0].shape.max[0] = 12e-3;
  expected.bodies[1].shape.max[0] = 18e-3;
  expected.bodies[2].shape.center[0] = 15e-3;
  expected.bodies[3].shape.end[0] = 6e-3;
  const auto expectNear = [](const Vec<3>& a, const Vec<3>& b) { EXPECT_LE(norm(a - b), 1e-15); };
  expectNear(two.domain.min, expected.domain.min);
  expectNear(two.domain.max, expected.domain.max);
  for (std::size_t b = 0; b < 4; ++b)
    for (Vec<3> Shape::*x : {&Shape::min, &Shape::max, &Shape::center, &Shape::start, &Shape::end})
      expectNear(two.bodies[b].shape.*x, expected.bodies[b].shape.*x);
  EXPECT_EQ(two.bodies[2].shape.radius, 1e-3);
  const Case turning = readText(text, {"width.factor=2", "body.floor.rotation={center = [7e-3, 0], speed = 1}",
                                       "body.column.where=x < 3e-3"});
  expectNear(turning.bodies[1].rotation->center, {13e-3, 0, 0});
  EXPECT_EQ(turning.bodies[0].where, "x < 3e-3") << "expressions are not scaled";
  // The shape that a radius gives is not stretched; a smaller width is one, too.
  EXPECT_NEAR(readText(text, {"width.factor=0.5"}).bodies[0].shape.max[0], 3e-3, 1e-15);
}

}  // namespace
}  // namespace treacle::test
