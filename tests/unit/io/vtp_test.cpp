#include "treacle/io/vtp.hpp"

#include "limited_files.hpp"
#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <cstring>
#include <map>
#include <regex>

using namespace treacle;
using namespace treacle::test;
namespace fs = std::filesystem;

namespace {

/// A .vtp file taken apart without the program's own reader: the bytes of each array by name.
struct RawVtp {
  std::string header;
  std::map<std::string, std::string> type;
  std::map<std::string, std::string> bytes;

  explicit RawVtp(const fs::path& path) {
    const std::string file = content(path);
    const std::size_t marker = file.find("<AppendedData encoding=\"raw\">\n_");
    EXPECT_NE(marker, file.npos);
    const std::size_t data = file.find('_', marker) + 1;
    header = file.substr(0, marker);
    const std::regex array(
        R"re(<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="\d" format="appended" offset="(\d+)"/>)re");
    std::size_t end = 0;
    for (std::sregex_iterator match(header.begin(), header.end(), array), none; match != none; ++match) {
      const std::size_t offset = std::stoul((*match)[3]);
      EXPECT_EQ(offset, end) << "arrays follow each other without gaps";
      std::uint64_t size = 0;
      std::memcpy(&size, file.data() + data + offset, sizeof size);
      type[(*match)[2]] = (*match)[1];
      bytes[(*match)[2]] = file.substr(data + offset + sizeof size, size);
      end = offset + sizeof size + size;
    }
    EXPECT_EQ(file.substr(data + end), "\n  </AppendedData>\n</VTKFile>\n");
  }

  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::string& raw = bytes.at(name);
    std::vector<T> result(raw.size() / sizeof(T));
    std::memcpy(result.data(), raw.data(), raw.size());
    return result;
  }
};

template <class Real>
void expectFile(const RawVtp& file, const Frame& frame, const std::string& realType) {
  const std::size_t n = frame.position.size();
  EXPECT_NE(file.header.find("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                             "header_type=\"UInt64\">"),
            std::string::npos);
  EXPECT_NE(file.header.find("<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfVerts=\"" +
                             std::to_string(n) + "\" "),
            std::string::npos);
  const std::map<std::string, std::string> types{{"velocity", realType},
                                                 {"pressure", realType},
                                                 {"number_density", realType},
                                                 {"nearest_distance", realType},
                                                 {"material", "Int32"},
                                                 {"body", "Int32"},
                                                 {"id", "UInt32"},
                                                 {"position", realType},
                                                 {"connectivity", "Int32"},
                                                 {"offsets", "Int32"}};
  EXPECT_EQ(file.type, types);
  const auto position = file.values<Real>("position"), velocity = file.values<Real>("velocity");
  const auto pressure = file.values<Real>("pressure"), density = file.values<Real>("number_density");
  const auto nearest = file.values<Real>("nearest_distance");
  const auto connectivity = file.values<std::int32_t>("connectivity"),
             offsets = file.values<std::int32_t>("offsets");
  ASSERT_EQ(position.size(), 3 * n);
  ASSERT_EQ(velocity.size(), 3 * n);
  ASSERT_EQ(pressure.size(), n);
  ASSERT_EQ(density.size(), n);
  ASSERT_EQ(nearest.size(), n);
  ASSERT_EQ(connectivity.size(), n);
  ASSERT_EQ(offsets.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(position[3 * i + static_cast<std::size_t>(k)], static_cast<Real>(frame.position[i][k]));
      ASSERT_EQ(velocity[3 * i + static_cast<std::size_t>(k)], static_cast<Real>(frame.velocity[i][k]));
    }
    ASSERT_EQ(pressure[i], static_cast<Real>(frame.pressure[i]));
    ASSERT_EQ(density[i], static_cast<Real>(frame.numberDensity[i]));
    ASSERT_EQ(nearest[i], static_cast<Real>(frame.nearestDistance[i]));
    ASSERT_EQ(connectivity[i], static_cast<std::int32_t>(i));
    ASSERT_EQ(offsets[i], static_cast<std::int32_t>(i + 1));
  }
  EXPECT_EQ(file.values<std::int32_t>("material"), frame.material);
  EXPECT_EQ(file.values<std::int32_t>("body"), frame.body);
  EXPECT_EQ(file.values<std::uint32_t>("id"), frame.id);
}

void replaceIn(const fs::path& path, const std::string& from, const std::string& to) {
  std::string text = content(path);
  ASSERT_NE(text.find(from), text.npos);
  put(path, text.replace(text.find(from), from.size(), to));
}

}  // namespace

TEST(Vtp, BytesAreWhatTheHeaderSays) {
  TemporaryDirectory directory;
  // Around the writer's block of 65536 numbers, too.
  for (const std::uint32_t count : {0u, 1u, 33u, 21845u, 21846u, 70000u}) {
    const Frame frame = sampleFrame(3, count);
    writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Double);
    if (count > 0) expectFile<double>(RawVtp(directory / "a.vtp"), frame, "Float64");
    writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Single);
    if (count > 0) expectFile<float>(RawVtp(directory / "a.vtp"), frame, "Float32");
    EXPECT_EQ(readVtp(directory / "a.vtp").position.size(), count);
  }
}

TEST(Vtp, DoublePrecisionReadsBackToTheSameBits) {
  TemporaryDirectory directory;
  for (const int dimensions : {2, 3}) {
    Frame frame = sampleFrame(dimensions, 1000);
    frame.time = 0.1 + 0.2;
    writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Double);
    const Frame read = readVtp(directory / "a.vtp");
    EXPECT_EQ(read.dimensions, dimensions);
    EXPECT_EQ(read.time, frame.time);
    EXPECT_TRUE(read.position == frame.position);
    EXPECT_TRUE(read.velocity == frame.velocity);
    EXPECT_EQ(read.pressure, frame.pressure);
    EXPECT_EQ(read.numberDensity, frame.numberDensity);
    EXPECT_EQ(read.nearestDistance, frame.nearestDistance);
    EXPECT_EQ(read.material, frame.material);
    EXPECT_EQ(read.body, frame.body);
    EXPECT_EQ(read.id, frame.id);
  }
}

TEST(Vtp, SinglePrecisionReadsBackRounded) {
  TemporaryDirectory directory;
  const Frame frame = sampleFrame(3, 1000);
  writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Single);
  const Frame read = readVtp(directory / "a.vtp");
  EXPECT_EQ(read.time, frame.time);
  ASSERT_EQ(read.position.size(), 1000u);
  for (std::size_t i = 0; i < 1000; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(read.position[i][k], double(float(frame.position[i][k])));
    EXPECT_EQ(read.pressure[i], double(float(frame.pressure[i])));
  }
  EXPECT_EQ(read.id, frame.id);
}

TEST(Vtp, HoldsOnlySelectedFields) {
  TemporaryDirectory directory;
  const Frame frame = sampleFrame(2, 50);
  OutputFields fields;
  fields.pressure = fields.nearestDistance = fields.id = fields.material = fields.body = false;
  writeVtp(directory / "a.vtp", frame, fields, OutputPrecision::Double);
  const RawVtp raw(directory / "a.vtp");
  EXPECT_EQ(raw.bytes.size(), 5u);  // velocity, number_density, position, connectivity, offsets
  EXPECT_EQ(raw.bytes.count("pressure"), 0u);
  const Frame read = readVtp(directory / "a.vtp");
  EXPECT_TRUE(read.velocity == frame.velocity);
  EXPECT_EQ(read.numberDensity, frame.numberDensity);
  EXPECT_TRUE(read.pressure.empty() && read.nearestDistance.empty() && read.material.empty() &&
              read.body.empty() && read.id.empty());
}

TEST(Vtp, TruncatedFilesAreRefusedWhereverTheyEnd) {
  TemporaryDirectory directory;
  const fs::path path = directory / "a.vtp";
  writeVtp(path, sampleFrame(2, 40), {}, OutputPrecision::Single);
  const std::string whole = content(path);
  for (std::size_t size = 0; size < whole.size(); size += 13) {
    put(path, whole.substr(0, size));
    const std::string message = messageOf<InputError>([&] { readVtp(path); });
    EXPECT_EQ(message.find(path.string()), 0u) << message;
  }
  put(path, whole.substr(0, whole.size() - 1));
  EXPECT_NE(messageOf<InputError>([&] { readVtp(path); }).find("truncated"), std::string::npos);
}

TEST(Vtp, ForeignFilesAreRefused) {
  TemporaryDirectory directory;
  const fs::path path = directory / "a.vtp";
  const auto messageAfter = [&](const std::string& from, const std::string& to) {
    writeVtp(path, sampleFrame(2, 40), {}, OutputPrecision::Single);
    replaceIn(path, from, to);
    return messageOf<InputError>([&] { readVtp(path); });
  };
  const auto expectPart = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expectPart(messageAfter("PolyData", "ImageData"), "no VTK PolyData");
  expectPart(messageAfter("UInt64", "UInt32"), "UInt64 headers");
  expectPart(messageAfter("LittleEndian", "BigEndian"), "LittleEndian");
  expectPart(messageAfter("NumberOfPoints=\"40\"", "NumberOfPoints=\"39\""), "bytes, expected");
  expectPart(messageAfter("NumberOfPoints=\"40\"", "NumberOfPoints=\"400000000000\""), "truncated");
  expectPart(messageAfter("Name=\"position\"", "Name=\"elsewhere\""), "no particle positions");
  expectPart(messageAfter("Name=\"TimeValue\"", "Name=\"Time\""), "no field 'TimeValue'");
  expectPart(messageAfter("format=\"ascii\">0.1", "format=\"ascii\">nan</DataArray>0.1"),
             "'TimeValue' is not finite");
  expectPart(messageAfter("type=\"UInt32\" Name=\"id\"", "type=\"String\" Name=\"id\""),
             "'id' has an unexpected type");
  expectPart(messageAfter("type=\"UInt32\" Name=\"id\"", "type=\"Float32\" Name=\"id\""),
             "expected whole numbers from 0 to 4294967295");
  expectPart(messageAfter("encoding=\"raw\"", "encoding=\"base64\""), "truncated");

  put(path, std::string(100000, 'x'));
  expectPart(messageOf<InputError>([&] { readVtp(path); }), "not a particle file");
  expectPart(messageOf<InputError>([&] { readVtp(directory / "none.vtp"); }), "No such file");
  expectPart(messageOf<InputError>([&] { readVtp(directory.path()); }), directory.path().string());
}

TEST(Vtp, FullDiskLeavesNoFile) {
  TemporaryDirectory directory;
  const Frame frame = sampleFrame(3, 10000);
  EXPECT_TRUE(withFileLimit(100 << 10, [&] {
    return !messageOf<RunError>([&] {
              writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Double);
            }).empty();
  }));
  EXPECT_TRUE(fs::is_empty(directory.path()));
}
