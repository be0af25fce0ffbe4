#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "command.hpp"
#include "support/mph_case.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/io/run_directory.hpp"
#include "treacle/io/vtp.hpp"
#include "treacle/model/create.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Import : public testing::Test {
 protected:
  Import() {
    shop.put("box.data", mphParameters);
    shop.put("box.boid", mphCuboids);
    shop.put("box.grid", mphParticles);
  }
  /// Particles of a case file there.
  template <int D>
  Particles<D> particlesOf(const std::string& name) const {
    std::vector<std::string> notes;
    Particles<D> particles = createParticles<D>(readCase(shop / name), notes);
    EXPECT_THAT(notes, IsEmpty());
    return particles;
  }
  Workshop shop;
};

TEST_F(Import, cuboidsBecomeBoxes) {
  const Outcome outcome = shop.call("import box.data box.boid");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_EQ(outcome.out, "box.toml\n2 dimensions, 24 fluid and 104 wall particles\n");
  const Case c = readCase(shop / "box.toml");
  EXPECT_EQ(c.dimensions, 2);
  EXPECT_EQ(c.domain.periodic, (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(c.method.scheme, SchemeKind::Published);
  EXPECT_DOUBLE_EQ(c.pressureRadius(), 1.8e-3);
  EXPECT_DOUBLE_EQ(c.densityRadius(), 1.8e-3);
  EXPECT_DOUBLE_EQ(c.viscosityRadius(), 3.4e-3);
  ASSERT_EQ(c.materials.size(), 3u);
  EXPECT_EQ(c.materials[2].name, "wall3");
  EXPECT_EQ(c.materials[2].density, 800);
  EXPECT_EQ(c.materials[0].dynamicViscosity, 20);
  EXPECT_EQ(c.materials[0].bulkViscosity, 2e4);
  EXPECT_EQ(c.materials[0].bulkModulus, 2e6);
  EXPECT_EQ(c.time.step, 1e-3);
  EXPECT_EQ(c.time.end, 4e-3);
  EXPECT_EQ(c.output.interval, 2e-3);
  EXPECT_EQ(c.output.checkpointInterval, 5e-3);
  EXPECT_EQ(c.bodies[0].velocity, (Vec<3>{0.25, -0.5, 0}));
}

TEST_F(Import, bothFormatsGiveTheSameParticlesAndSteps) {
  ASSERT_EQ(shop.call("import box.data box.boid -o boid.toml").exitCode, 0);
  const Outcome outcome = shop.call("import box.data box.grid -o grid.toml");
  EXPECT_EQ(outcome.out,
            "grid-fluid1.csv\ngrid-wall2.csv\ngrid-wall3.csv\ngrid.toml\n"
            "2 dimensions, 24 fluid and 104 wall particles\n");
  EXPECT_THAT(outcome.err, IsEmpty());
  const auto boid = particlesOf<2>("boid.toml"), grid = particlesOf<2>("grid.toml");
  ASSERT_EQ(boid.position.size(), 128u);
  ASSERT_EQ(grid.position.size(), 128u);
  for (std::size_t i = 0; i < 128; ++i) {
    EXPECT_LT(norm(boid.position[i] - grid.position[i]), 1e-15);
    EXPECT_EQ(boid.velocity[i], grid.velocity[i]);
    EXPECT_EQ(boid.material[i], grid.material[i]);
  }
  EXPECT_LT(norm(boid.position[0] - Vec<2>{0.5e-3, 0.5e-3}), 1e-15) << "half a spacing inside of the cuboid";
  for (const char* name : {"boid", "grid"}) {
    EXPECT_THAT(shop.call(std::string("check ") + name + ".toml").err, IsEmpty());
    ASSERT_EQ(shop.call(std::string("run ") + name + ".toml -q --threads 1").exitCode, 0);
  }
  // Positions differ by rounding, of which the solves, to 1e-12 of the squares, make 1e-7.
  const Outcome compared = shop.call("compare boid-run grid-run --bound 1e-6");
  EXPECT_EQ(compared.exitCode, 0) << compared.out;
  const RunDirectory run = RunDirectory::open(shop / "boid-run");
  EXPECT_EQ(run.frameCount(), 3u);
  EXPECT_NE(readVtp(run.fluidFrame(2)).position, readVtp(run.fluidFrame(0)).position);
}

TEST_F(Import, threeDimensionsWithWallsThatMove) {
  shop.put("box.data", replaced(replaced(mphParameters, "Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0",
                                         "Wall2  Center 1e-3 2e-3 0  Velocity 0.5 0 0.25  Omega 0 -3 4"),
                                "0 -10 0", "0 0 -10"));
  const std::string cuboid =
      "StartCuboid\nSpacing 1e-3\nType {}\nLower 0 0 {}\nUpper 4e-3 4e-3 {}\nVelocity 0 0 {}\nEndCuboid\n";
  shop.put("box.boid", "ParticleDistance 1e-3\nLowerDomain -8e-3 -8e-3 -8e-3\nUpperDomain 8e-3 8e-3 8e-3\n" +
                           fmt::format(fmt::runtime(cuboid), 0, "0", "4e-3", "0.125") +
                           fmt::format(fmt::runtime(cuboid), 2, "-4e-3", "0", "0"));
  shop.put("box.grid", "0\n128 1e-3 -8e-3 8e-3 -8e-3 8e-3 -8e-3 8e-3\n" +
                           mphRows(0, {0, 0, 0}, 4, 4, 4, "0 0 0.125") + mphRows(2, {0, 0, -4}, 4, 4, 4, "0 0 0"));
  ASSERT_EQ(shop.call("import box.data box.boid -o boid.toml").exitCode, 0);
  ASSERT_EQ(shop.call("import box.data box.grid -o grid.toml").exitCode, 0);
  for (const char* name : {"boid.toml", "grid.toml"}) {
    const Case c = readCase(shop / name);
    EXPECT_EQ(c.dimensions, 3);
    ASSERT_EQ(c.bodies.size(), 2u);
    EXPECT_EQ(c.bodies[0].velocity, (Vec<3>{0, 0, 0.125}));
    EXPECT_EQ(c.bodies[1].kind, BodyKind::Wall);
    EXPECT_EQ(c.bodies[1].velocity, (Vec<3>{0.5, 0, 0.25}));
    EXPECT_EQ(c.bodies[1].rotation, (Rotation{{1e-3, 2e-3, 0}, {0, -3, 4}, 5}));
  }
  const auto boid = particlesOf<3>("boid.toml"), grid = particlesOf<3>("grid.toml");
  ASSERT_EQ(boid.position.size(), 128u);
  ASSERT_EQ(grid.position.size(), 128u);
  for (std::size_t i = 0; i < 128; ++i) {
    EXPECT_LT(norm(boid.position[i] - grid.position[i]), 1e-15);
    EXPECT_LT(norm(boid.velocity[i] - grid.velocity[i]), 1e-12);
  }
  // Omega x (x - center) + velocity.
  const Vec<3> x = boid.position[64] - Vec<3>{1e-3, 2e-3, 0};
  EXPECT_LT(norm(boid.velocity[64] - (Vec<3>{0.5, 0, 0.25} + cross(Vec<3>{0, -3, 4}, x))), 1e-12);
  EXPECT_EQ(shop.call("run grid.toml -q --threads 1 --end-time 1e-3").exitCode, 0);
}

TEST_F(Import, turnsWallsInThePlane) {
  shop.put("box.data", replaced(mphParameters, "Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0",
                                "Wall2  Center -2e-3 2e-3 0  Velocity 0 0 0  Omega 0 0 -2"));
  ASSERT_EQ(shop.call("import box.data box.boid").exitCode, 0);
  EXPECT_EQ(readCase(shop / "box.toml").bodies[1].rotation, (Rotation{{-2e-3, 2e-3, 0}, {0, 0, 1}, -2}));
}

TEST_F(Import, leavesNothingAfterBadInput) {
  shop.put("box.grid", mphParticles.substr(0, mphParticles.size() / 2));
  const Outcome truncated = shop.call("import box.data box.grid");
  EXPECT_EQ(truncated.exitCode, 2);
  EXPECT_THAT(truncated.err, StartsWith("treacle: error: box.grid:"));
  EXPECT_THAT(truncated.out, IsEmpty());
  // Fluid in a wall.
  shop.put("box.boid", replaced(mphCuboids, "Lower     0 0 -0.5e-3", "Lower -1e-3 0 -0.5e-3"));
  const Outcome overlap = shop.call("import box.data box.boid");
  EXPECT_EQ(overlap.exitCode, 2);
  EXPECT_THAT(overlap.err,
              HasSubstr("box.boid: fluid body 'fluid1-cuboid1' and wall body 'wall2-cuboid2' overlap"));
  // Far more particles than there can be.
  std::string fine = mphCuboids;
  for (const char* key : {"ParticleDistance  1e-3", "Spacing   1e-3", "Spacing   1e-3", "Spacing   1e-3"})
    fine = replaced(fine, key, std::string(key, std::string_view(key).size() - 4) + "3e-8");
  shop.put("box.boid", fine);
  const Outcome many = shop.call("import box.data box.boid");
  EXPECT_EQ(many.exitCode, 2);
  EXPECT_THAT(many.err, HasSubstr("box.boid: the case would have "));
  shop.put("box.boid", replaced(mphCuboids, "14e-3 14e-3  2e-3", "1e9 1e9 2e-3"));
  EXPECT_EQ(shop.call("import box.data box.boid").exitCode, 2);
  EXPECT_EQ(shop.call("import box.data missing.grid").exitCode, 2);
  EXPECT_THAT(shop.call("import box.boid box.data").err, HasSubstr("expected a file with particles, .grid, or"));
  EXPECT_THAT(shop.call("import box.data").err, HasSubstr("PARTICLES"));
  EXPECT_FALSE(std::filesystem::exists(shop / "box.toml"));
  EXPECT_FALSE(std::filesystem::exists(shop / "box.toml.tmp"));
}

TEST_F(Import, replacesFilesOnlyWhereItMay) {
  shop.put("case-wall2.csv", "mine");
  const Outcome outcome = shop.call("import box.data box.grid -o case.toml");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("case-wall2.csv: is already there; --force replaces it"));
  EXPECT_EQ(shop.content("case-wall2.csv"), "mine");
  EXPECT_FALSE(std::filesystem::exists(shop / "case-fluid1.csv"));
  EXPECT_EQ(shop.call("import box.data box.grid -o case.toml --force").exitCode, 0);
  EXPECT_THAT(shop.content("case-wall2.csv"), StartsWith("x,y\n-0.0035,-0.0035\n"));
  EXPECT_EQ(shop.call("import box.data box.grid -o box.grid --force").exitCode, 2);
  EXPECT_EQ(shop.content("box.grid"), mphParticles);
}

TEST_F(Import, warningsGoToStderr) {
  shop.put("box.data", mphParameters + "Colour 1\n");
  const Outcome outcome = shop.call("import box.data box.boid -o sub-case.toml");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "treacle: warning: box.data:18: 'Colour' is not a row that is known, and is left out\n");
}

}  // namespace
}  // namespace treacle::test
