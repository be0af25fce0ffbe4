#include "mph_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import_parts.hpp"
#include "support/mph_case.hpp"
#include "support/replaced.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string parameterError(const std::string& text) {
  return messageOf<InputError>([&] { readMphParameters("box.data", text); });
}
std::string particleError(const std::string& text) {
  return messageOf<InputError>([&] { readMphParticles("box.grid", text); });
}
std::string cuboidError(const std::string& text) {
  return messageOf<InputError>([&] { readMphCuboids("box.boid", text); });
}

ImportedCase converted(const std::string& parameters, const MphGeometry& geometry) {
  return convertedCase(readMphParameters("box.data", parameters), geometry, "box");
}
ImportedCase converted(const std::string& parameters, const std::string& cuboids = mphCuboids) {
  return converted(parameters, readMphCuboids("box.boid", cuboids));
}

TEST(MphParameters, AllRows) {
  const MphParameters p =
      readMphParameters("box.data", replaced(mphParameters, "Wall3  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0",
                                             "Wall3\tCenter 1 2 3\tVelocity 4 5 6\tOmega 7 8 +9e0  # turns\r"));
  EXPECT_EQ(p.step, 1e-3);
  EXPECT_EQ(p.end, 4e-3);
  EXPECT_EQ(p.profileInterval, 5e-3);
  EXPECT_EQ(p.pictureInterval, 2e-3);
  EXPECT_EQ(p.pressureRatio, 1.8);
  EXPECT_EQ(p.viscosityRatio, 3.4);
  EXPECT_EQ(p.gravity, (Vec<3>{0, -10, 0}));
  EXPECT_EQ(p.types[0].density, 1100);
  EXPECT_EQ(p.types[1].bulkModulus, 2e6);
  EXPECT_EQ(p.types[2].bulkViscosity, 3e4);
  EXPECT_EQ(p.types[3].shearViscosity, 40);
  EXPECT_EQ(p.walls[1].center, (Vec<3>{1, 2, 3}));
  EXPECT_EQ(p.walls[1].velocity, (Vec<3>{4, 5, 6}));
  EXPECT_EQ(p.walls[1].omega, (Vec<3>{7, 8, 9}));
  EXPECT_THAT(p.warnings, IsEmpty());
}

TEST(MphParameters, MessagesNameLineAndWhatWasExpected) {
  EXPECT_THAT(parameterError(""), StartsWith("box.data:1: the file ends without the rows Dt, EndTime, "));
  EXPECT_THAT(parameterError(replaced(mphParameters, "BulkModulus ", "BulkModule ")),
              StartsWith("box.data:17: the file ends without the row BulkModulus; expected a file of parameters"));
  EXPECT_EQ(parameterError(replaced(mphParameters, "1e-3", "0")),
            "box.data:2: expected a positive number, found '0'");
  EXPECT_EQ(parameterError(replaced(mphParameters, "1100", "nan")),
            "box.data:9: expected a finite number, found 'nan'");
  EXPECT_EQ(parameterError(replaced(mphParameters, "1100", "1e999")),
            "box.data:9: expected a finite number, found '1e999'");
  EXPECT_EQ(parameterError(replaced(mphParameters, "1100", "-1")),
            "box.data:9: expected a number that is not negative, found -1");
  EXPECT_EQ(parameterError(replaced(mphParameters, "1100", "1 1 1100")),
            "box.data:9: Density: expected 4 numbers, one for each of the types 0 to 3, found 6");
  EXPECT_EQ(parameterError(replaced(mphParameters, "0 -10 0", "-10")),
            "box.data:15: Gravity: expected 3 values, found 1");
  EXPECT_EQ(parameterError(mphParameters + "Dt 1\n"),
            "box.data:18: Dt stands twice, first in line 2; expected it once");
  EXPECT_THAT(parameterError(replaced(mphParameters, "Omega 0 0 0", "Omega 0 0")),
              StartsWith("box.data:16: Wall2: expected 'Center' with 3 numbers"));
}

TEST(MphParticles, MessagesNameLineAndWhatWasExpected) {
  EXPECT_EQ(readMphParticles("box.grid", mphParticles).particles.size(), 128u);
  EXPECT_THAT(particleError(""), StartsWith("box.grid:1: the file is empty"));
  EXPECT_THAT(particleError("0\n"), StartsWith("box.grid:1: the file ends after the time"));
  EXPECT_THAT(particleError("0 1\n"), StartsWith("box.grid:1: expected one number, the time [s], found 2 words"));
  EXPECT_THAT(particleError(replaced(mphParticles, "0.0", "-1")),
              HasSubstr("expected a time that is not negative"));
  EXPECT_THAT(particleError(replaced(mphParticles, "128 ", "")), StartsWith("box.grid:2: expected 8 numbers"));
  EXPECT_THAT(particleError(replaced(mphParticles, "128 ", "-1 ")),
              StartsWith("box.grid:2: expected the number of particles, a whole number from 1 to "));
  EXPECT_THAT(particleError(replaced(mphParticles, "128 ", "4000000000 ")),
              StartsWith("box.grid:2: expected rows of 4000000000 particles, found a file of "));
  EXPECT_EQ(particleError(replaced(mphParticles, "128 ", "127 ")),
            "box.grid:130: expected 127 particles, as many as the second row says, found more");
  EXPECT_EQ(particleError(mphParticles.substr(0, mphParticles.rfind('\n', mphParticles.size() - 2) + 1)),
            "box.grid:129: expected 128 particles, the file ends after 127");
  EXPECT_THAT(particleError(mphParticles.substr(0, mphParticles.size() - 4)),
              StartsWith("box.grid:130: expected 7 values"));
  EXPECT_EQ(
      particleError(replaced(mphParticles, "\n1 ", "\n4 ")),
      "box.grid:3: expected a type, 0 and 1 for fluids, 2 and 3 for walls, a whole number from 0 to 3, found '4'");
  EXPECT_EQ(particleError(replaced(mphParticles, "0.25", "inf")),
            "box.grid:3: expected a finite number, found 'inf'");
  EXPECT_EQ(particleError(replaced(mphParticles, "5.000000e-04", "1")),
            "box.grid:3: expected a particle inside of the domain, x from -0.004 to less than 0.014, found 1");
  EXPECT_EQ(particleError(replaced(mphParticles, "-2e-3 2e-3", "2e-3 2e-3")),
            "box.grid:2: expected the least z and then the largest z, found 0.002 and 0.002");
}

TEST(MphCuboids, MessagesNameLineAndWhatWasExpected) {
  EXPECT_EQ(readMphCuboids("box.boid", mphCuboids).cuboids.size(), 3u);
  EXPECT_EQ(cuboidError(""), "box.boid:1: expected 'ParticleDistance' in the file, which ends without it");
  EXPECT_THAT(cuboidError(mphCuboids.substr(0, mphCuboids.find("StartCuboid"))),
              StartsWith("box.boid:4: the file has no cuboid"));
  EXPECT_EQ(cuboidError(mphCuboids.substr(0, mphCuboids.rfind("EndCuboid"))),
            "box.boid:24: the file ends in the cuboid of line 19");
  EXPECT_EQ(cuboidError(replaced(mphCuboids, "  Type      1\n", "")),
            "box.boid:10: expected 'Type' in the cuboid, which ends without it");
  EXPECT_THAT(cuboidError(replaced(mphCuboids, "Type      1", "Type 1.5")), HasSubstr("found '1.5'"));
  EXPECT_EQ(cuboidError(replaced(mphCuboids, "Type ", "Tipe ")),
            "box.boid:7: expected 'Spacing', 'Type', 'Lower', 'Upper', 'Velocity' or 'EndCuboid', found 'Tipe'");
  EXPECT_THAT(cuboidError(replaced(mphCuboids, "Spacing   1e-3", "Spacing 2e-3")),
              StartsWith("box.boid:6: expected the Spacing to be the ParticleDistance, 0.001, found 0.002"));
  EXPECT_EQ(cuboidError(replaced(mphCuboids, "4e-3 6e-3 0.5e-3", "4e-3 -6e-3 0.5e-3")),
            "box.boid:11: expected the y of Lower to be less than that of Upper, found 0 and -0.006");
  EXPECT_EQ(cuboidError(replaced(mphCuboids, "4e-3 6e-3 0.5e-3", "4e-3 6e-3")),
            "box.boid:9: Upper: expected 3 values, found 2");
  EXPECT_EQ(cuboidError(mphCuboids + "LowerDomain 0 0 0\n"),
            "box.boid:26: 'LowerDomain' stands twice; expected it once");
  std::string many = mphCuboids.substr(0, mphCuboids.find("StartCuboid"));
  const std::string one = mphCuboids.substr(many.size(), mphCuboids.find("EndCuboid") + 10 - many.size());
  for (int k = 0; k < 256; ++k) many += one;
  EXPECT_THAT(cuboidError(many), HasSubstr("expected at most 255 cuboids, found more"));
}

TEST(ImportedCase, WarnsOfWhatIsLeftOut) {
  std::string text = replaced(mphParameters, "SurfaceTension           0      0 ", "SurfaceTension 0.01 0.07 ");
  text = replaced(text, "InteractionRatio(Type0)  1      1", "InteractionRatio(Type1) 1 0.5") + "Colour 1\n";
  text = replaced(text, "0 -10 0", "0 -10 1");
  text = replaced(text, "Velocity 0 0 0  Omega 0 0 0", "Velocity 1 0 2  Omega 3 0 0");
  const ImportedCase imported = converted(text, replaced(mphCuboids, "0.25 -0.5 0", "0.25 -0.5 1"));
  EXPECT_THAT(
      imported.warnings,
      ElementsAre(
          "box.data:18: 'Colour' is not a row that is known, and is left out",
          "box.data:15: Gravity along z is 1 and left out: the particles are one layer",
          "box.data:13: SurfaceTension of type 1 is 0.07 and left out, as is RadiusRatioA: the forces between "
          "particles that it stands for are another model than surface_tension of a material",
          "box.data:14: InteractionRatio(Type1) is not 1 throughout and left out: it belongs to another model "
          "of surface tension",
          "box.boid:5: the velocity has a part along z that is left out: the particles are one layer",
          "box.data: the Velocity of Wall2 has a part along z that is left out: the particles are one layer",
          "box.data: the Omega of Wall2 has parts along x and y that are left out: the particles are one "
          "layer"));
  EXPECT_EQ(imported.value.gravity, (Vec<3>{0, -10, 0}));
  EXPECT_EQ(imported.value.bodies[1].velocity, (Vec<3>{1, 0, 0}));
  EXPECT_FALSE(imported.value.bodies[1].rotation);
}

TEST(ImportedCase, WarnsOfVelocitiesOfWallsAndFractionsOfSpacings) {
  std::string cuboids = replaced(mphCuboids, "Upper     4e-3 6e-3", "Upper 4e-3 6.4e-3");
  cuboids = replaced(cuboids, "Velocity  0 0 0", "Velocity 1 0 0");
  EXPECT_THAT(
      converted(mphParameters, cuboids).warnings,
      ElementsAre("box.boid: velocities of type 2 are not those of the row Wall2 in box.data, and left out",
                  "box.boid:5: the cuboid is 6.4 Spacings long along y, not a whole number: its particles may "
                  "be others than those that are made of it (.grid), which can be imported"));
}

TEST(ImportedCase, ShortDomainIsOpen) {
  const ImportedCase imported =
      converted(mphParameters, replaced(mphCuboids, "14e-3 14e-3  2e-3", "14e-3 6.7e-3 2e-3"));
  EXPECT_EQ(imported.value.domain.periodic, (std::array<bool, 3>{true, false, false}));
  EXPECT_THAT(imported.warnings, ElementsAre(HasSubstr("so open there and not periodic")));
}

TEST(ImportedCase, ParticlesOfALaterTime) {
  const MphGeometry g = readMphParticles("box.grid", replaced(mphParticles, "0.0", "1e-3"));
  const ImportedCase imported = converted(mphParameters, g);
  EXPECT_DOUBLE_EQ(imported.value.time.end, 3e-3);
  EXPECT_THAT(imported.warnings, ElementsAre(StartsWith("box.grid: the particles are those of t = 0.001")));
  const MphGeometry late = readMphParticles("box.grid", replaced(mphParticles, "0.0", "1"));
  EXPECT_THAT(
      messageOf<InputError>([&] { converted(mphParameters, late); }),
      StartsWith("box.data:5: EndTime: expected a time after that of the particles in box.grid, 1, found"));
}

TEST(ImportedCase, VelocitiesAreThoseOfTheParticles) {
  MphGeometry g = readMphParticles("box.grid", mphParticles);
  g.particles[0].velocity = {1, 0, 0};
  const ImportedCase imported = converted(mphParameters, g);
  ASSERT_EQ(imported.value.bodies.size(), 3u);
  const Body& fluid = imported.value.bodies[0];
  EXPECT_TRUE(fluid.fileVelocities);
  EXPECT_EQ(fluid.velocity, (Vec<3>{}));
  EXPECT_EQ(fluid.shape.file.particles.value->velocity[0], (Vec<3>{1, 0, 0}));
  EXPECT_EQ(fluid.shape.file.particles.value->velocity[1], (Vec<3>{0.25, -0.5, 0}));
  EXPECT_THAT(imported.tables[0].content, StartsWith("x,y,vx,vy\n"));
  EXPECT_THAT(imported.tables[0].content, HasSubstr(",1,0\n"));
  EXPECT_THAT(imported.warnings, IsEmpty());
}

TEST(ImportedCase, NeedsTheDensitiesOfItsTypes) {
  EXPECT_EQ(messageOf<InputError>([] { converted(replaced(mphParameters, "1000 ", "0 ")); }),
            "box.data:9: Density: expected a positive number for type 1, of which there are particles, found 0");
  EXPECT_EQ(converted(replaced(mphParameters, "1100 ", "0 ")).value.materials.size(), 3u)
      << "type 0 has no particles";
  EXPECT_THAT(messageOf<InputError>(
                  [] { converted(replaced(mphParameters, "RadiusRatioP             1.8", "RadiusRatioP 90")); }),
              StartsWith("box.data, box.boid: cannot be a case: "));
}

}  // namespace
}  // namespace treacle::test
