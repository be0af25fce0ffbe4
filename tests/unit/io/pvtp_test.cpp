#include "treacle/io/frames/pvtp.hpp"

#include "limited_files.hpp"
#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace treacle;
using namespace treacle::test;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> pieceNames{"a.p0.vtp", "a.p1.vtp", "a.p2.vtp"};

/// A frame of 30 particles in three files of 10, 1 and 19, and their index.
struct Pieces {
  TemporaryDirectory directory;
  Frame whole = sampleFrame(2, 30);
  fs::path index = directory / "a.pvtp";

  explicit Pieces(bool rheology = false) {
    whole.time = 0.125;
    for (int k = 0; rheology && k < 30; ++k) {
      whole.shearRate.push_back(k);
      whole.temperature.push_back(300 + k);
      whole.dynamicViscosity.push_back(2.0 / (1 + k));
    }
    write(0, part(0, 10)), write(1, part(10, 11)), write(2, part(11, 30));
    writePvtp(index, pieceNames);
  }

  Frame part(std::ptrdiff_t begin, std::ptrdiff_t end) const {
    Frame piece = whole;
    forEachFrameField([&](const char*, auto member) {
      auto& field = piece.*member;
      if (!field.empty()) field = {field.begin() + begin, field.begin() + end};
    });
    return piece;
  }

  void write(int rank, const Frame& piece, const OutputFields& fields = {},
             OutputPrecision precision = OutputPrecision::Double) const {
    writeVtp(directory / pieceNames[static_cast<std::size_t>(rank)], piece, fields, precision);
  }

  std::string changed(const std::string& from, const std::string& to) const {
    std::string text = content(index);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << text;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }

  void expectUnreadable(const std::string& part) const {
    const std::string message = messageOf<InputError>([&] { readFrame(index); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  void expectUnwritable(const std::string& part) const {
    const std::string before = content(index);
    const std::string message = messageOf<RunError>([&] { writePvtp(index, pieceNames); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(content(index), before);
  }
};

}  // namespace

TEST(Pvtp, IsWhatVtkPrescribes) {
  const Pieces pieces;
  EXPECT_EQ(content(pieces.index), R"(<?xml version="1.0"?>
<VTKFile type="PPolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <PPolyData GhostLevel="0">
    <PPointData>
      <PDataArray type="Float64" Name="velocity" NumberOfComponents="3"/>
      <PDataArray type="Float64" Name="pressure" NumberOfComponents="1"/>
      <PDataArray type="Float64" Name="number_density" NumberOfComponents="1"/>
      <PDataArray type="Float64" Name="nearest_distance" NumberOfComponents="1"/>
      <PDataArray type="Int32" Name="material" NumberOfComponents="1"/>
      <PDataArray type="Int32" Name="body" NumberOfComponents="1"/>
      <PDataArray type="UInt32" Name="id" NumberOfComponents="1"/>
    </PPointData>
    <PPoints>
      <PDataArray type="Float64" Name="position" NumberOfComponents="3"/>
    </PPoints>
    <Piece Source="a.p0.vtp"/>
    <Piece Source="a.p1.vtp"/>
    <Piece Source="a.p2.vtp"/>
  </PPolyData>
</VTKFile>
)");
}

TEST(Pvtp, HasTheFieldsOfARheologyAndOfHeat) {
  const Pieces pieces(true);
  const Frame read = readFrame(pieces.index);
  EXPECT_EQ(read.shearRate, pieces.whole.shearRate);
  EXPECT_EQ(read.temperature, pieces.whole.temperature);
  EXPECT_EQ(read.dynamicViscosity, pieces.whole.dynamicViscosity);
}

TEST(Pvtp, PiecesMakeTheFrame) {
  const Pieces pieces;
  const Frame read = readFrame(pieces.index);
  EXPECT_EQ(read.time, pieces.whole.time);
  EXPECT_EQ(read.dimensions, 2);
  EXPECT_EQ(read.position, pieces.whole.position);
  EXPECT_EQ(read.velocity, pieces.whole.velocity);
  EXPECT_EQ(read.pressure, pieces.whole.pressure);
  EXPECT_EQ(read.numberDensity, pieces.whole.numberDensity);
  EXPECT_EQ(read.nearestDistance, pieces.whole.nearestDistance);
  EXPECT_EQ(read.material, pieces.whole.material);
  EXPECT_EQ(read.body, pieces.whole.body);
  EXPECT_EQ(read.id, pieces.whole.id);
}

TEST(Pvtp, APieceWithoutParticlesIsRead) {
  const Pieces pieces;
  pieces.write(0, pieces.part(0, 0));
  EXPECT_EQ(readFrame(pieces.index).id, pieces.part(10, 30).id);
  pieces.write(1, pieces.part(0, 0)), pieces.write(2, pieces.part(0, 0));
  EXPECT_TRUE(readFrame(pieces.index).position.empty());
  EXPECT_EQ(readFrame(pieces.index).time, pieces.whole.time);
}

TEST(Pvtp, OtherFilesAreReadAsTheyAre) {
  const Pieces pieces;
  EXPECT_EQ(readFrame(pieces.directory / pieceNames[2]).id, pieces.part(11, 30).id);
}

TEST(Pvtp, IsNotWrittenWithoutItsPieces) {
  const Pieces pieces;
  fs::remove(pieces.directory / pieceNames[2]);
  pieces.expectUnwritable("a.pvtp: its piece " + (pieces.directory / pieceNames[2]).string() + ": No such file");
  pieces.write(2, pieces.part(11, 30));
  const std::string sound = content(pieces.directory / pieceNames[0]);
  put(pieces.directory / pieceNames[0], sound.substr(0, sound.size() - 9));
  pieces.expectUnwritable("a.p0.vtp: truncated");
  pieces.write(0, pieces.part(0, 0));
  pieces.expectUnwritable("a.p0.vtp: no particles");
}

TEST(Pvtp, IsNotWrittenForPiecesOfSeveralFrames) {
  const Pieces pieces;
  Frame other = pieces.part(11, 30);
  other.time = 7;
  pieces.write(2, other);
  pieces.expectUnwritable("a.p2.vtp: 2 dimensions at t = 7 s, other pieces of the frame have 2 at t = 0.125 s");
  pieces.write(2, pieces.part(11, 30), {.velocity = false});
  pieces.expectUnwritable("a.p2.vtp: other arrays than those of other pieces");
  pieces.write(2, pieces.part(11, 30), {}, OutputPrecision::Single);
  pieces.expectUnwritable("a.p2.vtp: other arrays than those of other pieces");
}

TEST(Pvtp, APieceThatIsMissingOrDamagedIsNamed) {
  const Pieces pieces;
  const std::string sound = content(pieces.directory / pieceNames[2]);
  put(pieces.directory / pieceNames[2], sound.substr(0, sound.size() / 2));
  pieces.expectUnreadable("a.p2.vtp: truncated");
  put(pieces.directory / pieceNames[2], "<VTKFile type=\"ImageData\">");
  pieces.expectUnreadable("a.p2.vtp: not a particle file");
  fs::remove(pieces.directory / pieceNames[2]);
  pieces.expectUnreadable("a.p2.vtp: No such file");
}

TEST(Pvtp, PiecesMustBelongTogether) {
  const Pieces pieces;
  Frame other = pieces.part(11, 30);
  other.dimensions = 3;
  pieces.write(2, other);
  pieces.expectUnreadable(
      "a.p2.vtp: 3 dimensions at t = 0.125 s, other pieces of the frame have 2 at t = 0.125 s");
  pieces.write(2, pieces.part(11, 30), {.body = false});
  pieces.expectUnreadable("a.p2.vtp: 'body' is not in all pieces of the frame");
}

TEST(Pvtp, ADamagedIndexIsRefused) {
  const Pieces pieces;
  const std::string sound = content(pieces.index);
  const auto expectUnreadable = [&](const std::string& text, const std::string& part) {
    put(pieces.index, text);
    pieces.expectUnreadable("a.pvtp: " + part);
    put(pieces.index, sound);
  };
  // Wherever it is cut: that pieces are missing must not go unseen.
  for (std::size_t size = sound.find("<VTKFile") + 60; size < sound.size(); size += 7)
    expectUnreadable(sound.substr(0, size), size < sound.find(">\n  <PPolyData") ? "not an index" : "truncated");
  expectUnreadable(pieces.changed("PPolyData", "PImageData"), "not an index of pieces written by treacle");
  expectUnreadable("", "not an index of pieces written by treacle");
  expectUnreadable(pieces.changed("a.p1", "a.p0"), "the piece a.p0.vtp is named twice");
  expectUnreadable(pieces.changed("a.p1", "../a.p1"), "piece 1: expected the name of a file beside this one");
  expectUnreadable(pieces.changed("a.p1", "/etc/a.p1"), "piece 1: expected the name of a file beside this one");
  expectUnreadable(pieces.changed("Source=\"a.p0.vtp\"", ""), "piece 0: expected the name of a file beside");
  expectUnreadable(pieces.changed("a.p0.vtp", ""), "piece 0: expected the name of a file beside this one");
  fs::remove(pieces.index);
  pieces.expectUnreadable("a.pvtp: No such file");
}

TEST(Pvtp, AnIndexWithoutPiecesIsRefused) {
  const Pieces pieces;
  put(pieces.index, "<VTKFile type=\"PPolyData\" >\n</VTKFile>\n");
  pieces.expectUnreadable("a.pvtp: it names no pieces");
}
