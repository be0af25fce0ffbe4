#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "support/sample_mesh.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A ball of fluid in three dimensions, from a file in millimetres, above a floor.
const std::string meshCase = R"(dimensions = 3
spacing = 1e-3

[domain]
min = [-8e-3, -8e-3, -4e-3]
max = [8e-3, 8e-3, 12e-3]

[[material]]
name = "syrup"
density = 1000
dynamic_viscosity = 10
bulk_viscosity = 1e4
bulk_modulus = 1e6

[[body]]
name = "ball"
type = "fluid"
material = "syrup"
shape = "mesh"
file = "meshes/ball.stl"
transform = { scale = 1e-3, translate = [0, 0, 5e-3] }

[[body]]
name = "floor"
type = "wall"
material = "syrup"
shape = "box"
min = [-8e-3, -8e-3, -4e-3]
max = [8e-3, 8e-3, 0]

[time]
step = 1e-3
end = 2e-3
)";

class MeshCase : public testing::Test {
 protected:
  MeshCase() {
    shop.put("meshes/ball.stl", stlText(ballMesh(4.2, 3)));
    shop.put("case.toml", meshCase);
  }
  std::string errorOf(const std::string& text) {
    shop.put("bad.toml", text);
    const Outcome outcome = shop.call("check bad.toml");
    EXPECT_EQ(outcome.exitCode, 2);
    return outcome.err;
  }

  Workshop shop;
};

TEST_F(MeshCase, isReportedByCheck) {
  const Outcome outcome = shop.call("check case.toml");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("#   fluid 'ball': 304\n"));
  EXPECT_THAT(outcome.out,
              HasSubstr("# mesh of 'ball': 1280 triangles from (-4.2, -4.2, 0.8) mm to (4.2, 4.2, 9.2) mm, "
                        "area 0.000220"));
  EXPECT_THAT(outcome.out, HasSubstr("m2, volume enclosed 3.07"));
  EXPECT_THAT(outcome.out, HasSubstr("m3, 0 open edges\n"));
}

TEST_F(MeshCase, warnsOfThinLayers) {
  shop.put("thin.toml", meshCase + R"(
[[body]]
name = "mould"
type = "wall"
material = "syrup"
shape = "mesh"
file = "meshes/ball.stl"
fill = "outside"
thickness = 1e-3
transform = { scale = 1e-3, translate = [0, 0, 6e-3] }
where = "x > 1"
)");
  EXPECT_THAT(shop.call("check thin.toml").err,
              HasSubstr("wall 'mould' is 1 mm thick (thickness), thinner than the viscosity radius h_v = 3.5 mm"));
}

TEST_F(MeshCase, isWrittenWithWhatFindsItsFileAgain) {
  const Case c = readCase(shop / "case.toml");
  EXPECT_EQ(c.bodies[0].shape.file.path, (shop / "meshes/ball.stl").string());
  EXPECT_EQ(c.bodies[0].shape.file.checksum.size(), 16u);
  shop.put("elsewhere/written.toml", caseText(c));
  const Case again = readCase(shop / "elsewhere/written.toml");
  EXPECT_EQ(again, c);
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles(again, notes).numbers().fluid, createParticles(c, notes).numbers().fluid);
  // Files that are not needed need not be there.
  std::filesystem::rename(shop / "meshes/ball.stl", shop / "moved.stl");
  EXPECT_EQ(readCase(shop / "elsewhere/written.toml", {}, ShapeFiles::Leave), c);
  EXPECT_THAT(
      messageOf<InputError>([&] { readCase(shop / "elsewhere/written.toml"); }),
      EndsWith("file in [[body]] 'ball' (mesh): " + (shop / "meshes/ball.stl").string() + ": no such file"));
  // Beside the case it is found.
  std::filesystem::rename(shop / "moved.stl", shop / "elsewhere/ball.stl");
  EXPECT_EQ(readCase(shop / "elsewhere/written.toml").bodies[0].shape.file.path,
            (shop / "elsewhere/ball.stl").string());
  shop.put("elsewhere/ball.stl", stlText(ballMesh(4.3, 3)));
  EXPECT_THAT(messageOf<InputError>([&] { readCase(shop / "elsewhere/written.toml"); }),
              HasSubstr("ball.stl: is not the file that the case was made with: expected the checksum "));
}

TEST_F(MeshCase, namesFilesRelativeToTheFileThatHoldsThem) {
  shop.put("below/further.toml", "base = \"../case.toml\"\n[time]\nstep = 5e-4\n");
  EXPECT_EQ(readCase(shop / "below/further.toml").bodies[0].shape.file.path, (shop / "meshes/ball.stl").string());
  shop.put("below/own.stl", stlText(ballMesh(3, 2)));
  shop.put("below/other.toml", "base = \"../case.toml\"\n[[body]]\nname = \"ball\"\nfile = \"own.stl\"\n");
  EXPECT_EQ(readCase(shop / "below/other.toml").bodies[0].shape.file.path, (shop / "below/own.stl").string());
  // One that is given on the command line, relative to where that is.
  const Outcome outcome = shop.call("check case.toml --set ball.file=below/own.stl");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, HasSubstr("320 triangles"));
}

TEST_F(MeshCase, isRefusedWithTheLineOfTheCase) {
  EXPECT_THAT(errorOf(replaced(meshCase, "meshes/ball.stl", "none.stl")),
              HasSubstr("bad.toml:20:8: file in [[body]] 'ball' (mesh): "));
  EXPECT_THAT(errorOf(replaced(meshCase, "file = \"meshes/ball.stl\"\n", "")),
              EndsWith("file in [[body]] 'ball' (mesh): missing; expected a string\n"));
  EXPECT_THAT(errorOf(replaced(meshCase, "shape = \"mesh\"", "shape = \"mesh\"\nradius = 1")),
              HasSubstr("unknown key 'radius' in [[body]] 'ball' (mesh)"));
  EXPECT_THAT(errorOf(replaced(meshCase, "scale = 1e-3", "scale = 0")),
              HasSubstr("scale in the transform of [[body]] 'ball': expected a positive number, found 0"));
  EXPECT_THAT(errorOf(replaced(meshCase, "scale = 1e-3", "scale = 1e-3, angle = 3, angles = [1, 0, 0]")),
              HasSubstr("expected either angle, about axis, or angles, about x, y and z; found both"));
  EXPECT_THAT(errorOf(replaced(meshCase, "scale = 1e-3", "scale = 1")),
              HasSubstr("body 'ball' is far larger than the domain: it reaches from (-4.2, "));
  EXPECT_THAT(errorOf(replaced(smallCase, "shape = \"box\"\nmin = [0, 0]\nmax = [6e-3, 6e-3]",
                               "shape = \"mesh\"\nfile = \"meshes/ball.stl\"")),
              HasSubstr("shape in [[body]] 'column' (mesh): a mesh has three dimensions; in the plane shape = "
                        "\"polygon\" takes the points of an outline"));
}

TEST_F(MeshCase, runsAndGoesOnFromItsRunDirectory) {
  ASSERT_EQ(shop.call("run case.toml -o run --end-time 1e-3 --quiet").exitCode, 0);
  std::filesystem::rename(shop / "run", shop / "moved");
  std::filesystem::remove(shop / "case.toml");
  const Outcome more =
      shop.call("run moved/case.toml --resume moved/checkpoint.h5 --end-time 2e-3 -o more --quiet");
  EXPECT_EQ(more.exitCode, 0) << more.err;
  // Pictures need no mesh; going on does.
  std::filesystem::remove(shop / "meshes/ball.stl");
  EXPECT_EQ(shop.call("plot more").exitCode, 0);
  const Outcome without = shop.call("run more/case.toml --resume moved/checkpoint.h5 -o again --quiet");
  EXPECT_EQ(without.exitCode, 2);
  EXPECT_THAT(without.err, HasSubstr("ball.stl: no such file"));
}

/// Constants and layers of gas follow speeds that only the points of the mesh know.
TEST_F(MeshCase, turnsInARun) {
  const std::string open = replaced(meshCase, "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n", "");
  shop.put("turning.toml", open + R"(
[gas]

[[body]]
name = "stirrer"
type = "wall"
material = "syrup"
shape = "mesh"
file = "meshes/ball.stl"
transform = { scale = 3e-4, translate = [6.5e-3, 0, 5e-3] }
rotation = { center = [6.5e-3, 0, 5e-3], axis = [0, 0, 1], speed = 10 }
)");
  const Outcome outcome = shop.call("run turning.toml -o run --quiet");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

TEST_F(MeshCase, takesParticlesOfFrames) {
  ASSERT_EQ(shop.call("run case.toml -o run --quiet").exitCode, 0);
  const std::string given = replaced(replaced(meshCase, "shape = \"mesh\"\nfile = \"meshes/ball.stl\"",
                                              "shape = \"particles\"\nfile = \"run/frames/fluid_000000.vtp\""),
                                     "transform = { scale = 1e-3, translate = [0, 0, 5e-3] }",
                                     "transform = { translate = [0, 0, 1e-3] }");
  shop.put("given.toml", given);
  const Outcome outcome = shop.call("check given.toml");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("#   fluid 'ball': 304\n"));
  EXPECT_THAT(outcome.out, HasSubstr("checksum = \""));

  shop.put("few.csv", "x,y,z\n0,0,5e-3\n1e-3,0,5e-3\n");
  shop.put("few.toml", replaced(given, "run/frames/fluid_000000.vtp", "few.csv"));
  EXPECT_THAT(shop.call("check few.toml").out, HasSubstr("#   fluid 'ball': 2\n"));
  shop.put("few.csv", "x,y\n0,0\n");
  EXPECT_THAT(shop.call("check few.toml").err, HasSubstr("few.csv:1: expected a column 'z'"));
}

/// Every key of the shapes comes back from what is written.
TEST(shapeKeys, areWrittenAsTheyAreRead) {
  Workshop shop;
  shop.put("case.toml", replaced(meshCase, R"(shape = "mesh"
file = "meshes/ball.stl"
transform = { scale = 1e-3, translate = [0, 0, 5e-3] })",
                                 R"(shape = "cone"
start = [0, 0, 1e-3]
end = [0, 1e-3, 8e-3]
start_radius = 3e-3
end_radius = 0
inner_start_radius = 1e-3
transform = { scale = 0.9, axis = [1, 2, 3], angle = 12.5, center = [0, 0, 4e-3], translate = [1e-3, 0, 0] }

[[body]]
name = "ring"
type = "fluid"
material = "syrup"
shape = "torus"
center = [0, 0, 10e-3]
axis = [0, 0, -1]
radius = 6e-3
tube_radius = 1.5e-3
inner_radius = 1e-4

[[body]]
name = "angle"
type = "wall"
material = "syrup"
shape = "polygon"
points = [[-8e-3, -8e-3], [-4e-3, -8e-3], [-4e-3, -7e-3], [-8e-3, -7e-3]]
bottom = 0
top = 4e-3
fill = "shell"
thickness = 3.5e-3
transform = { angles = [0, 0, 1] })"));
  const Case c = readCase(shop / "case.toml");
  EXPECT_EQ(c.bodies[2].shape.points[2], (Vec<2>{-4e-3, -7e-3}));
  EXPECT_EQ(c.bodies[2].shape.fill, FillKind::Shell);
  shop.put("written.toml", caseText(c));
  EXPECT_EQ(readCase(shop / "written.toml"), c) << caseText(c);
}

}  // namespace
}  // namespace treacle::test
