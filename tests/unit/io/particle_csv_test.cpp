#include "treacle/io/frames/particle_csv.hpp"

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

using namespace treacle;
using namespace treacle::test;

namespace {

Frame read(const std::string& text, std::optional<int> dimensions = std::nullopt) {
  TemporaryDirectory directory;
  put(directory / "p.csv", text);
  return readParticleCsv(directory / "p.csv", dimensions);
}

/// What the message for such a file says after its path.
std::string complaint(const std::string& text, std::optional<int> dimensions = std::nullopt) {
  TemporaryDirectory directory;
  const std::string path = (directory / "p.csv").string();
  put(path, text);
  const std::string message = messageOf<InputError>([&] { readParticleCsv(path, dimensions); });
  EXPECT_TRUE(message.starts_with(path + ":")) << message;
  return message.substr(std::min(message.size(), path.size() + 1));
}

using Positions = std::vector<Vec<3>>;

}  // namespace

TEST(ParticleCsv, AllColumnsInAnyOrder) {
  const Frame f = read(
      "id,number_density,vz,z,pressure,nearest_distance,vx,vy,y,x\n7,1.5,6,3,100,0.5,4,5,2,1\n"
      "4294967295,1,0,0,0,1.5,0,0,0,0\n");
  EXPECT_EQ(f.dimensions, 3);
  EXPECT_EQ(f.position, (Positions{{{1, 2, 3}}, {}}));
  EXPECT_EQ(f.velocity, (Positions{{{4, 5, 6}}, {}}));
  EXPECT_EQ(f.pressure, (std::vector<double>{100, 0}));
  EXPECT_EQ(f.numberDensity, (std::vector<double>{1.5, 1}));
  EXPECT_EQ(f.nearestDistance, (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(f.id, (std::vector<std::uint32_t>{7, 4294967295u}));
}

TEST(ParticleCsv, Separators) {
  const Positions expected{{{1, -2e-3}}, {{3, 4}}};
  EXPECT_EQ(read("x,y\n1,-2e-3\n3,4\n").position, expected);
  EXPECT_EQ(read("x; y ;name\n 1;-2e-3;a\n3;4;b,c\n").position, expected);
  EXPECT_EQ(read("name\tx\ty\n\t1\t-2e-3\n\t3\t4\n").position, expected);  // the name is empty
  EXPECT_EQ(read("  x   y\n1 \t-2e-3\n   3 4  \n").position, expected);
}

TEST(ParticleCsv, CommentsBlankLinesAndLineEnds) {
  const Frame f = read("\xEF\xBB\xBF# by hand\r\n\r\n\"x\",\"y\"\r\n1,+2\r\n  # more\r\n\r\n3,4");
  EXPECT_EQ(f.position, (Positions{{{1, 2}}, {{3, 4}}}));
}

TEST(ParticleCsv, SpellingsOfOtherPrograms) {
  const Frame paraview = read(
      "\"velocity:0\",\"velocity:1\",\"velocity:2\",\"a, b\",\"Points:0\",\"Points:1\",\"Points:2\"\n"
      "4,5,0,9,1,2,0\n");
  EXPECT_EQ(paraview.dimensions, 2);
  EXPECT_EQ(paraview.position, (Positions{{{1, 2}}}));
  EXPECT_EQ(paraview.velocity, (Positions{{{4, 5}}}));
  for (const char* header : {"Points_0,Points_1,velocity_0,velocity_1", "Pos.x,Pos.y,Vel.x,Vel.y", "X,Y,U,V",
                             "position_x,position_y,velocity_x,velocity_y"}) {
    const Frame f = read(std::string(header) + ",,speed,Pressure\n1,2,4,5,,x,6\n");
    EXPECT_EQ(f.position, paraview.position) << header;
    EXPECT_EQ(f.velocity, paraview.velocity) << header;
    EXPECT_EQ(f.pressure, (std::vector<double>{6})) << header;
  }
}

TEST(ParticleCsv, FieldsThatTheFileDoesNotHoldAreEmpty) {
  const Frame f = read("x,y\n1,2\n");
  EXPECT_TRUE(f.velocity.empty() && f.pressure.empty() && f.numberDensity.empty() && f.nearestDistance.empty() &&
              f.id.empty());
  EXPECT_TRUE(std::isnan(read("x y pressure\n1 2 nan\n").pressure[0]));  // shows in the comparison
}

TEST(ParticleCsv, DimensionsOfTheDataOrOfTheRun) {
  EXPECT_EQ(read("x,y\n1,2\n").dimensions, 2);
  EXPECT_EQ(read("x,y,z\n1,2,0\n").dimensions, 2);
  EXPECT_EQ(read("x,y,z\n1,2,0\n1,2,-1e-9\n").dimensions, 3);
  EXPECT_EQ(read("x,y,z\n1,2,0\n", 3).dimensions, 3);
  EXPECT_EQ(read("x,y,z,vx,vy,vz\n1,2,0,3,4,5\n", 2).velocity, (Positions{{{3, 4}}}));
}

TEST(ParticleCsv, BadInputSaysWhereAndWhat) {
  EXPECT_EQ(complaint(""), "1: the file is empty; expected a line of column names, such as x,y,vx,vy");
  EXPECT_EQ(complaint("# x,y\n1,2\n3,4\n"), "2: expected column names with 'x' and 'y', found '1,2'");
  EXPECT_EQ(complaint("x,z\n1,2\n"), "1: expected column names with 'x' and 'y', found 'x,z'");
  EXPECT_EQ(complaint("x,y,Points:0\n1,2,3\n"),
            "1: 'x' and 'Points:0' both name the column 'x'; expected one of them");
  EXPECT_EQ(complaint("x,y,vy\n1,2,3\n"),
            "1: expected 'vx' and 'vy' together, found one component of the velocity without the other");
  EXPECT_EQ(complaint("\nx,y\n"), "2: no particles; expected a row for each below the names of the columns");
  EXPECT_EQ(complaint("x,y\n1,2\n# here\n1,2,3\n"),
            "4: expected 2 values, as many as there are column names, found 3");
  EXPECT_EQ(complaint("x,y\n1,2\n1\n"), "3: expected 2 values, as many as there are column names, found 1");
  EXPECT_EQ(complaint("x;y\n1;2,5\n"),
            "2: y: expected a number, found '2,5': is it a decimal comma? Write numbers with decimal points");
  EXPECT_EQ(complaint("x,y,vx,vy\n1,2,,0\n"), "2: vx: expected a number, found ''");
  EXPECT_EQ(complaint("Points:0,y\ninf,2\n"), "2: x: expected a finite number, found 'inf'");
  for (const char* id : {"-1", "1.5", "4294967296", "a"})
    EXPECT_EQ(complaint("x,y,id\n1,2," + std::string(id) + "\n"),
              "2: id: expected a whole number from 0 to 4294967295, found '" + std::string(id) + "'");
}

TEST(ParticleCsv, OtherDimensionsAreBadInput) {
  EXPECT_EQ(complaint("x,y\n1,2\n", 3), "1: expected a column 'z', since there are three dimensions");
  const std::string flatVelocity =
      "1: expected a column 'vz' beside 'vx' and 'vy', since there are three dimensions";
  EXPECT_EQ(complaint("x,y,z,vx,vy\n1,2,0,3,4\n", 3), flatVelocity);
  EXPECT_EQ(complaint("x,y,z,vx,vy\n1,2,1,3,4\n"), flatVelocity);
  EXPECT_EQ(complaint("x,y,z\n1,2,0\n1,2,0.5\n", 2), "3: z: expected 0 in two dimensions, found '0.5'");
}

TEST(ParticleCsv, MissingFile) {
  EXPECT_NE(messageOf<InputError>([] { readParticleCsv("none.csv"); }).find("none.csv"), std::string::npos);
}
