#include "treacle/io/case/case_reader.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <tuple>

#include "command.hpp"

namespace treacle::test {
namespace {

namespace fs = std::filesystem;

Case readBack(const Case& c) {
  Workshop shop;
  shop.put("resolved.toml", caseText(c));
  return readCase(shop / "resolved.toml");
}

std::vector<fs::path> caseFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(TREACLE_CASES))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

TEST(caseFiles, allAreReadAndTheirResolvedTextGivesTheSameCase) {
  const auto files = caseFiles();
  EXPECT_GE(files.size(), 12u);
  for (const fs::path& file : files)
    for (const char* resolution : {"resolution=0.5", "resolution=1", "resolution=3", "resolution=64"}) {
      const std::string overrides[] = {resolution};
      Case c = readCase(file, overrides);
      EXPECT_EQ(std::string("resolution=") + (c.resolution == 0.5 ? "0.5" : std::to_string(int(c.resolution))),
                resolution);
      c.resolution = 1;  // applied
      EXPECT_EQ(readBack(c), c) << file;
    }
}

TEST(caseFiles, textsThatAreNoFilesGiveTheSameCaseAndErrorsWithoutAPlace) {
  const fs::path file = fs::path(TREACLE_CASES) / "dam-break-2d.toml";
  const Case c = readCase(file);
  EXPECT_EQ(readCaseText(caseText(c)), c);
  const std::string overrides[] = {"time.step=auto"};
  EXPECT_TRUE(readCaseText(caseText(c), overrides).time.automatic);
  try {
    readCaseText("dimensions = 2\nspacing = 0");
    FAIL();
  } catch (const CaseFileError& e) {
    EXPECT_EQ(e.place().file, "");
    EXPECT_EQ(e.place().line, 0u);
    EXPECT_EQ(e.key(), "spacing");
    EXPECT_STREQ(e.what(), "spacing in the case file: expected a positive number [m], found 0");
  }
}

TEST(caseFiles, errorsSayWhereTheyAre) {
  Workshop shop;
  shop.put("bad.toml", "dimensions = 2\n  spacing = 0");
  try {
    readCase(shop / "bad.toml");
    FAIL();
  } catch (const CaseFileError& e) {
    EXPECT_EQ(e.place().file, (shop / "bad.toml").string());
    EXPECT_EQ(e.place().line, 2u);
    EXPECT_EQ(e.place().column, 13u);
    EXPECT_EQ(e.key(), "spacing");
  }
}

TEST(caseFiles, stepsMayBeAutomatic) {
  const fs::path file = fs::path(TREACLE_CASES) / "dam-break-2d.toml";
  const std::string open[] = {"time.step=auto", "resolution=4"};
  const Case c = readCase(file, open);
  EXPECT_TRUE(c.time.automatic && c.time.stepsVary());
  EXPECT_EQ(c.time.step, 5e-3) << "not that of the resolution";
  EXPECT_EQ(c.time.least, 5e-7);
  EXPECT_EQ(c.time.tolerance, 0.02);
  const std::string given[] = {"time.step=auto", "time.tolerance=0.1", "time.min_step=1e-5", "time.max_step=2e-3",
                               "time.courant=0.5"};
  Case other = readCase(file, given);
  TimeSettings expected{2e-3, 0.2, 0.5};
  expected.automatic = true, expected.tolerance = 0.1, expected.least = 1e-5;
  EXPECT_EQ(other.time, expected);
  EXPECT_EQ(readBack(other), other);
}

TEST(caseFiles, damBreakIsThatOfThePaper) {  // [K23 Table 1]
  const std::string overrides[] = {"resolution=4"};
  const Case c = readCase(fs::path(TREACLE_CASES) / "published" / "dam-break-2d.toml", overrides);
  EXPECT_EQ(c.spacing, 0.25e-3);
  EXPECT_EQ(c.time, (TimeSettings{0.25e-3, 0.2}));
  EXPECT_EQ(c.steps(), 800);
  EXPECT_EQ(c.gravity, (Vec<3>{0, -10, 0}));
  EXPECT_EQ(c.materials, (std::vector<Material>{{"fluid", 1e3, 10, 1e4, 1e6}}));
  EXPECT_EQ(c.domain, (Domain{{-0.01, -0.01}, {0.04, 0.04}, {true, true, false}}));
  EXPECT_EQ(c.method, defaultMethod(SchemeKind::Published));
  EXPECT_EQ(c.pressureRadius(), 1.75 * 0.25e-3);
  EXPECT_EQ(c.viscosityRadius(), 3.5 * 0.25e-3);
  ASSERT_EQ(c.bodies.size(), 3u);
  EXPECT_EQ(c.bodies[0].shape.max, (Vec<3>{0.02, 0.02, 0}));
}

TEST(caseFiles, publishedOnesDifferFromTheDefaultInTheSchemeAlone) {
  for (const char* name : {"dam-break-2d.toml", "dam-break-3d.toml"}) {
    Case c = readCase(fs::path(TREACLE_CASES) / name);
    EXPECT_EQ(c.method, defaultMethod(SchemeKind::Accurate));
    c.method = defaultMethod(SchemeKind::Published);
    EXPECT_EQ(readCase(fs::path(TREACLE_CASES) / "published" / name), c);
  }
}

TEST(caseFiles, smallCasesScaleGravityAndViscosities) {  // [K23 Table 3]
  const Case base = readCase(fs::path(TREACLE_CASES) / "published" / "dam-break-2d.toml");
  for (const int factor : {2, 4, 8, 16, 32, 64}) {
    const std::string name = "dam-break-2d-d" + std::to_string(factor) + ".toml";
    const Case c = readCase(fs::path(TREACLE_CASES) / "small" / name);
    Case expected = base;
    expected.title = c.title;
    expected.gravity = base.gravity * factor;
    expected.materials[0].dynamicViscosity *= factor;
    expected.materials[0].bulkViscosity *= factor;
    EXPECT_EQ(c, expected) << name;
  }
}

TEST(readCase, takesSixteenMaterialsAndNoMore) {
  std::ifstream file(fs::path(TREACLE_CASES) / "dam-break-2d.toml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto append = [&](int number) {
    text += "\n[[material]]\nname = \"m" + std::to_string(number) +
            "\"\ndensity = 1\ndynamic_viscosity = 1\nbulk_viscosity = 1\nbulk_modulus = 0\n";
  };
  Workshop shop;
  for (int number = 2; number <= 16; ++number) append(number);
  shop.put("sixteen.toml", text);
  EXPECT_EQ(readCase(shop / "sixteen.toml").materials.size(), 16u);
  append(17);
  shop.put("seventeen.toml", text);
  try {
    readCase(shop / "seventeen.toml");
    FAIL() << "seventeen materials were taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most 16, found 17"), std::string::npos) << error.what();
  }
}

const char* const fullCase = R"(
title = "Quotes \" and \\ and\nlines, ümlauts"
dimensions = 3
spacing = 0.3
resolution = 1.5
[domain]
min = [-20, -20, -20]
max = [20, 20, 20]
periodic = [false, true, false]
[gravity]
acceleration = [0.1, "2*t - 9", { times = [0, 1], values = [0, 7] }]
[[material]]
name = "a"
density = 1234.5678901234567
dynamic_viscosity = 0
bulk_viscosity = 1e5
bulk_modulus = 3
[[material]]
name = "b c"
density = 1
dynamic_viscosity = 0.1
bulk_viscosity = 1e-7
bulk_modulus = 0
[[body]]
name = "ball"
type = "fluid"
material = "b c"
shape = "sphere"
center = [1, 2, 3]
radius = 4.1
inner_radius = 0.5
velocity = [1, "-2*sin(2*pi*z)*\t1", 3.5]
where = "x > 0 || y != 1e-3"
subtract = ["rod"]
disorder = 0.2
[[body]]
name = "rod"
type = "wall"
material = "a"
shape = "cylinder"
start = [-9, 0, 0]
end = [-9, 5, 1]
radius = 2
oscillation = { amplitude = [0.1, 0, -2], period = 3, phase = 0.7 }
rotation = { center = [1, 0.3, -2], axis = [0.1, -0.7, 3], speed = -2.5 }
[time]
step = 1e-3
end = 7
courant = 0.3
[method]
scheme = "published"
pressure_radius = 2
density_radius = 2.25
viscosity_radius = 3
viscosity_correction = 0.25
tension_limit = 77
[solver]
krylov = "cg"
preconditioner = "block-jacobi"
operator = "assembled"
precision = "mixed"
first_guess = "linear"
divided_nodes = 77
deflation = 11
tolerance = 1e-10
max_iterations = 77
[solver.multigrid]
finest_sweeps = 1
middle_sweeps = 5
coarsest_sweeps = 6
particle_diagonal = "extended-jacobi"
coarse_operators = "spgemm"
[solver.projected]
pressure_degree = 7
grid_degree = 3
velocity_degree = 1
iteration_bound = 55
[output]
interval = 0.25
checkpoint_interval = 0.5
fields = ["id", "pressure", "body"]
precision = "double"
compression = "none"
pieces = "each"
balance = true
[watch]
energy = 3
courant = 4
inside_walls = 0.1
density = 0
)";

TEST(readCase, takesEveryKey) {
  Workshop shop;
  shop.put("full.toml", fullCase);
  Case c = readCase(shop / "full.toml");

  Case expected;
  expected.title = "Quotes \" and \\ and\nlines, ümlauts";
  expected.dimensions = 3;
  expected.spacing = 0.3 / 1.5;
  expected.resolution = 1.5;
  expected.domain = {{-20, -20, -20}, {20, 20, 20}, {false, true, false}};
  expected.gravityInTime[1] = TimeFunction{.expression = "2*t - 9"};
  expected.gravityInTime[2] = TimeFunction{.times = {0, 1}, .values = {0, 7}};
  expected.gravity = {0.1, 0, 0};
  expected.gravity = expected.meanGravity(0, 7);
  expected.materials = {{"a", 1234.5678901234567, 0, 1e5, 3}, {"b c", 1, 0.1, 1e-7, 0}};
  Shape ball, rod;
  ball.kind = ShapeKind::Sphere, ball.center = {1, 2, 3}, ball.radius = 4.1, ball.innerRadius = 0.5;
  rod.kind = ShapeKind::Cylinder, rod.start = {-9, 0, 0}, rod.end = {-9, 5, 1}, rod.radius = 2;
  expected.bodies = {{"ball", BodyKind::Fluid, 1, {1, 0, 3.5}, ball},
                     {"rod", BodyKind::Wall, 0, {}, rod, {{0.1, 0, -2}, 3, 0.7}}};
  expected.bodies[0].velocityExpression[1] = "-2*sin(2*pi*z)*\t1";
  expected.bodies[1].rotation = Rotation{{1, 0.3, -2}, {0.1, -0.7, 3}, -2.5};
  expected.bodies[0].where = "x > 0 || y != 1e-3";
  expected.bodies[0].subtract = {"rod"};
  expected.bodies[0].disorder = 0.2;
  expected.time = {1e-3 / 1.5, 7, 0.3};
  expected.method.scheme = SchemeKind::Published;
  expected.method.pressureRadius = 2, expected.method.densityRadius = 2.25, expected.method.viscosityRadius = 3;
  expected.method.viscosityCorrection = 0.25;
  expected.method.tensionLimit = 77;
  expected.solver.krylov = KrylovKind::Cg;
  expected.solver.preconditioner = PreconditionerKind::BlockJacobi;
  expected.solver.operatorKind = OperatorKind::Assembled;
  expected.solver.precision = Precision::Mixed;
  expected.solver.firstGuess = FirstGuess::Linear;
  expected.solver.deflation = 11;
  expected.solver.tolerance = 1e-10;
  expected.solver.maxIterations = 77;
  expected.solver.dividedNodes = 77;
  expected.solver.multigrid = {1, 5, 6, SmootherDiagonal::ExtendedJacobi, CoarseKind::Spgemm};
  expected.solver.projected = {7, 3, 1, 55};
  expected.output = {0.25,
                     0.5,
                     {false, true, false, false, false, true, true, false, false, false, false},
                     OutputPrecision::Double,
                     OutputCompression::None,
                     OutputPieces::Each,
                     false,
                     true};
  expected.watch = {3, 4, 0.1, 0};
  EXPECT_EQ(c, expected);

  c.resolution = 1;
  EXPECT_EQ(readBack(c), c);
}

TEST(readCase, takesRangesWithTheMatrixFreeOperator) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  const std::string overrides[] = {"solver.preconditioner=bucket-multigrid", "solver.neighbours=ranges",
                                   "solver.multigrid.coarse_operators=direct"};
  Case expected = readCase(shop / "case.toml");
  expected.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  expected.solver.krylov = KrylovKind::Cr;
  expected.solver.precision = Precision::Double;
  expected.solver.neighbours = NeighbourKind::Ranges;
  expected.solver.multigrid.coarseOperators = CoarseKind::Direct;
  const Case c = readCase(shop / "case.toml", overrides);
  EXPECT_EQ(c, expected);
  EXPECT_EQ(readBack(c), c);
}

TEST(readCase, krylovMethodAndPrecisionFollowFromThePreconditionerUnlessGiven) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  const auto solverOf = [&](const std::vector<std::string>& overrides) {
    const SolverSettings s = readCase(shop / "case.toml", overrides).solver;
    return std::tuple(s.preconditioner, s.krylov, s.precision);
  };
  using enum PreconditionerKind;
  EXPECT_EQ(solverOf({}), std::tuple(ProjectedMultigrid, KrylovKind::Cg, Precision::Mixed));
  EXPECT_EQ(solverOf({"solver.krylov=cr", "solver.precision=double"}),
            std::tuple(ProjectedMultigrid, KrylovKind::Cr, Precision::Double));
  EXPECT_EQ(solverOf({"solver.preconditioner=jacobi"}), std::tuple(Jacobi, KrylovKind::Cr, Precision::Double));
  EXPECT_EQ(solverOf({"solver.preconditioner=bucket-multigrid", "solver.krylov=cg", "solver.precision=mixed"}),
            std::tuple(BucketMultigrid, KrylovKind::Cg, Precision::Mixed));
}

TEST(readCase, weightsAndRadiiFollowFromTheSchemeUnlessGiven) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  const auto methodOf = [&](const std::vector<std::string>& overrides) {
    return readCase(shop / "case.toml", overrides).method;
  };
  EXPECT_EQ(methodOf({}), defaultMethod(SchemeKind::Accurate));
  EXPECT_EQ(methodOf({"method.scheme=accurate"}), defaultMethod(SchemeKind::Accurate));
  EXPECT_EQ(methodOf({"method.scheme=published"}), defaultMethod(SchemeKind::Published));
  MethodSettings wide = defaultMethod(SchemeKind::Published);
  wide.pressureRadius = 2.5;
  EXPECT_EQ(methodOf({"method.pressure_radius=2.5", "method.scheme=published"}), wide);
}

/// One more material, at the end of a case.
const std::string water = R"(
[[material]]
name = "water"
density = 998
dynamic_viscosity = 1e-3
bulk_viscosity = 1
bulk_modulus = 1
)";

TEST(readCase, mergesOntoItsBase) {
  Workshop shop;
  shop.put("cases/base.toml", smallCase);
  shop.put("cases/middle.toml", "base = \"base.toml\"\n[time]\nend = 3e-3\n[output]\nfields = [\"id\"]\n");
  shop.put("derived.toml", R"(base = "cases/middle.toml"
[output]
fields = ["velocity"]
[[body]]
name = "floor"
material = "water"
[[material]]
name = "syrup"
density = 1500
)" + water);
  const Case base = readCase(shop / "cases/base.toml"), c = readCase(shop / "derived.toml");
  Case expected = base;
  expected.time.end = 3e-3;
  expected.output.fields = {true, false, false, false, false, false, false, false, false, false, false};
  expected.materials[0].density = 1500;
  expected.materials.push_back({"water", 998, 1e-3, 1, 1});
  expected.bodies[1].material = 1;
  EXPECT_EQ(c, expected);
}

TEST(readCase, mergesContactAnglesByTheirFluid) {
  Workshop shop;
  shop.put("base.toml", std::string(smallCase) + water +
                            R"(contact_angles = [{name = "syrup", angle = 40}, {name = "water", angle = 70}]
)");
  shop.put("derived.toml", R"(base = "base.toml"
[[material]]
name = "water"
contact_angles = [{name = "water", angle = 110}, {name = "oil", angle = 20}]
[[material]]
name = "oil"
density = 900
dynamic_viscosity = 1
bulk_viscosity = 1
bulk_modulus = 1
)");
  const Case base = readCase(shop / "base.toml"), c = readCase(shop / "derived.toml");
  Case expected = base;
  expected.materials[1].contactAngles = {{"syrup", 40}, {"water", 110}, {"oil", 20}};
  expected.materials.push_back({"oil", 900, 1, 1, 1});
  EXPECT_EQ(c, expected);
}

TEST(caseText, holdsContactAngles) {
  Workshop shop;
  shop.put("case.toml", std::string(smallCase) + water + "contact_angles = [{name = \"syrup\", angle = 40}]\n");
  const std::string two[] = {R"(water.contact_angles=[{name="water", angle=70}])"},
                    none[] = {"water.contact_angles=[]"},
                    twice[] = {R"(water.contact_angles=[{name="water", angle=70}, {name="water", angle=80}])"};
  Case c = readCase(shop / "case.toml", two);
  const std::vector<ContactAngle> both{{"syrup", 40}, {"water", 70}};
  EXPECT_EQ(c.materials[1].contactAngles, both);
  EXPECT_EQ(readCaseText(caseText(c)), c) << caseText(c);
  c.materials[1].contactAngles.clear();
  EXPECT_EQ(readCase(shop / "case.toml", none), c);
  EXPECT_EQ(readCaseText(caseText(c)), c);
  EXPECT_NE(messageOf<InputError>([&] {
              readCase(shop / "case.toml", twice);
            }).find("two [[contact_angles]] are named 'water'"),
            std::string::npos);
}

TEST(readCase, overridesComeOnTop) {
  Workshop shop;
  shop.put("case.toml", smallCase);
  const Case base = readCase(shop / "case.toml");
  const std::string overrides[] = {"syrup.density=2e3",
                                   "material.syrup.dynamic_viscosity = 5",
                                   "title=A new title",
                                   "body.column.velocity=[1, 0]",
                                   "solver.krylov=cg",
                                   "solver.multigrid.finest_sweeps=7",
                                   "domain.periodic=true",
                                   "syrup.density=3e3",
                                   "body.\"floor\".velocity=[0,1]"};
  Case expected = base;
  expected.materials[0].density = 3e3;
  expected.materials[0].dynamicViscosity = 5;
  expected.title = "A new title";
  expected.bodies[0].velocity = {1, 0, 0};
  expected.bodies[1].velocity = {0, 1, 0};
  expected.solver.krylov = KrylovKind::Cg;
  expected.solver.multigrid.finestSweeps = 7;
  expected.domain.periodic = {true, true, false};
  EXPECT_EQ(readCase(shop / "case.toml", overrides), expected);
}

TEST(readCase, nameOfMaterialAndBodyNeedsTheList) {
  Workshop shop;
  shop.put("case.toml", replaced(smallCase, "name = \"column\"", "name = \"syrup\""));
  const std::string ambiguous[] = {"syrup.density=1"}, clear[] = {"material.syrup.density=1"};
  EXPECT_THAT(
      messageOf<std::runtime_error>([&] { readCase(shop / "case.toml", ambiguous); }),
      testing::HasSubstr("'syrup' is the name of a material and a body; write material.syrup or body.syrup"));
  EXPECT_THROW(readCase(shop / "case.toml", ambiguous), std::runtime_error);
  EXPECT_EQ(readCase(shop / "case.toml", clear).materials[0].density, 1);
}

}  // namespace
}  // namespace treacle::test
