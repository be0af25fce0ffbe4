#include "treacle/io/surface/free_surface.hpp"

#include "limited_files.hpp"
#include "shapes/mesh_format.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>

using namespace treacle;
using namespace treacle::test;

namespace {

constexpr double surfaceSpacing = 2e-3;  // [m]

/// Lattice places, counted in spacings, that lie in a box of whole numbers and for which `isIn`; the lattice has
/// its particles in the middles of cells.
Frame latticeFrame(int length, const std::function<bool(const Vec<3>&)>& isIn) {
  Frame frame;
  for (int x = -length; x < length; ++x)
    for (int y = -length; y < length; ++y)
      for (int z = -length; z < length; ++z)
        if (const Vec<3> at{x + 0.5, y + 0.5, z + 0.5}; isIn(at)) frame.position.push_back(surfaceSpacing * at);
  return frame;
}

Frame ball(double radius, const Vec<3>& middle = {}) {
  return latticeFrame(static_cast<int>(radius) + 2, [&](const Vec<3>& x) { return norm(x - middle) < radius; });
}

Vec<3> at(const FreeSurface& surface, std::uint32_t point) { return converted<double>(surface.points[point]); }

/// Enclosed, over that of as many cells of the lattice; negative where triangles look inwards.
double volumeRatio(const FreeSurface& surface, std::size_t particles) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += dot(at(surface, a), cross(at(surface, b), at(surface, c))) / 6;
  return volume / (static_cast<double>(particles) * std::pow(surfaceSpacing, 3));
}

/// Each side of a triangle has one on its other side, which runs along it the other way; and the surface consists
/// of so many that are without holes (Euler's number is 2 for each).
void expectClosed(const FreeSurface& surface, std::size_t bodies = 1) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  for (const auto& [side, count] : sides) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(sides.count({side.second, side.first}), 1u);
  }
  EXPECT_EQ(surface.points.size(), 2 * bodies + surface.triangles.size() / 2);
}

/// Largest angle between the triangles on either side of an edge [degrees], slivers apart.
double largestAngle(const FreeSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec<3>> normals;
  for (const auto& t : surface.triangles) {
    const Vec<3> area = cross(at(surface, t[1]) - at(surface, t[0]), at(surface, t[2]) - at(surface, t[0]));
    if (norm(area) < 1e-3 * surfaceSpacing * surfaceSpacing) continue;
    for (std::size_t k = 0; k < 3; ++k) normals[{t[k], t[(k + 1) % 3]}] = 1 / norm(area) * area;
  }
  double least = 1;
  for (const auto& [side, normal] : normals)
    if (const auto other = normals.find({side.second, side.first}); other != normals.end())
      least = std::min(least, dot(normal, other->second));
  return std::acos(least) * 180 / std::numbers::pi;
}

Frame slab(int layers) {
  return latticeFrame(10, [&](const Vec<3>& x) { return x[2] > 0 && x[2] < layers; });
}

/// A ball whose fields follow the place.
Frame ballWithFields() {
  Frame frame = ball(5);
  frame.time = 0.25;
  for (const Vec<3>& x : frame.position) {
    frame.velocity.push_back({1, 2, x[2] / surfaceSpacing});
    frame.pressure.push_back(1e4 * x[0] / surfaceSpacing);
    frame.temperature.push_back(300);
    frame.material.push_back(x[0] < 0 ? 0 : 3);
  }
  return frame;
}

class FreeSurfaceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasFreeSurface()) GTEST_SKIP() << whyNoFreeSurface();
  }
};

}  // namespace

TEST_F(FreeSurfaceTest, OfABallIsClosedAndSmoothAndHoldsItsVolume) {
  const Vec<3> middle{0.2, -0.1, 0.3};
  const Frame frame = ball(10, middle);
  const FreeSurface surface = freeSurface(frame, surfaceSpacing);
  expectClosed(surface);
  EXPECT_NEAR(volumeRatio(surface, frame.position.size()), 1, 0.015);  // 0.988
  EXPECT_LT(largestAngle(surface), 25);                                // 23.3
  double nearest = 1e9, farthest = 0, outwards = 1;
  for (std::uint32_t p = 0; p < surface.points.size(); ++p) {
    const Vec<3> x = 1 / surfaceSpacing * at(surface, p) - middle;
    nearest = std::min(nearest, norm(x)), farthest = std::max(farthest, norm(x));
    outwards = std::min(outwards, dot(x, converted<double>(surface.normals[p])) / norm(x));
  }
  EXPECT_GT(nearest, 9.6);    // 9.66
  EXPECT_LT(farthest, 10.4);  // 10.32
  EXPECT_GT(outwards, 0.85);  // 0.87
}

TEST_F(FreeSurfaceTest, OfACuboidIsFlatAndWhereItsCellsEnd) {
  const Frame frame = latticeFrame(12, [](const Vec<3>& x) { return std::abs(x[0]) < 10 && std::abs(x[1]) < 8; });
  struct Bounds {
    double cell, volume, unevenness;  // measured: 0.9925, 0.9909, 0.9859; 0.0004, 0.0035, 0.030
  };
  for (const Bounds& b : {Bounds{0.25, 0.01, 0.001}, Bounds{0.5, 0.011, 0.005}, Bounds{1, 0.016, 0.04}}) {
    const FreeSurface surface = freeSurface(frame, surfaceSpacing, b.cell);
    expectClosed(surface);
    EXPECT_NEAR(volumeRatio(surface, frame.position.size()), 1, b.volume);
    double worst = 0;
    std::size_t flat = 0;
    for (std::uint32_t p = 0; p < surface.points.size(); ++p)
      if (const Vec<3> x = 1 / surfaceSpacing * at(surface, p); std::abs(x[1]) < 6 && std::abs(x[2]) < 10) {
        worst = std::max(worst, std::abs(std::abs(x[0]) - 10));
        ++flat;
      }
    EXPECT_GT(flat, 400u);
    EXPECT_LT(worst, b.unevenness) << b.cell;
  }
}

TEST_F(FreeSurfaceTest, SheetsAndDropsOfFewParticlesStay) {
  const double volumes[] = {0.76, 0.93, 0.95};  // 0.768, 0.940, 0.959: their rims are rounded
  for (const int layers : {1, 2, 3}) {
    const Frame frame = slab(layers);
    const FreeSurface surface = freeSurface(frame, surfaceSpacing);
    expectClosed(surface);
    EXPECT_GT(volumeRatio(surface, frame.position.size()), volumes[layers - 1]) << layers;
    EXPECT_LT(volumeRatio(surface, frame.position.size()), 1) << layers;
  }
  Frame drops;
  for (int k = 0; k < 5; ++k) drops.position.push_back(surfaceSpacing * Vec<3>{7.0 * k, 1.3 * k, -0.7 * k});
  for (const double cell : {0.25, 0.5, 1.0}) {
    const FreeSurface surface = freeSurface(drops, surfaceSpacing, cell);
    expectClosed(surface, 5);
    EXPECT_NEAR(volumeRatio(surface, 5), 1, 0.1) << cell;  // 0.934, 1.011, 1.088
  }
}

TEST_F(FreeSurfaceTest, DisorderAndCavitiesAreNoHoles) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> shift(-0.15 * surfaceSpacing, 0.15 * surfaceSpacing);
  // Large enough for blocks deep inside, which are not computed, on either side of the cavity.
  Frame frame = latticeFrame(24, [](const Vec<3>& x) { return norm(x) > 5; });
  for (Vec<3>& x : frame.position)
    for (int k = 0; k < 3; ++k) x[k] += shift(generator);
  const FreeSurface surface = freeSurface(frame, surfaceSpacing);
  expectClosed(surface, 2);
  EXPECT_NEAR(volumeRatio(surface, frame.position.size()), 1, 0.01);
}

TEST_F(FreeSurfaceTest, HasTheFieldsOfTheFluidBelowIt) {
  const Frame frame = ballWithFields();
  const FreeSurface surface = freeSurface(frame, surfaceSpacing);
  EXPECT_EQ(surface.time, 0.25);
  ASSERT_EQ(surface.fields.size(), 3u);
  EXPECT_EQ(surface.fields[0].name + surface.fields[1].name + surface.fields[2].name,
            "velocitypressuretemperature");
  double farthest = 0;  // between a point and where the fluid has such a pressure or velocity [spacings]
  bool constant = true, divided = true;
  for (std::uint32_t p = 0; p < surface.points.size(); ++p) {
    const Vec<3> x = 1 / surfaceSpacing * at(surface, p);
    const float* u = &surface.fields[0].values[3 * p];
    farthest = std::max({farthest, std::abs(surface.fields[1].values[p] / 1e4 - x[0]), std::abs(u[2] - x[2])});
    constant = constant && std::abs(u[0] - 1) < 1e-6 && std::abs(u[1] - 2) < 1e-6 &&
               std::abs(surface.fields[2].values[p] - 300) < 1e-4;
    divided = divided && (std::abs(x[0]) < 0.5 || surface.material[p] == (x[0] < 0 ? 0 : 3));
  }
  EXPECT_LT(farthest, 1);
  EXPECT_TRUE(constant);
  EXPECT_TRUE(divided);
}

TEST_F(FreeSurfaceTest, IsTheSameWhateverTheNumberOfThreads) {
  const Frame frame = ballWithFields();
  const int threads = omp_get_max_threads();
  std::vector<FreeSurface> made;
  for (const int k : {1, 3}) {
    omp_set_num_threads(k);
    made.push_back(freeSurface(frame, surfaceSpacing));
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(made[0].triangles, made[1].triangles);
  EXPECT_EQ(made[0].points, made[1].points);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(made[0].fields[k].values, made[1].fields[k].values);
}

TEST_F(FreeSurfaceTest, FilesHoldIt) {
  TemporaryDirectory directory;
  const FreeSurface surface = freeSurface(ballWithFields(), surfaceSpacing);
  for (const OutputCompression compression : {OutputCompression::None, OutputCompression::Zlib}) {
    const auto bytes = writeSurfaceVtp(directory / "a.vtp", surface, compression);
    EXPECT_EQ(bytes, std::filesystem::file_size(directory / "a.vtp"));
    const Frame points = readVtp(directory / "a.vtp");  // who reads particles takes the points for such
    ASSERT_EQ(points.position.size(), surface.points.size());
    for (std::uint32_t p = 0; p < surface.points.size(); ++p) {
      ASSERT_EQ(points.position[p], at(surface, p));
      ASSERT_EQ(points.velocity[p][2], double(surface.fields[0].values[3 * p + 2]));
    }
    EXPECT_EQ(points.material, surface.material);
  }
  EXPECT_NE(
      content(directory / "a.vtp").find("NumberOfPolys=\"" + std::to_string(surface.triangles.size()) + "\""),
      std::string::npos);

  const auto bytes = writeSurfacePly(directory / "a.ply", surface);
  EXPECT_EQ(bytes, std::filesystem::file_size(directory / "a.ply"));
  const Mesh mesh(readPly("a.ply", content(directory / "a.ply")));
  EXPECT_EQ(mesh.facts().triangles, surface.triangles.size());
  EXPECT_EQ(mesh.facts().openEdges, 0u);
  EXPECT_NEAR(mesh.facts().volume, volumeRatio(surface, 1) * std::pow(surfaceSpacing, 3),
              1e-6 * mesh.facts().volume);
}

TEST_F(FreeSurfaceTest, FullDiskLeavesNoFile) {
  TemporaryDirectory directory;
  const FreeSurface surface = freeSurface(ball(5), surfaceSpacing);
  EXPECT_TRUE(withFileLimit(10 << 10, [&] {
    return !messageOf<RunError>([&] { writeSurfacePly(directory / "a.ply", surface); }).empty() &&
           !messageOf<RunError>([&] { writeSurfaceVtp(directory / "a.vtp", surface, {}); }).empty();
  }));
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST_F(FreeSurfaceTest, ParticlesThatLieNowhereAreLeftOut) {
  Frame frame = ball(3);
  const std::size_t triangles = freeSurface(frame, surfaceSpacing).triangles.size();
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double x : {nan, infinity, -infinity, 1e300, -1e10}) frame.position.push_back({0, x, 0});
  const FreeSurface surface = freeSurface(frame, surfaceSpacing);
  EXPECT_EQ(surface.leftOut, 5u);
  EXPECT_EQ(surface.triangles.size(), triangles);
  EXPECT_TRUE(freeSurface({}, surfaceSpacing).points.empty());
}

TEST_F(FreeSurfaceTest, TwoDimensionsHaveNone) {
  Frame frame = ball(3);
  frame.dimensions = 2;
  EXPECT_NE(messageOf<InputError>([&] { freeSurface(frame, surfaceSpacing); }).find("two dimensions"),
            std::string::npos);
}

TEST_F(FreeSurfaceTest, ARunHasAnIndexOfThoseThatAreThere) {
  TemporaryDirectory directory;
  RunDirectory run = RunDirectory::create(directory / "run", false);
  Frame frame = ball(3);
  for (const double time : {0.0, 0.5, 1.0}) {
    frame.time = time;
    run.writeFrame(frame, {}, {});
  }
  const FreeSurface surface = freeSurface(frame, surfaceSpacing);
  run.writeSurface(1, surface, SurfaceFormat::Ply, OutputCompression::Zlib);
  EXPECT_FALSE(std::filesystem::exists(run.surfaceIndex()));
  for (const std::size_t k : {2, 0}) run.writeSurface(k, surface, SurfaceFormat::Vtp, OutputCompression::Zlib);
  const std::vector<PvdEntry> index = readPvd(run.surfaceIndex());
  ASSERT_EQ(index.size(), 2u);
  EXPECT_EQ(index[0].time, 0);
  EXPECT_EQ(index[1].time, 1);
  EXPECT_EQ(index[1].file, "frames/surface_000002.vtp");
  EXPECT_TRUE(std::filesystem::exists(directory / ("run/" + index[1].file)));
}
