#include "recorder.hpp"

#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/model/particles/create.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "command.hpp"

namespace treacle::test {
namespace {

/// A recorder whose simulation is a number of steps, and may be gone.
struct Recorded {
  Workshop shop;
  Case c;
  std::int64_t step = 0;
  bool gone = false;
  RunDirectory directory;
  RunLog log;
  Recorder recorder;

  Recorded()
      : c((shop.put("case.toml", smallCase), readCase(shop / "case.toml"))),
        directory(RunDirectory::create(shop / "run", false)),
        log(directory.log(), true),
        recorder(c, directory, log, 0, false, {[this](Snapshot& s) { copyState(s); }, {}}) {}

  void copyState(Snapshot& snapshot) {
    std::vector<std::string> notes;
    snapshot.particles = createParticles(c, notes);
    forEachFluidFieldOf(
        [](auto& field) { std::fill(field.begin(), field.end(), std::decay_t<decltype(field[0])>{}); },
        snapshot.particles.of<2>());
    if (gone) throw std::runtime_error("the simulation is gone");
    snapshot.step = step;
    snapshot.time = 1e-3 * static_cast<double>(step);
  }

  void finish() { recorder.writeCheckpoint(), recorder.writeFrame(), recorder.drawPicture(); }
  bool exists(const std::filesystem::path& file) const { return std::filesystem::exists(file); }
};

TEST(Recorder, EndsWithTheLastCopyOfASimulationThatIsLost) {
  Recorded r;
  r.recorder.begin();
  r.step = 3, r.gone = true;
  r.recorder.loseSimulation();
  r.finish();
  EXPECT_EQ(readCheckpoint<2>(r.directory.checkpoint()).step, 0);
  EXPECT_EQ(r.directory.frameCount(), 1u);  // it has been written before
  EXPECT_TRUE(r.exists(r.directory.finalPicture()));
}

TEST(Recorder, WritesNothingOfACopyThatIsNotWhole) {
  Recorded r;
  r.recorder.begin();
  r.recorder.wait();
  r.step = 3, r.gone = true;
  EXPECT_THROW(r.recorder.writeFrame(), std::runtime_error);
  r.recorder.loseSimulation();
  r.finish();
  EXPECT_FALSE(r.exists(r.directory.checkpoint()));
  EXPECT_EQ(r.directory.frameCount(), 1u);
  EXPECT_FALSE(r.exists(r.directory.finalPicture()));
}

TEST(Recorder, KeepsTheCheckpointThatIsAsNewAsTheLastCopy) {
  Recorded r;
  r.recorder.begin();
  r.step = 2;
  r.recorder.writeCheckpoint();
  const auto written = std::filesystem::last_write_time(r.directory.checkpoint());
  r.recorder.loseSimulation();
  r.finish();
  EXPECT_EQ(std::filesystem::last_write_time(r.directory.checkpoint()), written);
  EXPECT_EQ(readCheckpoint<2>(r.directory.checkpoint()).step, 2);
  EXPECT_EQ(r.directory.frameCount(), 2u);  // of the same state
}

/// A recorder of frames in pieces, whose only process writes them at once but says so late, or fails to.
struct RecordedPieces {
  Workshop shop;
  Case c;
  std::int64_t step = 0;
  bool late = false, fails = false;
  std::vector<std::size_t> taken;
  std::vector<PiecedFrame> open;
  RunDirectory directory;
  RunLog log;
  Recorder recorder;

  RecordedPieces()
      : c((shop.put("case.toml", smallCase), readCase(shop / "case.toml"))),
        directory(RunDirectory::create(shop / "run", false)),
        log(directory.log(), true),
        recorder(c, directory, log, 0, false,
                 {[](Snapshot&) { FAIL() << "all particles were asked for"; },
                  {},
                  [this](PieceOrder order, std::size_t frame) { return answer(order, frame); }}) {}

  std::vector<PiecedFrame> answer(PieceOrder order, std::size_t frame) {
    if (order == PieceOrder::Take) {
      Frame piece;
      piece.time = 1e-3 * static_cast<double>(step);
      piece.position.resize(3);
      writeVtp(RunDirectory::joined(directory.path()).fluidPiece(frame, 0), piece, {}, OutputPrecision::Single);
      taken.push_back(frame);
      open.push_back({step, {piece.time, 3, {0}, {}}, {}, {1000, 0.25}});
      return {};
    }
    if (std::exchange(fails, false)) {
      open.clear();
      throw RunError("rank 1: no room");
    }
    return order == PieceOrder::Collect && late ? std::vector<PiecedFrame>{} : std::exchange(open, {});
  }

  void advance() {
    StepReport report;
    report.step = ++step, report.time = 1e-3 * static_cast<double>(step);
    recorder.record(report);
  }
};

TEST(Recorder, PiecesBecomeFramesWhenAllAreThere) {
  RecordedPieces r;
  r.late = true;
  r.recorder.begin();
  r.advance(), r.advance();
  EXPECT_EQ(r.directory.frameCount(), 0u);
  EXPECT_EQ(r.taken, (std::vector<std::size_t>{0, 1, 2}));
  r.late = false;
  r.advance();
  EXPECT_EQ(r.directory.frameCount(), 4u);
  r.recorder.writeFrame();
  EXPECT_EQ(r.taken.size(), 4u) << "the state is in the last frame";
  EXPECT_EQ(readFrame(r.directory.fluidFrame(2)).time, 2e-3);
  RunSummary summary;
  r.recorder.summarise(summary);
  EXPECT_EQ(summary.frames.count, 4u);
  EXPECT_EQ(summary.frames.cost.bytes, 4000u);
  EXPECT_EQ(summary.frames.cost.seconds, 1);
  EXPECT_EQ(readPvd(r.directory.fluidIndex()).at(3).file, "frames/fluid_000003.pvtp");
}

TEST(Recorder, TheStateAtTheStartIsAFrameOnce) {
  RecordedPieces r;
  r.late = true;
  r.recorder.begin();
  r.recorder.writeFrame();
  EXPECT_EQ(r.taken.size(), 1u);
  EXPECT_EQ(r.directory.frameCount(), 1u);
}

TEST(Recorder, NumbersOfPiecesThatFailedAreGivenAnew) {
  RecordedPieces r;
  r.recorder.begin();
  r.advance();
  r.late = true;
  r.advance();
  r.fails = true;
  EXPECT_THROW(r.advance(), RunError);
  EXPECT_EQ(r.directory.frameCount(), 2u);  // that were there before
  r.recorder.writeFrame();
  EXPECT_EQ(r.taken, (std::vector<std::size_t>{0, 1, 2, 3, 2}));
  EXPECT_EQ(r.directory.frameTime(2), 3e-3);
}

}  // namespace
}  // namespace treacle::test
