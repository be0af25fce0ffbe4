#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/tables/history.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "unit/app/command.hpp"
#include "unit/app/mistakes.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;

/// A nozzle over a floor, and a box that takes what has spread far.
const std::string pouring = R"(title = "Pouring"
dimensions = 2
spacing = 1e-3
domain = {min = [-10e-3, -4e-3], max = [10e-3, 14e-3]}
gravity = {acceleration = [0, -10]}
time = {step = 1e-3, end = 0.05}
material = [{name = "syrup", density = 1000, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6}]
body = [
  {name = "jet", type = "inflow", material = "syrup", speed = 0.2, nozzle = {shape = "rectangle", center = [0, 8e-3], direction = [0, -1], width = 4e-3}},
  {name = "floor", type = "wall", material = "syrup", shape = "box", min = [-10e-3, -4e-3], max = [10e-3, 0]},
]
outflow = [{name = "rim", shape = "box", min = [4e-3, 0], max = [10e-3, 14e-3]}]
)";

Case openCaseWith(const std::vector<std::string>& overrides) {
  Workshop shop;
  shop.put("case.toml", pouring);
  return readCase(shop / "case.toml", overrides);
}

TEST(OpenCase, IsReadAndWritten) {
  Workshop shop;
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {},
           {"jet.speed='0.1*sin(t)^2'", "jet.start=0.01", "jet.end=0.02"},
           {"jet.speed={times=[0,1],values=[0.1,0.2]}", "jet.velocity=[0.1,0]"},
           {"jet.profile='parabolic'", "jet.oscillation={amplitude=[1e-3,0],period=0.1}"},
           {"jet.profile='1 - (x/3e-3)^2'"},
           {"jet.rotation={center=[0,9e-3],speed=2}"},
           {"jet.rotation={center=[0,9e-3],angle='0.1*sin(9*t)'}"},
           {"outflow=[{name='end',shape='plane',point=[1e-3,0],normal=[1,1]}]"}}) {
    const Case c = openCaseWith(overrides);
    shop.put("written.toml", caseText(c));
    EXPECT_EQ(readCase(shop / "written.toml"), c) << caseText(c);
  }
  const Case c = openCaseWith({});
  EXPECT_EQ(c.bodies[0].inflow.speed->value, 0.2);
  EXPECT_EQ(c.outflows[0].max[1], 14e-3);
}

/// Four columns at 0.2 m/s for 0.05 s, or while the nozzle is open.
TEST(OpenCase, CheckSaysHowMuchComesIn) {
  Workshop shop;
  shop.put("case.toml", pouring);
  EXPECT_THAT(shop.call("check case.toml").out, HasSubstr("# inflow: about 40 particles enter until the end\n"));
  EXPECT_THAT(shop.call("check case.toml --set jet.end=0.02").out,
              HasSubstr("# inflow: about 16 particles enter until the end\n"));
}

/// Beside the case, by name or the second column; what is wrong is said with the line.
TEST(OpenCase, TablesOfTimeComeFromFiles) {
  Workshop shop;
  shop.put("data/pump.csv", "# of the pump\n\"time\";speed;\"back pressure\"\n0;0.1;7\n0.5;0.2;8\n\n2;0.3;9\n");
  shop.put("data/bare.txt", "0 0.5\n1\t0.25\n");
  const auto speedOf = [&](const std::string& value) {
    shop.put("case.toml", replaced(pouring, "speed = 0.2", "speed = " + value));
    return *readCase(shop / "case.toml").bodies[0].inflow.speed;
  };
  const TimeFunction pump = speedOf("{file = 'data/pump.csv'}");
  EXPECT_THAT(pump.times, testing::ElementsAre(0, 0.5, 2));
  EXPECT_THAT(pump.values, testing::ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(speedOf("{file = 'data/pump.csv', column = 'back pressure'}").values, testing::ElementsAre(7, 8, 9));
  EXPECT_THAT(speedOf("{file = 'data/bare.txt'}").values, testing::ElementsAre(0.5, 0.25));
  const auto message = [&](const std::string& value) { return messageOf<InputError>([&] { speedOf(value); }); };
  EXPECT_THAT(message("{file = 'data/pump.csv', column = 'pressure'}"),
              HasSubstr("pump.csv:2: no column 'pressure'; expected 'speed' or 'back pressure'"));
  EXPECT_THAT(message("{file = 'data/pump.csv', column = 'time'}"),
              HasSubstr("is the first one, which holds the times"));
  EXPECT_THAT(message("{file = 'data/bare.txt', column = 'x'}"), HasSubstr("no column 'x'"));
  shop.put("data/bare.txt", "0 1\n0.5 x\n");
  EXPECT_THAT(message("{file = 'data/bare.txt'}"), HasSubstr("bare.txt:2: expected a number, found 'x'"));
  for (const char* commas : {"0,00;0,1\n0,5;0,2\n", "time;speed\n0,00;0,1\n", "0,00\t0,1\n"}) {
    shop.put("data/bare.txt", commas);
    EXPECT_THAT(message("{file = 'data/bare.txt'}"),
                HasSubstr("is it a decimal comma? Write numbers with decimal points"))
        << commas;
  }
  shop.put("data/bare.txt", std::string("\xFF\xFE\0", 3));
  EXPECT_THAT(message("{file = 'data/bare.txt'}"), HasSubstr("bare.txt: UTF-16 text; expected UTF-8"));
  shop.put("data/bare.txt", "time,speed,\n+0.0E+00,+0.1,\n0.5D+00,2.0d-1,\n,,\n");
  EXPECT_THAT(speedOf("{file = 'data/bare.txt'}").times, testing::ElementsAre(0, 0.5));
  EXPECT_THAT(speedOf("{file = 'data/bare.txt'}").values, testing::ElementsAre(0.1, 0.2));
  shop.put("data/bare.txt", "0 1\n0.5\n");
  EXPECT_THAT(message("{file = 'data/bare.txt'}"), HasSubstr("bare.txt:2: expected 2 numbers or more, found 1"));
  shop.put("data/bare.txt", "0 1\n1 1\n0.5 1\n");
  EXPECT_THAT(message("{file = 'data/bare.txt'}"), HasSubstr("expected rising times, found 0.5 after 1"));
  shop.put("data/bare.txt", "time,speed\n");
  EXPECT_THAT(message("{file = 'data/bare.txt'}"), HasSubstr("bare.txt: expected rows of a time and values"));
}

TEST(OpenCase, MotionsAndRigidBodiesAreReadAndWritten) {
  Workshop shop;
  for (const char* motion : {"type='wall', displacement=['1e-3*sin(t)', {times=[0,1], values=[0,1e-3]}]",
                             "type='wall', displacement=[0, '1e-3*t'], rotation={center=[0,0], angle='0.1*t'}",
                             "type='wall', rotation={center=[0,0], angle={times=[0,1,2], values=[0,1,1]}}",
                             "type='rigid'", "type='wall', friction=0.2",
                             "type='rigid', mass=0.3, friction=0.5, angular_velocity=2, velocity=[0,1e-2], "
                             "translates=[true,false], rotates=false"}) {
    const std::string block =
        std::string("body = [\n{name='block', material='syrup', shape='box', min=[-2e-3,0], max=[2e-3,3e-3], ") +
        motion + "},\n";
    shop.put("case.toml", replaced(pouring, "body = [\n", block));
    const Case c = readCase(shop / "case.toml");
    shop.put("written.toml", caseText(c));
    EXPECT_EQ(readCase(shop / "written.toml"), c) << caseText(c);
  }
}

const Mistake openMistakes[] = {
    {"jet.speed=-1",
     "expected a number not less than 0 [m/s], an expression in t [s] or {times = [...], values = "
     "[...]}, found -1"},
    {"jet.speed='2*x'", "expected an expression in t [s] and the constant pi, found \"2*x\""},
    {"jet.speed={times=[0,1,0.5],values=[1,2,3]}", "expected rising times, found 0.5 after 1"},
    {"jet.speed={times=[],values=[]}", "speed in [[body]] 'jet' (inflow): expected at least one time, found none"},
    {"jet.speed={times=[0,1],values=[1]}", "expected as many values as times, 2, found 1"},
    {"jet.speed={times=[0,1],values=[1,-2]}", "expected an array of finite numbers [m/s], found -2"},
    {"jet.flow_rate=1", "expected one of speed and flow_rate, found both"},
    {"jet.profile=1", "profile in [[body]] 'jet' (inflow): expected a string, found 1"},
    {"jet.profile='parabolik'",
     "profile in [[body]] 'jet' (inflow): \"parabolik\" is neither \"plug\" nor \"parabolic\"; expected an "
     "expression"},
    {"jet.profile='x'",
     "profile in [[body]] 'jet' (inflow): \"x\" is -0.0005 for the column of particles at (-0.5, 8) mm; expected "
     "a "
     "finite number not less than 0"},
    {"jet.profile='1/(x-5e-4)'", "\"1/(x-5e-4)\" is inf for the column"},
    {"jet.profile='0*x'", "\"0*x\" is 0 for all columns of particles together; expected more than 0"},
    {"jet.nozzle.direction=[0,0]", "expected a direction, found a vector of length 0"},
    {"jet.nozzle.radius=1", "unknown key 'radius' in the nozzle of [[body]] 'jet' (rectangle)"},
    {"jet.nozzle.width=0", "expected a positive number [m], found 0"},
    {"jet.nozzle.shape='polygon'", "unknown key 'width' in the nozzle of [[body]] 'jet' (polygon)"},
    {"jet.speed={file='missing.csv'}", "missing.csv"},
    {"jet.speed={file='a.csv', times=[0]}", "expected either file or times and values, found both"},
    {"jet.shape='box'", "unknown key 'shape' in [[body]] 'jet' (inflow)"},
    {"rim.max=[0,0]", "expected more than min"},
    {"rim.normal=[1,0]", "unknown key 'normal' in [[outflow]] 'rim' (box)"},
    {"floor.displacement=[0]", "expected an array of 2 of these: a finite number [m], an expression in t [s] or"},
    {"floor.displacement=['x', 0]", "expected an expression in t [s]"},
    {"floor.rotation={center=[0,0]}", "missing; expected a finite number [rad/s], or angle"},
    {"floor.rotation={center=[0,0], speed=1, angle=2}", "expected one of speed and angle, found both"},
    {"jet.rotation={center=[0,0]}",
     "speed in the rotation of [[body]] 'jet': missing; expected a finite number [rad/s], or angle"},
    {"jet.rotation={center=[0,0], angle='x'}", "expected an expression in t [s]"},
    {"jet.rotation={center=[0,0], speed=1, axis=[0,0,1]}", "unknown key 'axis' in the rotation of [[body]] 'jet'"},
    {"floor.friction=-0.1", "friction in [[body]] 'floor' (box): expected a number not less than 0, found -0.1"},
    {"jet.friction=0.1", "unknown key 'friction' in [[body]] 'jet' (inflow)"},
    {"jet.mass=1", "unknown key 'mass'"},
    {"rim.shape='ball'", "expected 'box' or 'plane', found 'ball'"},
};

TEST(OpenCase, MistakesAreExplained) { expectExplained(openMistakes, openCaseWith); }

TEST(OpenCase, APolygonIsAnOpeningInSpace) {
  Workshop shop;
  const auto message = [&](const std::string& dimensions, const std::string& points) {
    std::string text = replaced(pouring, "shape = \"rectangle\"", "shape = \"polygon\"");
    text = replaced(text, "width = 4e-3", "points = " + points);
    shop.put("case.toml", replaced(text, "dimensions = 2", dimensions));
    return messageOf<InputError>([&] { readCase(shop / "case.toml"); });
  };
  EXPECT_THAT(message("dimensions = 2", "[[0, 0], [1, 0], [0, 1]]"), HasSubstr("a polygon has two dimensions"));
  EXPECT_THAT(message("dimensions = 2", "[[0, 0], [1, 0, 3]]"), HasSubstr("points in the nozzle"));
}

TEST(OpenCase, APolygonHasNoParabolicProfile) {
  Case c = openCaseWith({});
  c.dimensions = 3;
  c.domain.min[2] = -10e-3, c.domain.max[2] = 10e-3;
  c.bodies.resize(1), c.outflows.clear();
  c.bodies[0].inflow.nozzle.kind = NozzleKind::Polygon;
  c.bodies[0].inflow.nozzle.points = {{-2e-3, -2e-3}, {2e-3, -2e-3}, {0, 2e-3}};
  requireValid(c);
  c.bodies[0].inflow.profile = "parabolic";
  EXPECT_THAT(messageOf<InputError>([&] { requireValid(c); }),
              HasSubstr("body.jet.profile: \"parabolic\" is for a disc or a rectangle; expected \"plug\" or an "
                        "expression of x, y and z for a polygon"));

  Workshop shop;
  std::string text = replaced(pouring, "dimensions = 2", "dimensions = 3");
  text = replaced(text, ", bulk_viscosity = 1e4, bulk_modulus = 1e6", "");  // which follow from the nozzle
  text =
      replaced(text, "[-10e-3, -4e-3], max = [10e-3, 14e-3]", "[-0.01, -0.01, -0.01], max = [0.01, 0.02, 0.01]");
  text = replaced(text, "acceleration = [0, -10]", "acceleration = [0, -10, 0]");
  text = replaced(text, "[0, 8e-3], direction = [0, -1], width = 4e-3",
                  "[0, 8e-3, 0], direction = [0, -1, 0], points = [[-2e-3, -2e-3], [2e-3, -2e-3], [0, 2e-3]]");
  text = replaced(text, "speed = 0.2,", "speed = 0.2, profile = \"parabolic\",");
  text = replaced(text, "shape = \"rectangle\"", "shape = \"polygon\"");
  text = replaced(text, "[-10e-3, -4e-3], max = [10e-3, 0]", "[-0.01, -4e-3, -0.01], max = [0.01, 0, 0.01]");
  shop.put("case.toml", text.substr(0, text.find("outflow")));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "case.toml"); }),
              HasSubstr("profile in [[body]] 'jet' (inflow): \"parabolic\" is for a disc or a rectangle"));
}

std::string messageOfCreation(const std::vector<std::string>& overrides) {
  return messageOf<InputError>([&] {
    std::vector<std::string> notes;
    createParticles<2>(openCaseWith(overrides), notes);
  });
}

TEST(OpenCase, ANozzleNeedsItsRoom) {
  EXPECT_THAT(messageOfCreation({"jet.nozzle.center=[0,3e-3]", "jet.nozzle.direction=[0,1]"}),
              HasSubstr("inflow 'jet' and wall 'floor' overlap at"));
  EXPECT_THAT(messageOfCreation({"jet.nozzle.center=[0,1e-3]", "jet.nozzle.direction=[0,1]"}),
              HasSubstr("inflow 'jet' and wall 'floor' overlap at"));
  EXPECT_THAT(messageOfCreation({"jet.nozzle.center=[0,0.2e-3]"}),
              HasSubstr("inflow 'jet' and wall body 'floor' overlap"));
  EXPECT_THAT(messageOfCreation({"jet.nozzle.center=[0,12e-3]"}),
              HasSubstr("body 'jet' reaches out of the domain"));
}

/// A run that goes on has the fluid of its checkpoint.
TEST(OpenCase, ARunBeginsWithSomeFluid) {
  Workshop shop;
  shop.put("case.toml", pouring);
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = shop.call(std::string(command) + " case.toml --set jet.start=0.01");
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.err, HasSubstr("no inflow flows yet; give an inflow a small speed at t = 0"));
  }
}

/// What a run leaves, and what it is when it is continued from a checkpoint.
TEST(OpenCase, ARunCountsWhatComesAndGoes) {
  Workshop shop;
  shop.put("case.toml", pouring);
  ASSERT_EQ(shop.call("run case.toml -o whole --backend cpu --threads 1 --quiet").exitCode, 0);
  const std::vector<HistoryRow> rows = readHistory(shop / "whole/history.csv");
  ASSERT_EQ(rows.size(), 50u);
  EXPECT_EQ(rows.back().inflow.particles, 40u);
  EXPECT_NEAR(rows.back().inflow.volume, 40e-6, 1e-18);
  EXPECT_NEAR(rows.back().inflow.mass, 0.04, 1e-12);
  for (const HistoryRow& row : rows) EXPECT_EQ(row.particles, 4 + row.inflow.particles - row.outflow.particles);
  EXPECT_THAT(shop.content("whole/summary.json"), HasSubstr("\"inflow_particles\": 40"));

  ASSERT_EQ(shop.call("run case.toml -o half --backend cpu --threads 1 --quiet --end-time 0.025").exitCode, 0);
  const Outcome rest =
      shop.call("run case.toml -o rest --backend cpu --threads 1 --quiet --resume half/checkpoint.h5");
  ASSERT_EQ(rest.exitCode, 0) << rest.err;
  EXPECT_EQ(shop.content("rest/checkpoint.h5"), shop.content("whole/checkpoint.h5"));
  const Outcome other = shop.call(
      "run case.toml -o other --backend cpu --threads 1 --quiet --resume half/checkpoint.h5 --set "
      "\"outflow=[{name='a',shape='plane',point=[5e-3,0],normal=[1,0]},{name='b',shape='plane',point=[-5e-3,0],"
      "normal=[-1,0]}]\"");
  EXPECT_EQ(other.exitCode, 2);
  EXPECT_THAT(other.err, HasSubstr("outflows"));
}

/// Each column of a nozzle goes on from where it is, also where the run had a plug; columns that are apart make
/// none.
TEST(OpenCase, ProfilesGoOnFromAFile) {
  Workshop shop;
  shop.put("case.toml", pouring);
  const std::string run = "run case.toml --backend cpu --threads 1 --quiet ",
                    resume = "--resume half/checkpoint.h5";
  const std::string profile = "--set jet.profile=parabolic ";
  ASSERT_EQ(shop.call(run + profile + "-o whole --end-time 0.04").exitCode, 0);
  ASSERT_EQ(shop.call(run + profile + "-o half --end-time 0.023").exitCode, 0);
  const Outcome rest = shop.call(run + profile + "-o rest --end-time 0.04 " + resume);
  ASSERT_EQ(rest.exitCode, 0) << rest.err;
  EXPECT_EQ(shop.content("rest/checkpoint.h5"), shop.content("whole/checkpoint.h5"));
  const Outcome other = shop.call(run + "-o other " + resume);
  EXPECT_EQ(other.exitCode, 2);
  EXPECT_THAT(other.err,
              HasSubstr("the 4 columns of particles in the nozzle of inflow 'jet' went at speeds of their own; "
                        "expected the nozzle of the run, and a profile other than \"plug\""));
  ASSERT_EQ(shop.call(run + "-o half --force --end-time 0.023").exitCode, 0);
  EXPECT_EQ(shop.call(run + profile + "-o other " + resume).exitCode, 0);
}

/// With openings, one of which has a flow rate, and with trapped gas.
TEST(OpenCase, PressuresGoOnFromAFile) {
  const std::pair<const char*, const char*> cases[] = {{"pumped-channel-2d.toml", " --set end.flow_rate=-5e-4"},
                                                       {"trapped-air-2d.toml", ""}};
  for (const auto& [file, settings] : cases) {
    Workshop shop;
    const std::string run = "run '" + (std::filesystem::path(TREACLE_CASES) / file).string() +
                            "' --backend cpu --threads 1 --quiet --set output.interval=0.01" + settings;
    ASSERT_EQ(shop.call(run + " -o whole --end-time 0.04").exitCode, 0) << file;
    ASSERT_EQ(shop.call(run + " -o half --end-time 0.02").exitCode, 0);
    const Outcome rest = shop.call(run + " -o rest --end-time 0.04 --resume half/checkpoint.h5");
    ASSERT_EQ(rest.exitCode, 0) << rest.err;
    EXPECT_EQ(shop.content("rest/checkpoint.h5"), shop.content("whole/checkpoint.h5")) << file;
  }
}

/// Gas keeps its content where bodies are added.
TEST(OpenCase, GasGoesOnBesideAnAddedBody) {
  Workshop shop;
  std::ifstream file(std::filesystem::path(TREACLE_CASES) / "trapped-air-2d.toml");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  shop.put("case.toml", text);
  shop.put("added.toml", text +
                             "[[body]]\nname = \"post\"\ntype = \"wall\"\nmaterial = \"resin\"\nshape = \"box\"\n"
                             "min = [0.02, 0.034]\nmax = [0.026, 0.039]\n");
  const std::string settings =
      " --backend cpu --threads 1 --quiet --set gas.pressure=300 --set output.interval=0.01";
  ASSERT_EQ(shop.call("run case.toml -o half --end-time 0.04" + settings).exitCode, 0);
  const Outcome rest = shop.call("run added.toml -o rest --end-time 0.042 --resume half/checkpoint.h5" + settings);
  ASSERT_EQ(rest.exitCode, 0) << rest.err;
  // p V of the last step.
  const auto content = [&](const char* history) {
    const std::string table = shop.content(history);
    const std::size_t pressure = table.rfind(','), volume = table.rfind(',', pressure - 1);
    return (300 + std::stod(table.substr(pressure + 1))) * std::stod(table.substr(volume + 1));
  };
  EXPECT_GT(content("half/history.csv"), 1.05 * 300 * 1e-4);
  EXPECT_NEAR(content("rest/history.csv") / content("half/history.csv"), 1, 0.01);
}

TEST(OpenCase, ANozzleDoesNotSuck) {
  Workshop shop;
  shop.put("case.toml", pouring);
  const Outcome outcome = shop.call("run case.toml --set 'jet.speed=\"0.2 - 20*t\"' --threads 1");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("speed in [[body]] 'jet' (inflow): expected no negative numbers, found -"));
}

/// Walls are found whatever number of fluid particles the case would start with; nozzles must stay where they are.
TEST(OpenCase, ContinuesWithOtherFluidAndClosedNozzles) {
  Workshop shop;
  const std::string drop =
      "{name = \"drop\", type = \"fluid\", material = \"syrup\", shape = \"box\", min = [-9e-3, 0], max = [-7e-3, "
      "4e-3]},\n";
  shop.put("case.toml", replaced(pouring, "body = [\n", "body = [\n  " + drop));
  const auto resume = [&](const std::string& settings) {
    return shop.call("run case.toml -o rest --force --threads 1 --end-time 0.03 --resume case-run/checkpoint.h5 " +
                     settings);
  };
  ASSERT_EQ(shop.call("run case.toml --threads 1 --end-time 0.02").exitCode, 0);
  ASSERT_EQ(resume("").exitCode, 0);
  const std::string walls = shop.content("rest/frames/walls_000001.vtp"),
                    fluid = shop.content("rest/frames/fluid_000001.vtp");
  for (const char* top : {"2e-3", "7e-3"}) {
    const Outcome outcome = resume(std::string("--set drop.max=[-7e-3,") + top + "]");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(shop.content("rest/frames/walls_000001.vtp"), walls);
    EXPECT_EQ(shop.content("rest/frames/fluid_000001.vtp"), fluid);
  }
  EXPECT_EQ(resume("--set jet.speed=0").exitCode, 0);
  const Outcome moved = resume("--set jet.nozzle.center=[2e-3,8e-3]");
  EXPECT_EQ(moved.exitCode, 2);
  EXPECT_THAT(moved.err, HasSubstr("inflow 'jet' is not where it was in the run"));
}

TEST(OpenCase, TheShippedOneHasNoWarning) {
  const Case c = readCase(std::filesystem::path(TREACLE_CASES) / "filling-2d.toml");
  std::vector<std::string> notes;
  createParticles<2>(c, notes);
  EXPECT_THAT(notes, testing::IsEmpty());
  EXPECT_THAT(caseWarnings(c), testing::IsEmpty());
}

}  // namespace
}  // namespace treacle::test
