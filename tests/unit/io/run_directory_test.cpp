#include "treacle/io/files/run_directory.hpp"

#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/io/tables/history.hpp"

#include <unistd.h>

#include <optional>
#include <set>

using namespace treacle;
using namespace treacle::test;
namespace fs = std::filesystem;

namespace {

std::set<std::string> filesIn(const fs::path& directory) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(directory))
    if (!entry.is_directory()) names.insert(fs::relative(entry.path(), directory).string());
  return names;
}

Frame frameAt(double time, std::uint32_t count) {
  Frame frame = sampleFrame(2, count);
  frame.time = time;
  return frame;
}

void expectRefused(const fs::path& path, bool force, const std::string& part) {
  const std::string message = messageOf<InputError>([&] { RunDirectory::create(path, force); });
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

}  // namespace

TEST(RunDirectory, IsMadeWithItsParents) {
  TemporaryDirectory directory;
  const RunDirectory run = RunDirectory::create(directory / "a/b", false);
  EXPECT_TRUE(fs::is_directory(directory / "a/b/frames"));
  EXPECT_EQ(run.caseFile(), directory / "a/b/case.toml");
  EXPECT_EQ(run.fluidFrame(12), directory / "a/b/frames/fluid_000012.vtp");
  EXPECT_EQ(run.wallsFrame(1234567), directory / "a/b/frames/walls_1234567.vtp");
}

TEST(RunDirectory, AnEmptyDirectoryIsTaken) {
  TemporaryDirectory directory;
  EXPECT_NO_THROW(RunDirectory::create(directory.path(), false));
}

TEST(RunDirectory, FramesAndIndices) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory / "run", false);
  run.writeFrame(frameAt(0, 30), frameAt(0, 20), {});
  run.writeFrame(frameAt(0.1, 30), frameAt(0.1, 20), {});
  EXPECT_EQ(content(run.fluidIndex()),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" part=\"0\" file=\"frames/fluid_000000.vtp\"/>\n"
            "    <DataSet timestep=\"0.1\" part=\"0\" file=\"frames/fluid_000001.vtp\"/>\n"
            "  </Collection>\n</VTKFile>\n");
  const std::set<std::string> expected{"run.log",
                                       "fluid.pvd",
                                       "walls.pvd",
                                       "frames/fluid_000000.vtp",
                                       "frames/fluid_000001.vtp",
                                       "frames/walls_000000.vtp",
                                       "frames/walls_000001.vtp"};
  EXPECT_EQ(filesIn(directory / "run"), expected);
  EXPECT_EQ(readVtp(run.fluidFrame(1)).position.size(), 30u);
  EXPECT_EQ(readVtp(run.wallsFrame(1)).position.size(), 20u);

  RunDirectory opened = RunDirectory::open(directory / "run");
  ASSERT_EQ(opened.frameCount(), 2u);
  EXPECT_EQ(opened.frameTime(1), 0.1);
  opened.writeFrame(frameAt(0.2, 30), frameAt(0.2, 20), {});
  EXPECT_EQ(readPvd(run.wallsIndex()).at(2).file, "frames/walls_000002.vtp");
  EXPECT_EQ(readPvd(run.wallsIndex()).at(0).time, 0);
}

TEST(RunDirectory, PiecesBecomeFrames) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory / "run", false);
  run.writeFrame(frameAt(0, 30), frameAt(0, 20), {});
  const RunDirectory other = RunDirectory::joined(directory / "run");
  const auto writePieces = [&](const RunDirectory& of, int rank, std::uint32_t fluid, std::uint32_t walls) {
    writeVtp(of.fluidPiece(1, rank), frameAt(0.1, fluid), {}, OutputPrecision::Single);
    writeVtp(of.wallsPiece(1, rank), frameAt(0.1, walls), {}, OutputPrecision::Single);
  };
  writePieces(run, 0, 11, 2);
  const std::string message = messageOf<RunError>([&] { run.joinPieces({0.1, 2, {0, 1}, {0, 1}}); });
  EXPECT_NE(message.find("fluid_000001.p1.vtp is not there, but rank 1 has written it"), std::string::npos)
      << message;
  EXPECT_EQ(run.frameCount(), 1u);
  writePieces(other, 1, 19, 18);
  run.joinPieces({0.1, 2, {0, 1}, {0, 1}});
  run.writeFrame(frameAt(0.2, 30), frameAt(0.2, 20), {});
  const std::set<std::string> expected{
      "run.log",
      "fluid.pvd",
      "walls.pvd",
      "frames/fluid_000000.vtp",
      "frames/walls_000000.vtp",
      "frames/fluid_000001.pvtp",
      "frames/fluid_000001.p0.vtp",
      "frames/fluid_000001.p1.vtp",
      "frames/walls_000001.pvtp",
      "frames/walls_000001.p0.vtp",
      "frames/walls_000001.p1.vtp",
      "frames/fluid_000002.vtp",
      "frames/walls_000002.vtp",
  };
  EXPECT_EQ(filesIn(directory / "run"), expected);

  const RunDirectory opened = RunDirectory::open(directory / "run");
  ASSERT_EQ(opened.frameCount(), 3u);
  EXPECT_EQ(opened.frameTime(1), 0.1);
  EXPECT_EQ(opened.fluidFrame(1), directory / "run/frames/fluid_000001.pvtp");
  EXPECT_EQ(opened.wallsFrame(1), directory / "run/frames/walls_000001.pvtp");
  EXPECT_EQ(opened.fluidFrame(2), directory / "run/frames/fluid_000002.vtp");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(readFrame(opened.fluidFrame(k)).position.size(), 30u);
    EXPECT_EQ(readFrame(opened.wallsFrame(k)).position.size(), 20u);
  }
}

TEST(RunDirectory, NobodyNeedsToHaveWalls) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory / "run", false);
  writeVtp(run.fluidPiece(0, 3), frameAt(0.1, 5), {}, OutputPrecision::Single);
  run.joinPieces({0.1, 2, {3}, {}});
  const RunDirectory opened = RunDirectory::open(directory / "run");
  EXPECT_EQ(readFrame(opened.fluidFrame(0)).position.size(), 5u);
  const Frame walls = readFrame(opened.wallsFrame(0));
  EXPECT_TRUE(walls.position.empty());
  EXPECT_EQ(walls.time, 0.1);
  EXPECT_EQ(walls.dimensions, 2);
}

TEST(RunDirectory, AnOldRunNeedsForce) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory.path(), false);
  run.writeFrame(frameAt(0, 3), frameAt(0, 3), {});
  expectRefused(directory.path(), false, "--force");
  EXPECT_EQ(run.frameCount(), 1u);
  EXPECT_TRUE(fs::exists(run.fluidFrame(0)));
}

TEST(RunDirectory, ForceRemovesTheOldRunAndNothingElse) {
  TemporaryDirectory directory;
  std::optional<RunDirectory> old = RunDirectory::create(directory.path(), false);
  RunDirectory& run = *old;
  run.writeFrame(frameAt(0, 3), frameAt(0, 3), {});
  for (const fs::path& path :
       {run.caseFile(), run.log(), run.history(), run.summary(), run.finalPicture(), run.historyPicture(),
        run.framePicture(0), run.checkpoint(), run.fluidFrame(1000000), directory / "history.csv.tmp",
        directory / "frames/walls_000007.vtp.tmp", directory / "frames/fluid_000003.pvtp",
        directory / "frames/walls_000003.pvtp.tmp", directory / "frames/walls_1000003.p12.vtp",
        directory / "frames/fluid_000003.p0.vtp.tmp", run.surfaceIndex(), run.surfaceFile(2, SurfaceFormat::Vtp),
        run.surfaceFile(1000000, SurfaceFormat::Ply), directory / "frames/surface_000003.ply.tmp"})
    put(path, "old");
  put(run.caseFile(), "[[probe]]\nname = \"level\"\n");
  fs::create_directory(directory / "probes");
  for (const char* name : {"probes/level.csv", "probes/level.png", "probes/level.csv.tmp"})
    put(directory / name, "old");
  const std::set<std::string> foreign{"notes.txt",
                                      "probes/experiment.csv",
                                      "probes/figure.png",
                                      "frames/fluid_1.vtp",
                                      "frames/fluid_00000a.vtp",
                                      "frames/my.png",
                                      "frames/surface_3.vtp",
                                      "frames/surface000003.vtp",
                                      "frames/fluid_000003.p.vtp",
                                      "frames/fluid_000003.p1.png",
                                      "frames/fluid_000003.p1.pvtp",
                                      "frames/fluid_000003.p1",
                                      "frames/gas_000003.p1.vtp",
                                      "frames/fluid_000003.q1.vtp",
                                      "frames/fluid_000003.vtp.p1.vtp"};
  for (const std::string& name : foreign) put(directory / name, "mine");

  old.reset();
  const RunDirectory again = RunDirectory::create(directory.path(), true);
  std::set<std::string> left = filesIn(directory.path());
  EXPECT_EQ(left.erase("run.log"), 1u);  // locked by this one
  EXPECT_EQ(left, foreign);
  EXPECT_EQ(again.frameCount(), 0u);
}

TEST(RunDirectory, ForceDoesNotTakeTheUsersCase) {
  TemporaryDirectory directory;
  put(directory / "case.toml", "mine");
  expectRefused(directory.path(), true, "case.toml");
  EXPECT_EQ(content(directory / "case.toml"), "mine");
}

/// A frame that the index could not be written for is none.
TEST(RunDirectory, FramesAreThoseOfTheIndex) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory.path(), false);
  run.writeFrame(frameAt(0, 3), frameAt(0, 3), {});
  fs::create_directory(AtomicFile::temporaryName(run.wallsIndex()));  // in the way
  EXPECT_THROW(run.writeFrame(frameAt(1, 3), frameAt(1, 3), {}), RunError);
  EXPECT_EQ(run.frameCount(), 1u);
  fs::remove(AtomicFile::temporaryName(run.wallsIndex()));
  run.writeFrame(frameAt(2, 3), frameAt(2, 3), {});
  EXPECT_EQ(readPvd(run.fluidIndex()).size(), 2u);
}

TEST(RunDirectory, UnusablePaths) {
  TemporaryDirectory directory;
  put(directory / "file", "text");
  expectRefused(directory / "file", true, "no directory");
  expectRefused(directory / "file/below", false, "cannot be created");
  expectRefused("/proc/treacle-run", false, "cannot be created");
}

TEST(RunDirectory, NotWritable) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  TemporaryDirectory directory;
  fs::permissions(directory.path(), fs::perms::owner_read | fs::perms::owner_exec);
  expectRefused(directory.path(), false, "not writable");
  fs::permissions(directory.path(), fs::perms::owner_all);
}

TEST(RunDirectory, OpenNeedsARun) {
  TemporaryDirectory directory;
  const std::string message = messageOf<InputError>([&] { RunDirectory::open(directory.path()); });
  EXPECT_NE(message.find("fluid.pvd"), std::string::npos) << message;
  put(directory / "fluid.pvd", "<VTKFile type=\"PolyData\" >");
  EXPECT_THROW(RunDirectory::open(directory.path()), InputError);
}

TEST(RunDirectory, ForceDoesNotTakeADirectoryThatARunWritesInto) {
  TemporaryDirectory directory;
  {
    RunDirectory run = RunDirectory::create(directory.path(), false);
    run.writeFrame(frameAt(0, 3), frameAt(0, 3), {});
    const RunDirectory copy = run;
    expectRefused(directory.path(), true, "another run is writing into it");
    EXPECT_TRUE(fs::exists(run.fluidFrame(0)));
  }
  const RunDirectory next = RunDirectory::create(directory.path(), true);
  EXPECT_FALSE(fs::exists(next.fluidFrame(0)));
}

TEST(RunDirectory, OpensWhereARunWasKilledBetweenTheIndices) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory.path(), false);
  run.writeFrame(frameAt(0, 3), frameAt(0, 3), {});
  fs::remove(run.wallsIndex());
  EXPECT_EQ(RunDirectory::open(directory.path()).frameCount(), 1u);
}

TEST(RunDirectory, TheIndexThatMakesItARunComesLast) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory.path(), false);
  fs::create_directory(run.fluidIndex());  // in the way of that file
  EXPECT_THROW(run.writeFrame(frameAt(0, 3), frameAt(0, 3), {}), RunError);
  EXPECT_EQ(readPvd(run.wallsIndex()).size(), 1u);
}

TEST(Pvd, TimesThatAreNoneAreRefused) {
  TemporaryDirectory directory;
  writePvd(directory / "a.pvd", {{0, "a"}, {1, "b"}});
  const std::string sound = content(directory / "a.pvd");
  for (const char* time : {"nan", "inf", "-1", "0", "-nan"}) {
    std::string changed = sound;
    changed.replace(changed.find("timestep=\"1\""), 12, std::string("timestep=\"") + time + '"');
    put(directory / "a.pvd", changed);
    const std::string message = messageOf<InputError>([&] { readPvd(directory / "a.pvd"); });
    EXPECT_NE(message.find(std::string(" of b: expected finite times that ascend")), std::string::npos) << message;
  }
}
