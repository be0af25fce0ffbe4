#include "treacle/core/error.hpp"
#include "treacle/io/shapes/shape_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "support/replaced.hpp"
#include "support/sample_mesh.hpp"
#include "support/temporary_directory.hpp"

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const std::string asciiStl = R"(solid wedge
facet normal 0 0 -1
  outer loop
    vertex 0 0 0
    vertex 0 1 0
    vertex 1 0 0
  endloop
endfacet
facet normal 0 -1 0
  outer loop
    vertex 0 0 0
    vertex +1.0e0 0 0
    vertex 0 0 1
  endloop
endfacet
endsolid wedge
)";

const std::string obj = R"(# a wedge
o wedge
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0 1.0
v 0 0 1
vn 0 0 1
f 4/1/1 3//1 2 1
f -5 -4 -1
)";

const std::string ply = R"(ply
format ascii 1.0
comment a wedge
element vertex 4
property float x
property float y
property float z
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 255
1 0 0 255
0 1 0 255
0 0 1 255
3 0 2 1
3 0 1 3
)";

/// The same in binary, either way round.
std::string binaryPly(bool big, std::uint32_t vertices = 4, std::int32_t last = 3) {
  std::string text = "ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian 1.0\nelement vertex " +
                     std::to_string(vertices) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face 2\n"
                     "property list uint8 int32 vertex_index\nend_header\n";
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big) std::reverse(bytes, bytes + sizeof value);
    text.append(bytes, sizeof value);
  };
  for (const double x : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) put(x);
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, last}}) {
    put(std::uint8_t{3});
    for (const std::int32_t corner : face) put(corner);
  }
  return text;
}

class MeshFile : public testing::Test {
 protected:
  Triangles read(const std::string& name, const std::string& text) {
    put(shop / name, text);
    return readTriangles(shop / name);
  }
  /// Without the folder.
  std::string message(const std::string& name, const std::string& text) {
    std::string what = messageOf<InputError>([&] { read(name, text); });
    const std::string folder = shop.path().string() + "/";
    for (std::size_t at; (at = what.find(folder)) != what.npos;) what.erase(at, folder.size());
    return what;
  }

  TemporaryDirectory shop;
};

TEST_F(MeshFile, isTakenInEachFormat) {
  const Triangles ball = ballMesh(2, 2);
  const Triangles again = read("ball.STL", stlText(ball));
  ASSERT_EQ(again.corners.size(), ball.corners.size());
  for (std::size_t k = 0; k < ball.corners.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(norm(again.vertices[again.corners[k][i]] - ball.vertices[ball.corners[k][i]]), 1e-6);

  const Triangles stl = read("a.stl", asciiStl);
  ASSERT_EQ(stl.corners.size(), 2u);
  EXPECT_EQ(stl.vertices[stl.corners[1][1]], (Vec<3>{1, 0, 0}));

  const Triangles fan = read("a.obj", obj);
  ASSERT_EQ(fan.corners.size(), 3u);
  EXPECT_EQ(fan.corners[0], (std::array<std::uint32_t, 3>{3, 2, 1}));
  EXPECT_EQ(fan.corners[1], (std::array<std::uint32_t, 3>{3, 1, 0}));
  EXPECT_EQ(fan.corners[2], (std::array<std::uint32_t, 3>{0, 1, 4}));
  EXPECT_EQ(fan.face, (std::vector<std::uint32_t>{1, 1, 2}));

  for (const std::string& text : {ply, binaryPly(false), binaryPly(true)}) {
    const Triangles t = read("a.ply", text);
    ASSERT_EQ(t.corners.size(), 2u);
    EXPECT_EQ(t.vertices.size(), 4u);
    EXPECT_EQ(t.corners[1], (std::array<std::uint32_t, 3>{0, 1, 3}));
    EXPECT_EQ(t.vertices[3], (Vec<3>{0, 0, 1}));
  }
}

/// A binary file whose header begins as an ASCII one does.
TEST_F(MeshFile, mayBeABinaryStlThatBeginsWithSolid) {
  std::string text = stlText(boxMesh({0, 0, 0}, {1, 1, 1}));
  text.replace(0, 5, "solid");
  EXPECT_EQ(read("a.stl", text).corners.size(), 12u);
}

/// As exporters write them.
TEST_F(MeshFile, mayBeAnStlWithCapitalsAMarkOrFilling) {
  std::string capitals = asciiStl;
  for (const std::string word : {"solid", "facet", "outer", "loop", "vertex"})
    for (std::size_t at = 0; (at = capitals.find(word, at)) != capitals.npos; at += word.size())
      for (std::size_t k = 0; k < word.size(); ++k) capitals[at + k] = static_cast<char>(word[k] - 'a' + 'A');
  EXPECT_EQ(read("a.stl", capitals).corners.size(), 2u);
  EXPECT_EQ(read("a.stl", "\xEF\xBB\xBF" + asciiStl).corners.size(), 2u);
  std::string filled = stlText(boxMesh({0, 0, 0}, {1, 1, 1})) + std::string(2, ' ');
  EXPECT_EQ(read("a.stl", filled).corners.size(), 12u);
  filled.replace(0, 5, "solid");
  EXPECT_EQ(read("a.stl", filled).corners.size(), 12u);
  filled.replace(80, 4, std::string("\x03\0\0\0", 4));
  EXPECT_EQ(message("a.stl", filled),
            "a.stl: its header says 3 faces, but the file has room for 12: as a binary STL it is damaged");
  EXPECT_THAT(message("a.stl", replaced(asciiStl, "vertex 0 1 0", "vertex 0 1,5 0")),
              EndsWith("found '1,5'; write decimal points, not commas"));
}

TEST_F(MeshFile, ofBadStlIsRefusedWithItsPlace) {
  const std::string good = stlText(boxMesh({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(
      message("a.stl", good.substr(0, 600)),
      "a.stl: truncated, or no STL: as a binary one its header promises 12 faces in 684 bytes, the file has 600; "
      "as an ASCII one it would begin with 'solid'");
  std::string many = good;
  many.replace(80, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_THAT(message("a.stl", many),
              HasSubstr("promises 4294967295 faces in 214748364834 bytes, the file has 684"));
  std::string none = good;
  none.replace(80, 4, std::string(4, '\0'));
  EXPECT_EQ(message("a.stl", none), "a.stl: no faces: the header of this binary STL says 0");
  std::string nan = good;
  const float value = std::nanf("");
  nan.replace(84 + 50 * 4 + 16, 4, reinterpret_cast<const char*>(&value), 4);
  EXPECT_EQ(message("a.stl", nan), "a.stl: face 5: expected finite coordinates, found nan");

  EXPECT_THAT(message("a.stl", obj),
              AllOf(StartsWith("a.stl: truncated, or no STL: "), EndsWith("begin with 'solid'")));
  EXPECT_EQ(message("a.stl", obj.substr(0, 50)), "a.stl:1: expected 'solid' of an ASCII STL, found '#'");
  EXPECT_EQ(message("a.stl", replaced(asciiStl, "vertex 0 1 0", "vertex 0 nan 0")),
            "a.stl:5: expected a finite number of at most 1e+40, found 'nan'");
  EXPECT_EQ(message("a.stl", replaced(asciiStl, "vertex 0 1 0", "vertex 0 1e999 0")),
            "a.stl:5: expected a finite number of at most 1e+40, found '1e999'");
  EXPECT_EQ(message("a.stl", replaced(asciiStl, "vertex 0 1 0", "vertex 0 1")),
            "a.stl:5: expected 3 numbers after 'vertex', found 2");
  EXPECT_EQ(message("a.stl", replaced(asciiStl, "    vertex 1 0 0\n", "")),
            "a.stl:6: expected 'vertex' of an ASCII STL, found 'endloop'");
  EXPECT_EQ(message("a.stl", asciiStl.substr(0, 150)),
            "a.stl:11: truncated: expected 'vertex', found the end of the file");
  EXPECT_EQ(message("a.stl", replaced(asciiStl, "endsolid wedge\n", "")),
            "a.stl:15: truncated: expected 'facet' or 'endsolid', found the end of the file");
  EXPECT_EQ(message("a.stl", "solid\nendsolid\n"), "a.stl:2: no faces in this STL");
}

TEST_F(MeshFile, ofBadObjIsRefusedWithItsLine) {
  EXPECT_EQ(message("a.obj", replaced(obj, "-5 -4 -1", "1 2 6")),
            "a.obj:10: expected the number of one of the 5 vertices before this face, found 6");
  EXPECT_THAT(message("a.obj", replaced(obj, "-5 -4 -1", "-6 2 3")), EndsWith("found -6"));
  EXPECT_THAT(message("a.obj", replaced(obj, "-5 -4 -1", "0 2 3")), EndsWith("found 0"));
  EXPECT_EQ(message("a.obj", replaced(obj, "-5 -4 -1", "a 2 3")), "a.obj:10: expected a whole number, found 'a'");
  EXPECT_EQ(message("a.obj", replaced(obj, "-5 -4 -1", "1 2")), "a.obj:10: expected 3 corners or more, found 2");
  EXPECT_EQ(message("a.obj", replaced(obj, "v 1 1 0", "v 1 inf 0")),
            "a.obj:5: expected a finite number of at most 1e+40, found 'inf'");
  EXPECT_EQ(message("a.obj", ply),
            "a.obj:17: no faces: expected lines of an OBJ, 'v x y z' and 'f a b c', found 0 vertices and no face");
}

TEST_F(MeshFile, ofBadPlyIsRefusedWithItsPlace) {
  EXPECT_EQ(message("a.ply", obj), "a.ply:1: expected a PLY, which begins with 'ply'");
  EXPECT_EQ(message("a.ply", ply.substr(0, 54)),
            "a.ply:4: truncated: expected 'end_header', found the end of the file");
  EXPECT_EQ(message("a.ply", replaced(ply, "3 0 1 3", "3 0 1 4")),
            "a.ply:17: expected indices from 0 to 3, found 4");
  EXPECT_EQ(message("a.ply", replaced(ply, "3 0 1 3", "2 0 1")), "a.ply:17: expected 3 corners or more, found 2");
  EXPECT_EQ(message("a.ply", replaced(ply, "3 0 1 3\n", "")),
            "a.ply:16: truncated: expected 2 of 'face', found 1");
  EXPECT_EQ(message("a.ply", replaced(ply, "0 1 0 255", "0 nan 0 255")),
            "a.ply:14: expected a finite number of at most 1e+40, found 'nan'");
  EXPECT_EQ(message("a.ply", replaced(ply, "property float z", "property half z")),
            "a.ply:7: expected a type such as 'float', found 'half'");
  EXPECT_EQ(message("a.ply", replaced(ply, "property float z", "property float w")),
            "a.ply: expected 'x', 'y' and 'z' among the properties of 'vertex'");
  EXPECT_THAT(message("a.ply", replaced(ply, "vertex 4", "vertex 2000000000")),
              HasSubstr("truncated: the header promises 2000000000 of 'vertex' in "));
  EXPECT_THAT(message("a.ply", binaryPly(false, 2'000'000'000)),
              HasSubstr("promises 2000000000 of 'vertex' in 48000000000 bytes or more, 122 are left in the file"));
  EXPECT_EQ(message("a.ply", binaryPly(true, 4, 7)), "a.ply: face 2: expected indices from 0 to 3, found 7");
  const std::string whole = binaryPly(false);
  EXPECT_EQ(message("a.ply", whole.substr(0, whole.size() - 2)),
            "a.ply: face 2: truncated: a list of 3 values, more than are left");
}

TEST_F(MeshFile, thatIsNoneIsRefused) {
  EXPECT_EQ(message("a.stl", ""), "a.stl: the file is empty");
  EXPECT_EQ(message("a.step", "ISO-10303-21;"), "a.step: expected a mesh, .stl, .obj or .ply, found '.step'");
  EXPECT_THAT(messageOf<InputError>([&] { readTriangles(shop / "missing.stl"); }),
              EndsWith("missing.stl: no such file"));
  EXPECT_THAT(messageOf<InputError>([&] { readTriangles(shop.path()); }), EndsWith("is not a file"));
}

}  // namespace
}  // namespace treacle::test
