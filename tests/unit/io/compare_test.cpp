#include "treacle/io/compare/compare.hpp"

#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace treacle;
using namespace treacle::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Case referenceCase() {
  Case c;
  c.dimensions = 2;
  c.spacing = 1e-3;
  c.domain.max = {{20e-3, 20e-3}};
  c.materials.push_back({"honey", 1400, 10, 1e4, 1e6});
  c.bodies.push_back({"drop", BodyKind::Fluid, 0, {}, {ShapeKind::Box, {}, {{5e-3, 5e-3}}}});
  c.time = {1e-3, 1};
  return c;
}

/// Four particles at the corners of a square of 3 mm, at rest but for the first, which moves at 2 m/s.
Frame square() {
  Frame f;
  f.dimensions = 2;
  f.position = {{{0, 0}}, {{3e-3, 0}}, {{0, 3e-3}}, {{3e-3, 3e-3}}};
  f.velocity = {{{2, 0}}, {}, {}, {}};
  f.pressure = {3, 0, 0, -4};
  f.numberDensity = {1, 1, 1, 1};
  f.material = {0, 0, 0, 0};
  f.id = {0, 1, 2, 3};
  return f;
}

template <class T>
void reverse(std::vector<T>& values) {
  std::reverse(values.begin(), values.end());
}

void writeRun(const std::filesystem::path& path, const std::vector<Frame>& frames,
              const OutputFields& fields = {}) {
  RunDirectory run = RunDirectory::create(path, false);
  writeFile(run.caseFile(), caseText(referenceCase()));
  Frame walls;
  for (const Frame& frame : frames) {
    walls.time = frame.time;
    run.writeFrame(frame, walls, {.fields = fields, .precision = OutputPrecision::Double});
  }
  HistoryWriter history(run.history());
  for (std::size_t k = 1; k < frames.size(); ++k)
    history.append({.step = static_cast<int>(k), .time = frames[k].time, .iterations = 7});
}

/// The square, moved along x by `shift` [m] per frame, at the times.
std::vector<Frame> framesAt(const std::vector<double>& times, double shift = 0) {
  std::vector<Frame> frames;
  for (const double time : times) {
    frames.push_back(square());
    frames.back().time = time;
    for (Vec<3>& x : frames.back().position) x[0] += shift * static_cast<double>(frames.size() - 1);
  }
  return frames;
}

RunDifference compared(const std::filesystem::path& a, const std::filesystem::path& b) {
  return compareRuns(RunDirectory::open(a), RunDirectory::open(b));
}

}  // namespace

TEST(CompareFrames, MeasuresEveryField) {
  Frame a = square();
  a.position[3] += Vec<3>{{0.3e-3, 0.4e-3}};
  a.velocity[0] = {{2, 0.5}};
  a.velocity[1] = {{0, -1}};
  a.pressure[1] = 2;
  const FrameDifference d = compareFrames(a, square(), referenceCase());
  EXPECT_NEAR(d[ComparedField::Position]->maximum, 0.5e-3, 1e-15);
  EXPECT_NEAR(d[ComparedField::Position]->rms, 0.25e-3, 1e-15);
  // The fluid is 3 mm + one spacing long.
  EXPECT_NEAR(d[ComparedField::Position]->relative, 0.25 / 4, 1e-12);
  EXPECT_DOUBLE_EQ(d[ComparedField::Velocity]->maximum, 1);
  EXPECT_DOUBLE_EQ(d[ComparedField::Velocity]->rms, std::sqrt(1.25 / 4));
  EXPECT_DOUBLE_EQ(d[ComparedField::Velocity]->relative, std::sqrt(1.25) / 2);
  EXPECT_DOUBLE_EQ(d[ComparedField::Pressure]->maximum, 2);
  EXPECT_DOUBLE_EQ(d[ComparedField::Pressure]->relative, 2.0 / 5);
  EXPECT_EQ(d[ComparedField::NumberDensity]->maximum, 0);
  EXPECT_EQ(d[ComparedField::NumberDensity]->relative, 0);
}

TEST(CompareFrames, MatchesParticlesById) {
  const Frame b = sampleFrame(3, 1000);
  Frame a = b;
  reverse(a.position), reverse(a.velocity), reverse(a.pressure), reverse(a.numberDensity),
      reverse(a.nearestDistance), reverse(a.id);
  for (const auto& d : compareFrames(a, b, referenceCase()).fields) EXPECT_EQ(d->maximum, 0);
  reverse(a.id);
  for (const auto& d : compareFrames(a, b, referenceCase()).fields) EXPECT_GT(d->maximum, 0);
}

TEST(CompareFrames, PositionsOnPeriodicAxes) {
  Frame a = square(), b = square();
  a.position[0][0] = 19.9e-3, b.position[0][0] = 0.1e-3;
  Case c = referenceCase();
  EXPECT_NEAR(compareFrames(a, b, c)[ComparedField::Position]->maximum, 19.8e-3, 1e-15);
  c.domain.periodic[0] = true;
  EXPECT_NEAR(compareFrames(a, b, c)[ComparedField::Position]->maximum, 0.2e-3, 1e-15);
}

TEST(CompareFrames, DifferenceFromNothingIsInfinite) {
  Frame b = square();
  b.velocity[0] = {};
  const FrameDifference d = compareFrames(square(), b, referenceCase());
  EXPECT_EQ(d[ComparedField::Velocity]->relative, infinity);
  EXPECT_EQ(compareFrames(b, b, referenceCase())[ComparedField::Velocity]->relative, 0);
}

TEST(CompareFrames, NotANumberShows) {
  Frame a = square();
  a.pressure[2] = std::nan("");
  const auto d = compareFrames(a, square(), referenceCase())[ComparedField::Pressure];
  EXPECT_TRUE(std::isnan(d->maximum));
  EXPECT_TRUE(std::isnan(d->rms));
  EXPECT_TRUE(std::isnan(d->relative));
}

TEST(CompareFrames, FieldsThatOneDoesNotHold) {
  Frame a = square(), b = square();
  a.velocity.clear(), b.pressure.clear();
  const FrameDifference d = compareFrames(a, b, referenceCase());
  EXPECT_TRUE(d[ComparedField::Position]);
  EXPECT_FALSE(d[ComparedField::Velocity]);
  EXPECT_FALSE(d[ComparedField::Pressure]);
}

TEST(CompareFrames, RefusesOtherParticles) {
  const auto message = [](auto change) {
    Frame a = square();
    change(a);
    return messageOf<InputError>([&] { compareFrames(a, square(), referenceCase()); });
  };
  EXPECT_EQ(message([](Frame& a) { a.id[3] = 7; }), "particle 3 is in only one of them");
  const auto twice = [] {
    Frame f = square();
    f.id[2] = 1;
    compareFrames(f, f, referenceCase());
  };
  EXPECT_EQ(messageOf<InputError>(twice), "two particles have the id 1");
  EXPECT_EQ(message([](Frame& a) { a.id.clear(); }),
            "particles have no ids; expected 'id' in output.fields of both runs");
  EXPECT_EQ(message([](Frame& a) { a = sampleFrame(2, 5); }), "5 and 4 fluid particles");
  EXPECT_EQ(message([](Frame& a) { a.dimensions = 3; }), "3 and 2 dimensions");
}

TEST(CompareRuns, MatchesFramesByTime) {
  TemporaryDirectory directory;
  writeRun(directory / "a", framesAt({0, 0.1, 0.25, 0.3 * (1 + 1e-12)}, 1e-3));
  writeRun(directory / "b", framesAt({0, 0.1, 0.2, 0.3, 0.4}));
  const RunDifference d = compared(directory / "a", directory / "b");
  ASSERT_EQ(d.frames.size(), 3u);
  EXPECT_EQ(d.frames[2].time, 0.3);
  EXPECT_EQ(d.frames[2].frameA, 3u);
  EXPECT_EQ(d.frames[2].frameB, 3u);
  EXPECT_NEAR(d.frames[2][ComparedField::Position]->maximum, 3e-3, 1e-15);
  EXPECT_EQ(d.onlyInA, (std::vector<double>{0.25}));
  EXPECT_EQ(d.onlyInB, (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(d.history.rows, 2u);
}

TEST(CompareRuns, RefusesWhatCannotBeMatched) {
  TemporaryDirectory directory;
  const auto path = [&](const char* name) { return (directory / name).string(); };
  writeRun(directory / "a", framesAt({0.1, 0.2}));
  writeRun(directory / "later", framesAt({0.3, 0.4}));
  EXPECT_EQ(messageOf<InputError>([&] { compared(directory / "a", directory / "later"); }),
            path("a") + " and " + path("later") + ": no frames have the same time");
  OutputFields withoutId;
  withoutId.id = false;
  writeRun(directory / "anonymous", framesAt({0.1}), withoutId);
  EXPECT_EQ(messageOf<InputError>([&] { compared(directory / "anonymous", directory / "a"); }),
            path("anonymous/frames/fluid_000000.vtp") + " and " + path("a/frames/fluid_000000.vtp") +
                " cannot be compared: particles have no ids; expected 'id' in output.fields of both runs");
  std::filesystem::remove(directory / "a/history.csv");
  EXPECT_NE(messageOf<InputError>([&] { compared(directory / "a", directory / "a"); }).find("history.csv"),
            std::string::npos);
}

TEST(FirstExcess, IsTheWorstFieldOfTheFirstFrameBeyondTheBound) {
  RunDifference d;
  const auto add = [&](double position, double velocity, double pressure) {
    d.frames.push_back({0.1 * static_cast<double>(d.frames.size()), 0, 0, {}});
    d.frames.back().fields = {FieldDifference{0, 0, position}, FieldDifference{0, 0, velocity},
                              FieldDifference{0, 0, pressure}, std::nullopt};
  };
  add(0, 0, 1), add(1e-5, 1e-6, 1), add(2e-5, 3e-5, 1), add(1, 0, 1);
  const std::vector<ComparedField> motion{ComparedField::Position, ComparedField::Velocity};
  const auto excess = firstExcess(d, motion, 1e-5);
  ASSERT_TRUE(excess);
  EXPECT_EQ(excess->index, 2u);
  EXPECT_EQ(excess->field, ComparedField::Velocity);
  EXPECT_FALSE(firstExcess(d, motion, 1));
  EXPECT_EQ(firstExcess(d, motion, 0)->index, 1u);
  EXPECT_EQ(firstExcess(d, std::vector{ComparedField::Pressure}, 1e-5)->index, 0u);
  d.frames[1].fields[0]->relative = std::nan("");
  EXPECT_EQ(firstExcess(d, motion, 1)->index, 1u);
  EXPECT_EQ(messageOf<InputError>([&] { firstExcess(d, std::vector{ComparedField::NumberDensity}, 1); }),
            "'number_density' cannot be compared, frame 0 or 0 (t = 0 s) does not hold it; expected "
            "'number_density' in output.fields of both runs");
}

TEST(CompareHistories, OverCommonTimes) {
  std::vector<HistoryRow> a, b;
  for (int k = 1; k <= 20; ++k)
    b.push_back({.step = k, .time = k * 1e-3, .iterations = 100, .kineticEnergy = 4, .frontX = 0.02, .top = 0.1});
  for (int k = 6; k <= 18; ++k) {
    a.push_back(b[static_cast<std::size_t>(k - 1)]);
    a.back().iterations = k == 10 ? 97 : k == 17 ? 120 : 100;  // 17 is no longer early
  }
  a.back().frontX = 0.021, a.back().kineticEnergy = 3;
  a.push_back({.step = 99, .time = 0.0185, .iterations = 1000});
  const HistoryDifference d = compareHistories(a, b);
  EXPECT_EQ(d.rows, 13u);
  EXPECT_NEAR(d.meanIterationsA, (11 * 100 + 97 + 120) / 13.0, 1e-12);
  EXPECT_EQ(d.meanIterationsB, 100);
  EXPECT_EQ(d.earlyIterations, 3);
  EXPECT_EQ(d.time, b[17].time);
  EXPECT_NEAR(d.frontX, 0.05, 1e-12);
  EXPECT_EQ(d.top, 0);
  EXPECT_DOUBLE_EQ(d.kineticEnergy, 0.25);
  EXPECT_EQ(compareHistories({}, b).rows, 0u);
}

TEST(WriteFrameDifferences, FormatIsFixed) {
  TemporaryDirectory directory;
  FrameDifference d{0.25, 2, 3, {}};
  d.fields = {FieldDifference{0.5, 0.125, 1e-7}, std::nullopt, FieldDifference{1, 2, infinity}, std::nullopt};
  writeFrameDifferences(directory / "table.csv", std::vector{d});
  EXPECT_EQ(content(directory / "table.csv"),
            "time,frame_a,frame_b,position_max,position_rms,position_relative,velocity_max,velocity_rms,"
            "velocity_relative,pressure_max,pressure_rms,pressure_relative,number_density_max,number_density_rms,"
            "number_density_relative,nearest_distance_max,nearest_distance_rms,nearest_distance_relative\n"
            "0.25,2,3,0.5,0.125,1e-07,,,,1,2,inf,,,,,,\n");
}
