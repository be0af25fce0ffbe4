#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "unit/app/command.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A case with every shape and motion.
const std::string bodies = R"(
[[body]]
name = "drop"
type = "fluid"
material = "syrup"
shape = "sphere"
center = [9e-3, 6e-3]
radius = 1e-3

[[body]]
name = "left rod"
type = "wall"
material = "syrup"
shape = "cylinder"
start = [-3e-3, 9e-3]
end = [-1e-3, 9e-3]
radius = 1e-3
oscillation = { amplitude = [1e-5, 0], period = 1 }
rotation = { center = [0, 9e-3], speed = 1 }

[[body]]
name = "wedge"
type = "wall"
material = "syrup"
shape = "cone"
start = [6e-3, 9e-3]
end = [8e-3, 9e-3]
start_radius = 1e-3
end_radius = 5e-4

[[body]]
name = "outline"
type = "wall"
material = "syrup"
shape = "polygon"
points = [[3e-3, 8e-3], [5e-3, 8e-3], [4e-3, 9e-3]]
transform = { angle = 1 }
)";

Case goodCase(MethodKind method, const std::vector<std::string>& overrides = {}) {
  Workshop shop;
  shop.put("case.toml", (method == MethodKind::Isph ? smallIsphCase : smallCase) + bodies);
  return readCase(shop / "case.toml", overrides);
}

/// The same mistake made in code and in a file.
struct Mistake {
  const char* name;
  MethodKind method;
  std::function<void(Case&)> inCode;
  std::vector<std::string> inFile;  // as given to --set
  CasePath path;
  const char* table;  // what messages for files call it
  const char* text;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, haveTheSameTextInCodeAndInAFile) {
  const Mistake& mistake = GetParam();
  Case c = goodCase(mistake.method);
  EXPECT_NO_THROW(requireValid(c));
  mistake.inCode(c);
  try {
    requireValid(c);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const CaseError& error) {
    EXPECT_EQ(error.path(), mistake.path);
    EXPECT_EQ(error.text(), mistake.text);
    EXPECT_THAT(error.what(), EndsWith(std::string(": ") + mistake.text));
  }
  const std::string message = messageOf<InputError>([&] { goodCase(mistake.method, mistake.inFile); });
  EXPECT_THAT(message, EndsWith(": " + mistake.path.back() + " in " + mistake.table + ": " + mistake.text));
}

constexpr MethodKind mph = MethodKind::MphI, isph = MethodKind::Isph;

const Mistake mistakes[] = {
    {"dimensions",
     mph,
     [](Case& c) { c.dimensions = 4; },
     {"dimensions=4"},
     {"dimensions"},
     "the case file",
     "expected 2 or 3, found 4"},
    {"spacing",
     mph,
     [](Case& c) { c.spacing = 0; },
     {"spacing=0"},
     {"spacing"},
     "the case file",
     "expected a positive number [m], found 0"},
    {"resolution",
     mph,
     [](Case& c) { c.resolution = -1; },
     {"resolution=-1"},
     {"resolution"},
     "the case file",
     "expected a positive number, found -1"},
    {"corner",
     mph,
     [](Case& c) { c.domain.min[1] = -infinity; },
     {"domain.min=[-4e-3, -inf]"},
     {"domain", "min"},
     "[domain]",
     "expected an array of 2 finite numbers [m], found -inf"},
    {"corners",
     mph,
     [](Case& c) { c.domain.max[0] = -4e-3; },
     {"domain.max=[-4e-3, 12e-3]"},
     {"domain", "max"},
     "[domain]",
     "expected more than min on every axis, found -0.004 <= -0.004 along x"},
    {"period",
     mph,
     [](Case& c) { c.domain.max[0] = 6e-3, c.domain.periodic[0] = true; },
     {"domain.max=[6e-3, 12e-3]", "domain.periodic=[true, false]"},
     {"domain", "periodic"},
     "[domain]",
     "the domain is 10 mm long along x; a periodic axis must hold 3 search cells of edge max(h_v, h_n, 2 h_p) "
     "= 5 mm: expected at least 15 mm"},
    {"periodOfIsph",
     isph,
     [](Case& c) { c.method.isph.smoothingRatio = 2, c.domain.max[1] = 6e-3, c.domain.periodic[1] = true; },
     {"method.smoothing_ratio=2", "domain.max=[12e-3, 6e-3]", "domain.periodic=[false, true]"},
     {"domain", "periodic"},
     "[domain]",
     "the domain is 10 mm long along y; a periodic axis must hold 3 search cells of edge 2 h = 4 mm: expected at "
     "least 12 mm"},
    {"gravity",
     mph,
     [](Case& c) { c.gravity[0] = infinity; },
     {"gravity.acceleration=[inf, -10]"},
     {"gravity", "acceleration"},
     "[gravity]",
     "expected a finite number [m/s2], an expression in t [s] or {times = [...], values = [...]}, found inf"},
    {"density",
     mph,
     [](Case& c) { c.materials[0].density = 0; },
     {"syrup.density=0"},
     {"material", "syrup", "density"},
     "[[material]] 'syrup'",
     "expected a positive number [kg/m3], found 0"},
    {"viscosity",
     isph,
     [](Case& c) { c.materials[0].dynamicViscosity = -2.5; },
     {"syrup.dynamic_viscosity=-2.5"},
     {"material", "syrup", "dynamic_viscosity"},
     "[[material]] 'syrup'",
     "expected a number not less than 0 [Pa s], found -2.5"},
    {"bulkModulus",
     mph,
     [](Case& c) { c.materials[0].bulkModulus = std::nan(""); },
     {"syrup.bulk_modulus=nan"},
     {"material", "syrup", "bulk_modulus"},
     "[[material]] 'syrup'",
     "expected a number not less than 0 [Pa] or \"auto\", found nan"},
    {"box",
     mph,
     [](Case& c) { c.bodies[0].shape.max[1] = -6e-3; },
     {"body.column.max=[6e-3, -6e-3]"},
     {"body", "column", "max"},
     "[[body]] 'column' (box)",
     "expected more than min on every axis, found -0.006 <= 0 along y"},
    {"radius",
     mph,
     [](Case& c) { c.bodies[2].shape.radius = -1; },
     {"body.drop.radius=-1"},
     {"body", "drop", "radius"},
     "[[body]] 'drop' (sphere)",
     "expected a positive number [m], found -1"},
    {"innerRadius",
     mph,
     [](Case& c) { c.bodies[2].shape.innerRadius = 0.5; },
     {"body.drop.inner_radius=0.5"},
     {"body", "drop", "inner_radius"},
     "[[body]] 'drop' (sphere)",
     "expected less than radius = 0.001, found 0.5"},
    {"axisOfACylinder",
     mph,
     [](Case& c) { c.bodies[3].shape.end = c.bodies[3].shape.start; },
     {"body.\"left rod\".end=[-3e-3, 9e-3]"},
     {"body", "left rod", "end"},
     "[[body]] 'left rod' (cylinder)",
     "expected a point other than start"},
    {"radiiOfACone",
     mph,
     [](Case& c) { c.bodies[4].shape.startRadius = c.bodies[4].shape.endRadius = 0; },
     {"wedge.start_radius=0", "wedge.end_radius=0"},
     {"body", "wedge", "end_radius"},
     "[[body]] 'wedge' (cone)",
     "expected more than 0 at one end of the axis, found 0 at both"},
    {"innerRadiusOfACone",
     mph,
     [](Case& c) { c.bodies[4].shape.innerStartRadius = 2e-3; },
     {"wedge.inner_start_radius=2e-3"},
     {"body", "wedge", "inner_start_radius"},
     "[[body]] 'wedge' (cone)",
     "expected at most start_radius = 0.001, found 0.002"},
    {"pointsOfAPolygon",
     mph,
     [](Case& c) { c.bodies[5].shape.points.pop_back(); },
     {"outline.points=[[3e-3, 8e-3], [5e-3, 8e-3]]"},
     {"body", "outline", "points"},
     "[[body]] 'outline' (polygon)",
     "expected 3 to 10000 points, the corners in order, found 2"},
    {"aThinSheetOfFluid",
     mph,
     [](Case& c) { c.bodies[5].shape.fill = FillKind::ThinSheet, c.bodies[5].kind = BodyKind::Fluid; },
     {"outline.fill=thin-sheet", "outline.type=fluid"},
     {"body", "outline", "fill"},
     "[[body]] 'outline' (polygon)",
     "a thin-sheet is for bodies of type \"wall\""},
    {"subtractOfAThinSheet",
     mph,
     [](Case& c) { c.bodies[5].shape.fill = FillKind::ThinSheet, c.bodies[0].subtract = {"outline"}; },
     {"outline.fill=thin-sheet", "column.subtract=[\"outline\"]"},
     {"body", "column", "subtract"},
     "[[body]] 'column' (box)",
     "'outline' is a thin sheet, which holds no place; fluid may be on both sides"},
    {"operatorBesideAThinSheet",
     mph,
     [](Case& c) {
       c.bodies[5].shape.fill = FillKind::ThinSheet, c.solver.operatorKind = OperatorKind::Assembled;
     },
     {"outline.fill=thin-sheet", "solver.operator=assembled"},
     {"solver", "operator"},
     "[solver]",
     "found \"assembled\" beside a thin sheet; expected \"matrix-free\""},
    {"operatorBesideASlip",
     mph,
     [](Case& c) { c.materials[0].slipLength = 1e-3, c.solver.operatorKind = OperatorKind::Assembled; },
     {"material.syrup.slip_length=1e-3", "solver.operator=assembled"},
     {"solver", "operator"},
     "[solver]",
     "found \"assembled\" beside a slip_length; expected \"matrix-free\""},
    {"crossingSidesOfAPolygon",
     mph,
     [](Case& c) {
       c.bodies[5].shape.points = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
     },
     {"outline.points=[[0, 0], [1, 1], [1, 0], [0, 1]]"},
     {"body", "outline", "points"},
     "[[body]] 'outline' (polygon)",
     "the side from (0, 0) to (1, 1) meets that from (1, 0) to (0, 1): expected corners in order, whose sides "
     "meet "
     "nowhere else"},
    {"pointTwiceInAPolygon",
     mph,
     [](Case& c) {
       c.bodies[5].shape.points = {{0, 0}, {1, 1}, {1, 1}, {0, 1}};
     },
     {"outline.points=[[0, 0], [1, 1], [1, 1], [0, 1]]"},
     {"body", "outline", "points"},
     "[[body]] 'outline' (polygon)",
     "found (1, 1) twice in a row, as points 2 and 3"},
    {"thickness",
     mph,
     [](Case& c) { c.bodies[5].shape.thickness = -1; },
     {"outline.thickness=-1"},
     {"body", "outline", "thickness"},
     "[[body]] 'outline' (polygon)",
     "expected a number not less than 0 [m], found -1"},
    {"scaleOfATransform",
     mph,
     [](Case& c) { c.bodies[5].shape.transform->scale = 0; },
     {"outline.transform.scale=0"},
     {"body", "outline", "transform", "scale"},
     "the transform of [[body]] 'outline'",
     "expected a positive number, found 0"},
    {"velocity",
     mph,
     [](Case& c) { c.bodies[1].velocity[0] = infinity; },
     {"floor.velocity=[inf, 0]"},
     {"body", "floor", "velocity"},
     "[[body]] 'floor' (box)",
     "expected an array of 2 finite numbers [m/s], found inf"},
    {"velocityOfAnUnknownName",
     mph,
     [](Case& c) { c.bodies[0].velocityExpression[0] = "x*u"; },
     {"column.velocity=[\"x*u\", 0]"},
     {"body", "column", "velocity"},
     "[[body]] 'column' (box)",
     "expected an expression in x, y [m] and the constant pi, found \"x*u\": Unexpected token \"u\" found at "
     "position 2."},
    {"condition",
     mph,
     [](Case& c) { c.bodies[0].where = "x = 0"; },
     {"column.where=x = 0"},
     {"body", "column", "where"},
     "[[body]] 'column' (box)",
     "expected an expression in x, y [m] and the constant pi, found \"x = 0\": a single = (== compares)"},
    {"subtractedBodyThatThereIsNot",
     mph,
     [](Case& c) { c.bodies[0].subtract = {"flor"}; },
     {"column.subtract=[\"flor\"]"},
     {"body", "column", "subtract"},
     "[[body]] 'column' (box)",
     "expected 'floor', 'drop', 'left rod', 'wedge' or 'outline', found 'flor'"},
    {"bodiesThatSubtractEachOther",
     mph,
     [](Case& c) { c.bodies[0].subtract = {c.bodies[2].name}, c.bodies[2].subtract = {c.bodies[0].name}; },
     {"column.subtract=[\"drop\"]", "drop.subtract=[\"column\"]"},
     {"body", "column", "subtract"},
     "[[body]] 'column' (box)",
     "'column' and 'drop' subtract each other"},
    {"periodOfAnOscillation",
     mph,
     [](Case& c) { c.bodies[3].oscillation.period = 0; },
     {"body.\"left rod\".oscillation.period=0"},
     {"body", "left rod", "oscillation", "period"},
     "the oscillation of [[body]] 'left rod'",
     "expected a positive number [s], found 0"},
    {"speedOfARotation",
     mph,
     [](Case& c) { c.bodies[3].rotation->speed = infinity; },
     {"body.\"left rod\".rotation.speed=inf"},
     {"body", "left rod", "rotation", "speed"},
     "the rotation of [[body]] 'left rod'",
     "expected a finite number [rad/s], found inf"},
    {"noFluid",
     mph,
     [](Case& c) { c.bodies[0].kind = c.bodies[2].kind = BodyKind::Wall; },
     {"drop.type=wall", "column.type=wall"},
     {"body"},
     "the case file",
     "no fluid: expected at least one [[body]] with type = \"fluid\" or \"inflow\""},
    {"step",
     mph,
     [](Case& c) { c.time.step = -1; },
     {"time.step=-1"},
     {"time", "step"},
     "[time]",
     "expected a positive number [s] or \"auto\", found -1"},
    {"steps",
     mph,
     [](Case& c) { c.time.step = 1e-20; },
     {"time.step=1e-20"},
     {"time", "step"},
     "[time]",
     "2e+17 steps to the end are too many"},
    {"end",
     mph,
     [](Case& c) { c.time.end = 1e-4; },
     {"time.end=1e-4"},
     {"time", "end"},
     "[time]",
     "expected at least one step of 0.001 s, found 0.0001"},
    {"courant",
     mph,
     [](Case& c) { c.time.courant = -1; },
     {"time.courant=-1"},
     {"time", "courant"},
     "[time]",
     "expected a number not less than 0, found -1"},
    {"stepTolerance",
     mph,
     [](Case& c) { c.time.automatic = true, c.time.least = 1e-6, c.time.tolerance = 0; },
     {"time.step=auto", "time.tolerance=0"},
     {"time", "tolerance"},
     "[time]",
     "expected a number from 1e-06 to 0.5, found 0"},
    {"shortestStep",
     mph,
     [](Case& c) { c.time.automatic = true, c.time.least = 2, c.time.step = 1; },
     {"time.step=auto", "time.min_step=2", "time.max_step=1"},
     {"time", "min_step"},
     "[time]",
     "expected at most max_step = 1 s, found 2"},
    {"shortSteps",
     mph,
     [](Case& c) { c.time.automatic = true, c.time.least = 1e-20; },
     {"time.step=auto", "time.min_step=1e-20"},
     {"time", "min_step"},
     "[time]",
     "2e+17 steps to the end are too many"},
    {"longestStep",
     mph,
     [](Case& c) { c.time.automatic = true, c.time.step = -1, c.time.least = 1; },
     {"time.step=auto", "time.max_step=-1"},
     {"time", "max_step"},
     "[time]",
     "expected a positive number [s], found -1"},
    {"automaticStepsOfIsph",
     MethodKind::Isph,
     [](Case& c) { c.time.automatic = true, c.time.least = 1e-6; },
     {"time.step=auto"},
     {"time", "step"},
     "[time]",
     "\"auto\" is for the method 'mph-i', found 'isph'; expected the longest step [s], and courant to shorten it "
     "where the flow is fast"},
    {"pressureRadius",
     mph,
     [](Case& c) { c.method.pressureRadius = 0; },
     {"method.pressure_radius=0"},
     {"method", "pressure_radius"},
     "[method]",
     "expected a number between 0 and 20 [spacings], found 0"},
    {"radiusWithoutNeighbours",
     mph,
     [](Case& c) { c.method.viscosityRadius = 1; },
     {"method.viscosity_radius=1"},
     {"method", "viscosity_radius"},
     "[method]",
     "expected more than 1 spacing, found 1: particles would have no neighbours"},
    {"fluidWithoutPressure",
     mph,
     [](Case& c) { c.materials[0].bulkViscosity = c.materials[0].bulkModulus = 0; },
     {"syrup.bulk_viscosity=0", "syrup.bulk_modulus=0"},
     {"material", "syrup", "bulk_viscosity"},
     "[[material]] 'syrup'",
     "found 0, and bulk_modulus = 0: such a fluid has no pressure and falls through walls; expected one of them "
     "positive, and bulk_modulus <= 0.5 bulk_viscosity / step"},
    {"surfaceTension",
     mph,
     [](Case& c) { c.materials[0].surfaceTension = -1; },
     {"syrup.surface_tension=-1"},
     {"material", "syrup", "surface_tension"},
     "[[material]] 'syrup'",
     "expected a number not less than 0 [N/m], found -1"},
    {"contactAngle",
     mph,
     [](Case& c) { c.materials[0].contactAngle = 190; },
     {"syrup.contact_angle=190"},
     {"material", "syrup", "contact_angle"},
     "[[material]] 'syrup'",
     "expected a number from 0 to 180 [deg], found 190"},
    {"contactAngleOfOneFluid",
     mph,
     [](Case& c) {
       c.materials[0].contactAngles = {{"syrup", 190}};
     },
     {"syrup.contact_angles=[{name=\"syrup\", angle=190}]"},
     {"material", "syrup", "contact_angles", "syrup", "angle"},
     "[[contact_angles]] 'syrup'",
     "expected a number from 0 to 180 [deg], found 190"},
    {"contactAngleOfNoFluid",
     mph,
     [](Case& c) {
       c.materials[0].contactAngles = {{"honey", 40}};
     },
     {"syrup.contact_angles=[{name=\"honey\", angle=40}]"},
     {"material", "syrup", "contact_angles", "honey", "name"},
     "[[contact_angles]] 'honey'",
     "unknown material 'honey'"},
    {"watchedShare",
     mph,
     [](Case& c) { c.watch.insideWalls = 2; },
     {"watch.inside_walls=2"},
     {"watch", "inside_walls"},
     "[watch]",
     "expected a number from 0 to 1, found 2"},
    {"smoothingRatio",
     isph,
     [](Case& c) { c.method.isph.smoothingRatio = 3; },
     {"method.smoothing_ratio=3"},
     {"method", "smoothing_ratio"},
     "[method] (isph)",
     "expected a number from 0.9 to 2 [spacings], found 3: with less the sums have too few neighbours to be "
     "accurate, with more they smooth the flow away and take several times as long"},
    {"alpha",
     isph,
     [](Case& c) { c.method.isph.alpha = 1.5; },
     {"method.alpha=1.5"},
     {"method", "alpha"},
     "[method] (isph)",
     "expected a number from 0 to 1, found 1.5"},
    {"preconditioner",
     isph,
     [](Case& c) { c.solver.preconditioner = PreconditionerKind::BucketMultigrid; },
     {"solver.preconditioner=bucket-multigrid"},
     {"solver", "preconditioner"},
     "[solver] (isph)",
     "expected 'hat-multigrid', 'cell-multigrid', 'jacobi' or 'none', found 'bucket-multigrid'"},
    {"firstGuess",
     isph,
     [](Case& c) { c.solver.firstGuess = FirstGuess::Linear; },
     {"solver.first_guess=linear"},
     {"solver", "first_guess"},
     "[solver] (isph)",
     "expected 'last', found 'linear'"},
    {"tolerance",
     mph,
     [](Case& c) { c.solver.tolerance = 1; },
     {"solver.tolerance=1"},
     {"solver", "tolerance"},
     "[solver]",
     "expected a number between 0 and 1, found 1"},
    {"iterations",
     mph,
     [](Case& c) { c.solver.maxIterations = 0; },
     {"solver.max_iterations=0"},
     {"solver", "max_iterations"},
     "[solver]",
     "expected a whole number from 1 to 1000000, found 0"},
    {"deflation",
     mph,
     [](Case& c) { c.solver.deflation = 17; },
     {"solver.deflation=17"},
     {"solver", "deflation"},
     "[solver]",
     "expected a whole number from 0 to 16, found 17"},
    {"ranges",
     mph,
     [](Case& c) { c.solver.neighbours = NeighbourKind::Ranges; },
     {"solver.neighbours=ranges"},
     {"solver", "neighbours"},
     "[solver]",
     "expected 'lists' with preconditioner = 'projected-multigrid', found 'ranges': that needs lists"},
    {"sweeps",
     mph,
     [](Case& c) { c.solver.multigrid.finestSweeps = 0; },
     {"solver.multigrid.finest_sweeps=0"},
     {"solver", "multigrid", "finest_sweeps"},
     "[solver.multigrid]",
     "expected a whole number from 1 to 1000, found 0"},
    {"hatDegree",
     isph,
     [](Case& c) { c.solver.hats.gridDegree = -1; },
     {"solver.hats.grid_degree=-1"},
     {"solver", "hats", "grid_degree"},
     "[solver.hats]",
     "expected a whole number from 0 to 1000, found -1"},
    {"interval",
     mph,
     [](Case& c) { c.output.interval = -1; },
     {"output.interval=-1"},
     {"output", "interval"},
     "[output]",
     "expected a number not less than 0 [s], found -1"},
};

INSTANTIATE_TEST_SUITE_P(Case, Mistakes, testing::ValuesIn(mistakes),
                         [](const auto& test) { return test.param.name; });

/// What no file can hold.
TEST(requireValid, refusesWhatOnlyCodeCanSay) {
  const auto messageFor = [](MethodKind method, const std::function<void(Case&)>& mistake) {
    Case c = goodCase(method);
    mistake(c);
    return messageOf<CaseError>([&] { requireValid(c); });
  };
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.materials.clear(); }),
            "material: missing; expected at least one [[material]]");
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.materials.push_back(c.materials[0]); }),
            "material: two [[material]] are named 'syrup'");
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.bodies[2].name.clear(); }), "body.2.name: missing; expected a string");
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.bodies.resize(256, c.bodies[0]); }),
            "body: expected at most 255, found 256");
  EXPECT_EQ(
      messageFor(mph, [](Case& c) { c.bodies[1].velocityExpression[1] = "x"; }),
      "body.floor.velocity: only a body of type \"fluid\" can have expressions; expected an array of 2 finite "
      "numbers [m/s], found \"x\"");
  EXPECT_EQ(messageFor(mph,
                       [](Case& c) {
                         c.bodies[2].oscillation = Oscillation{{1e-3, 0}, 1, 0};
                       }),
            "body.drop.oscillation: only a body of type \"wall\" can have one");
  EXPECT_EQ(messageFor(mph,
                       [](Case& c) {
                         c.bodies[2].rotation = Rotation{{}, {0, 0, 1}, 1};
                       }),
            "body.drop.rotation: only a body of type \"wall\" can have one");
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.bodies[3].material = 1; }),
            "body.\"left rod\".material: expected the index of one of 1 materials, found 1");
  EXPECT_EQ(messageFor(mph,
                       [](Case& c) {
                         c.gravity = {0, 0, -9.81};
                       }),
            "gravity.acceleration: expected 0 along z in a plane, found -9.81");
  EXPECT_EQ(messageFor(mph, [](Case& c) { c.solver.krylov = static_cast<KrylovKind>(7); }),
            "solver.krylov: expected 'cg' or 'cr', found ''");
  EXPECT_EQ(messageFor(isph, [](Case& c) { c.output.balance = true; }),
            "output.balance: only the method 'mph-i' has one, found 'isph'");
  // A file's reader has no such key with ISPH.
  EXPECT_EQ(messageFor(isph, [](Case& c) { c.materials[0].surfaceTension = 0.07; }),
            "material.syrup.surface_tension: only the method 'mph-i' has surface tension, found 'isph'");
  EXPECT_EQ(messageFor(isph, [](Case& c) { c.materials[0].contactAngle = 60; }),
            "material.syrup.contact_angle: only the method 'mph-i' has surface tension, found 'isph'");
  EXPECT_EQ(messageFor(isph,
                       [](Case& c) {
                         c.materials[0].contactAngles = {{"syrup", 60}};
                       }),
            "material.syrup.contact_angles: only the method 'mph-i' has surface tension, found 'isph'");
}

TEST(requireValid, knowsDirectionsOfLengthZeroInSpace) {
  Case c = goodCase(mph);
  c.dimensions = 3;
  c.domain.max[2] = 1;
  for (Body& body : c.bodies) body.shape.max[2] = body.shape.top = 1;
  EXPECT_NO_THROW(requireValid(c));
  c.bodies[3].rotation->axis = {};
  EXPECT_EQ(messageOf<CaseError>([&] { requireValid(c); }),
            "body.\"left rod\".rotation.axis: expected a direction, found a vector of length 0");
}

TEST(applyWidth, refusesWhatIsNoStretch) {
  Case c = goodCase(mph);
  const Case before = c;
  EXPECT_EQ(messageOf<CaseError>([&] {
              applyWidth(c, {Coordinate::X, 1, 1, 2});
            }),
            "width.to: expected more than from = 1, found 1");
  EXPECT_EQ(messageOf<CaseError>([&] {
              applyWidth(c, {Coordinate::X, 0, 1, 0});
            }),
            "width.factor: expected a positive number, found 0");
  EXPECT_EQ(messageOf<CaseError>([&] {
              applyWidth(c, {Coordinate::Z, 0, 1, 2});
            }),
            "width.axis: expected 'x' or 'y', found 'z'");
  EXPECT_EQ(c, before);
}

TEST(requireValid, IsphTakesFluidsWhoseDensitiesDifferByAFactorOfTen) {
  Case c = goodCase(MethodKind::Isph);
  const auto drop = std::ranges::find(c.bodies, "drop", &Body::name);
  c.materials.push_back(c.materials[0]);
  std::ranges::find(c.bodies, "left rod", &Body::name)->material = 1;
  c.materials[1].name = "oil", c.materials[1].density = c.materials[0].density / 10;
  drop->material = 1;
  EXPECT_NO_THROW(requireValid(c));
  c.materials[1].density *= 0.99;
  try {
    requireValid(c);
    ADD_FAILURE() << "not refused";
  } catch (const CaseError& error) {
    EXPECT_EQ(error.path(), (CasePath{"material", "syrup", "density"}));
    EXPECT_THAT(error.text(), testing::StartsWith("found 10.101 times that of 'oil'"));
  }
  c.method.kind = MethodKind::MphI;
  c.materials[0].bulkViscosity = c.materials[1].bulkViscosity = 1;
  c.solver = defaultSolver(MethodKind::MphI);
  EXPECT_NO_THROW(requireValid(c)) << "MPH-I does";
  c.method.kind = MethodKind::Isph;
  c.solver = defaultSolver(MethodKind::Isph);
  drop->material = 0;
  EXPECT_NO_THROW(requireValid(c)) << "of walls it means nothing";
}

}  // namespace
}  // namespace treacle::test
