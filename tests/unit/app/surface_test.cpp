#include "command.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/pvd.hpp"
#include "treacle/io/surface/free_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

using namespace treacle;
using namespace treacle::test;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

const std::string dropRun = std::string("run '") + TREACLE_CASES +
                            "/dam-break-3d.toml' --backend cpu --threads 1 --quiet -o run --set resolution=0.5 "
                            "--set time.end=0.004 --set output.interval=0.002 ";

class SurfaceCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasFreeSurface()) GTEST_SKIP() << whyNoFreeSurface();
  }

  Outcome failed(const std::string& arguments) const {
    const Outcome outcome = shop.call(arguments);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    return outcome;
  }

  Workshop shop;
};

}  // namespace

TEST_F(SurfaceCommand, MakesThoseOfAllFramesOrOfOne) {
  ASSERT_EQ(shop.call(dropRun).exitCode, 0);
  Outcome outcome = shop.call("surface run --frame 1 --format ply --threads 1");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("run/frames/surface_000001.ply: t = 0.002 s, "));
  EXPECT_THAT(shop.content("run/frames/surface_000001.ply"), testing::StartsWith("ply\nformat binary_"));
  EXPECT_FALSE(std::filesystem::exists(shop / "run/surface.pvd"));

  outcome = shop.call("surface run --cell 1 --threads 2");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, HasSubstr("run/frames/surface_000002.vtp: t = 0.004 s, "));
  EXPECT_THAT(outcome.out, HasSubstr("ParaView: run/surface.pvd\n"));
  EXPECT_EQ(readPvd(shop / "run/surface.pvd").size(), 3u);

  EXPECT_THAT(failed("surface run --frame 3").err,
              HasSubstr("--frame 3: expected 'last' or a number from 0 to 2"));
  EXPECT_THAT(failed("surface run --cell 0.1").err,
              HasSubstr("--cell: expected a number from 0.25 to 1, found '0.1'"));
  EXPECT_THAT(failed("surface run --format stl").err, HasSubstr("--format: expected vtp|ply, found 'stl'"));
  EXPECT_THAT(failed("surface nowhere").err, HasSubstr("nowhere: not the directory of a run"));
  // A run that has begun, but has no frame yet.
  writePvd(shop / "run/fluid.pvd", {});
  EXPECT_THAT(failed("surface run").err, HasSubstr("run: the run has no frame"));
}

TEST_F(SurfaceCommand, RunsWriteThemBesideTheFrames) {
  ASSERT_EQ(shop.call(dropRun + "--set output.surface=true").exitCode, 0);
  EXPECT_EQ(readPvd(shop / "run/surface.pvd").size(), 3u);
  const std::string written = shop.content("run/frames/surface_000001.vtp");
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shop / "run/frames")) bytes += entry.file_size();
  EXPECT_THAT(shop.content("run/summary.json"), HasSubstr("\"bytes\": " + std::to_string(bytes) + ","));
  EXPECT_TRUE(readCase(shop / "run/case.toml").output.surface);
  // The same but for fields, which are made of frames in single precision here.
  ASSERT_EQ(shop.call("surface run --frame 1 --threads 1").exitCode, 0);
  EXPECT_NEAR(static_cast<double>(shop.content("run/frames/surface_000001.vtp").size()),
              static_cast<double>(written.size()), 0.02 * static_cast<double>(written.size()));
}

TEST_F(SurfaceCommand, TwoDimensionsHaveNone) {
  shop.put("small.toml", smallCase);
  ASSERT_EQ(shop.call("run small.toml --quiet --threads 1 -o flat").exitCode, 0);
  EXPECT_THAT(failed("surface flat").err, HasSubstr("flat: a case of two dimensions has no surface of triangles"));
}

TEST_F(SurfaceCommand, PiecesAreBroughtTogetherForThem) {
  EXPECT_THAT(failed(dropRun + "--set output.surface=true --set output.pieces=each").err,
              HasSubstr("surface in [output]: found true beside pieces = \"each\""));
}
