#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A workshop with a run of the small case, frames at 0, 0.001 and 0.002 s, in double precision.
Workshop& withDoubleRun(Workshop& shop) {
  shop.put("small.toml", smallCase);
  EXPECT_EQ(shop.call("run small.toml --quiet --threads 1 -o run --set 'output.precision=\"double\"'").exitCode,
            0);
  return shop;
}

Frame frameOf(const Workshop& shop, std::size_t number) {
  return readVtp(RunDirectory::open(shop / "run").fluidFrame(number));
}

/// As another program would write it, with the particles in reverse order.
std::string tableOf(const Frame& f, bool withIds) {
  std::string text = withIds ? "x;y;vx;vy;pressure;number_density;id\n" : "x;y;vx;vy;pressure;number_density\n";
  for (std::size_t k = f.position.size(); k-- > 0;)
    text += fmt::format("{};{};{};{};{};{}{}\n", f.position[k][0], f.position[k][1], f.velocity[k][0],
                        f.velocity[k][1], f.pressure[k], f.numberDensity[k],
                        withIds ? fmt::format(";{}", f.id[k]) : "");
  return text;
}

constexpr const char* allFields = " --field position --field velocity --field pressure --field number_density";

TEST(compareFiles, aFrameAsTableAgreesWithItsRunToTheBit) {
  Workshop shop;
  const Frame frame = frameOf(withDoubleRun(shop), 2);
  for (const bool withIds : {true, false}) {
    shop.put("table.csv", tableOf(frame, withIds));
    for (const char* sides : {"table.csv run", "run table.csv", "table.csv table.csv"}) {
      const Outcome outcome = shop.call(fmt::format("compare {} --bound 0 --quiet{}", sides, allFields));
      EXPECT_EQ(outcome.exitCode, 0) << sides;
      EXPECT_THAT(outcome.err, IsEmpty());
      EXPECT_EQ(outcome.out, "agree within 0: position, velocity, pressure, number_density\n");
    }
  }
}

TEST(compareFiles, byIdShowsTheTableOfFrames) {
  Workshop shop;
  shop.put("table.csv", tableOf(frameOf(withDoubleRun(shop), 1), true));
  const Outcome outcome = shop.call("compare table.csv run --time 0.0012 --csv out.csv");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, StartsWith("A: table.csv, 36 particles\nB: run/frames/fluid_000001.vtp, 36 "
                                      "particles\nframe at t = 0.001 s\n"));
  EXPECT_THAT(outcome.out, HasSubstr("position [m]"));
  EXPECT_THAT(outcome.out, EndsWith("\nagree within 1e-05: position, velocity\n"));
  EXPECT_THAT(shop.content("out.csv"), HasSubstr("\n0.001,0,1,0,0,0,"));
}

TEST(compareFiles, setsShowTheirMeasures) {
  Workshop shop;
  Frame frame = frameOf(withDoubleRun(shop), 2);
  for (Vec<3>& x : frame.position) x[0] += 1e-4;
  frame.position.push_back({{3e-3, 7.5e-3}}), frame.velocity.push_back({});
  frame.pressure.push_back(0), frame.numberDensity.push_back(1);
  shop.put("table.csv", tableOf(frame, false));
  const Outcome outcome = shop.call("compare table.csv run --csv out.csv");
  EXPECT_EQ(outcome.exitCode, 1);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              HasSubstr("\nparticles                           37            36    1.00e+00    2.78e-02\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nkinetic_energy [J/kg] "));
  EXPECT_THAT(outcome.out, HasSubstr("\nnearest_max [m] "));
  EXPECT_THAT(outcome.out, HasSubstr("\ndiffer: "));
  EXPECT_THAT(outcome.out, EndsWith(", bound 1e-05\n"));
  EXPECT_THAT(shop.content("out.csv"), StartsWith("measure,unit,a,b,difference,relative\nparticles,,37,36,1,"));
  EXPECT_EQ(shop.call("compare table.csv run --bound 0.5").exitCode, 0);
}

TEST(compareFiles, timeChoosesTheNearestFrame) {
  Workshop shop;
  shop.put("table.csv", tableOf(frameOf(withDoubleRun(shop), 1), false));
  EXPECT_EQ(shop.call("compare table.csv run --bound 0").exitCode, 1);  // the last frame
  for (const char* time : {"0.001", "0.0006", "0.0014"})
    EXPECT_EQ(shop.call(fmt::format("compare run table.csv --bound 0 --time {}", time)).exitCode, 0) << time;
  EXPECT_EQ(shop.call("compare table.csv run --bound 0 --time 0.0024").exitCode, 1);
}

TEST(compareFiles, whatCannotBeComparedIsBadInput) {
  Workshop shop;
  const Frame frame = frameOf(withDoubleRun(shop), 2);
  shop.put("table.csv", tableOf(frame, true));
  const auto expectRefused = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = shop.call("compare " + arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_EQ(outcome.err, "treacle: error: " + message + "\n");
  };
  expectRefused("table.csv run --time 0.0026",
                "--time 0.0026: run has no frame near it; expected one of t [s]: 0, 0.001, 0.002");
  expectRefused("table.csv table.csv --time 0.001",
                "--time: neither A nor B is a run; expected one to take a frame from");
  expectRefused("run run --time 0.001",
                "--time: two runs are compared at all times that they share; expected a CSV file as A or B");
  shop.put("still.csv", "x,y\n0,0\n");
  expectRefused(
      "still.csv run",
      "still.csv and run/frames/fluid_000002.vtp: 'velocity' is not in both of them; expected columns of "
      "it, or other fields by --field");
  EXPECT_EQ(shop.call("compare still.csv run --field position --bound 10").exitCode, 0);
  shop.put("flat.csv", "x,y,z\n0,0,1\n");
  expectRefused("flat.csv run", "flat.csv:2: z: expected 0 in two dimensions, found '1'");
  expectRefused("flat.csv still.csv", "flat.csv and still.csv cannot be compared: 3 and 2 dimensions");
  shop.put("other.csv", "x,y,id\n0,0,1\n");
  expectRefused(
      "run other.csv",
      "run/frames/fluid_000002.vtp and other.csv cannot be compared: 36 and 1 fluid particles; without a "
      "column 'id' they are compared as sets");
  expectRefused("table.csv none", "none: not the directory of a run; expected to find fluid.pvd in it");
}

}  // namespace
}  // namespace treacle::test
