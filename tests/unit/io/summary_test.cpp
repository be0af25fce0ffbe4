#include "treacle/io/tables/summary.hpp"

#include "support/temporary_directory.hpp"

#include <nlohmann/json.hpp>

using namespace treacle;
using namespace treacle::test;

namespace {

RunSummary summary() {
  RunSummary s;
  s.origin = {"1.2.3", "abcdef", "cpu", "some processor", 2, "double", "Dam \"break\" µ", 2, 400, 900};
  s.processes = {{100, 1000, 10, 0.5}, {300, 3000, 12, 0.25}};
  s.steps = 200, s.time = 0.2;
  s.tally.meanIterations = 233.25, s.tally.firstIterations = 338, s.tally.lastIterations = 243;
  s.tally.fallbacks = 7;
  s.tally.meanDensity = 0.998, s.tally.densityError = 0.0625, s.tally.largestDensityError = 0.125;
  s.frames = {21, {5000000000, 1.75}, {0.5, 0.75, 1.25}, 0.0625, 0.25};
  s.phaseSeconds = {{"search", 0.5}, {"solve", 1.5}};
  s.outputThreadSeconds = 0.125, s.wallSeconds = 2.25, s.peakMemory = 1000000, s.peakDeviceMemory = 3000000,
  s.done = true;
  return s;
}

}  // namespace

TEST(Summary, HoldsEverything) {
  TemporaryDirectory directory;
  writeSummary(directory / "summary.json", summary());
  const auto json = nlohmann::ordered_json::parse(content(directory / "summary.json"));
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["message"], "");
  EXPECT_EQ(json["title"], "Dam \"break\" µ");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["commit"], "abcdef");
  EXPECT_EQ(json["backend"], "cpu");
  EXPECT_EQ(json["device"], "some processor");
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["processes"], 2);
  EXPECT_EQ(json["shares"]["fluid_particles"].dump(), R"({"least":100,"mean":200.0,"most":300})");
  EXPECT_EQ(json["shares"]["bytes_sent"]["most"], 3000);
  EXPECT_EQ(json["shares"]["exchanges"]["least"], 10);
  EXPECT_EQ(json["shares"]["exchange_seconds"].dump(), R"({"least":0.25,"mean":0.375,"most":0.5})");
  EXPECT_EQ(json["precision"], "double");
  EXPECT_EQ(json["dimensions"], 2);
  EXPECT_EQ(json["fluid_particles"], 400);
  EXPECT_EQ(json["wall_particles"], 900);
  EXPECT_EQ(json["steps"], 200);
  EXPECT_EQ(json["time"], 0.2);
  EXPECT_EQ(json["iterations"]["mean"], 233.25);
  EXPECT_EQ(json["iterations"]["first"], 338);
  EXPECT_EQ(json["iterations"]["last"], 243);
  EXPECT_EQ(json["fallbacks"], 7);
  EXPECT_EQ(json["density"].dump(), R"({"mean":0.998,"error":0.0625,"largest_error":0.125,"inside":1.25})");
  EXPECT_EQ(json["nearest_distance"].dump(),
            R"({"least":0.5,"low":0.75,"smallest_least":0.0625,"smallest_low":0.25})");
  EXPECT_EQ(json["seconds_per_phase"].dump(), R"({"search":0.5,"solve":1.5})");
  EXPECT_EQ(json["frames"].dump(), R"({"count":21,"bytes":5000000000,"seconds":1.75})");
  EXPECT_EQ(json["output_thread_seconds"], 0.125);
  EXPECT_EQ(json["wall_seconds"], 2.25);
  EXPECT_EQ(json["peak_memory_bytes"], 1000000);
  EXPECT_EQ(json["peak_device_memory_bytes"], 3000000);
  EXPECT_EQ(json["memory_bytes_per_fluid_particle"], 2500.0);
}

TEST(Summary, FailedRunWithoutParticlesAndWithAForeignFileName) {
  TemporaryDirectory directory;
  RunSummary s = summary();
  s.done = false;
  s.message = "cannot write /tmp/\xff.vtp";  // no UTF-8
  s.origin.fluidParticles = 0;
  s.frames.arrangement.density.reset();
  writeSummary(directory / "summary.json", s);
  const auto json = nlohmann::ordered_json::parse(content(directory / "summary.json"));
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["message"], "cannot write /tmp/\uFFFD.vtp");
  EXPECT_EQ(json["memory_bytes_per_fluid_particle"], 0.0);
  EXPECT_TRUE(json["density"]["inside"].is_null());
}
