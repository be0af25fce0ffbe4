#include "recorder.hpp"

#include "treacle/core/error.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/io/checkpoint.hpp"
#include "treacle/model/create.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

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
        recorder(c, directory, log, 0, false, [this](Snapshot& s) { copyState(s); }) {}

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

}  // namespace
}  // namespace treacle::test
