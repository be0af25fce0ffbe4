#include "treacle/io/frames/vtp.hpp"

#include "limited_files.hpp"
#include "sample_frame.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/names.hpp"

#include <libdeflate.h>
#include <omp.h>

#include <cstring>
#include <map>
#include <memory>
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
  std::size_t data = 0;  // where the appended data begin

  explicit RawVtp(const fs::path& path) {
    const std::string file = content(path);
    const std::size_t marker = file.find("<AppendedData encoding=\"raw\">\n_");
    EXPECT_NE(marker, file.npos);
    data = file.find('_', marker) + 1;
    header = file.substr(0, marker);
    const bool compressed = header.find(" compressor=\"vtkZLibDataCompressor\">") != header.npos;
    const std::regex array(
        R"re(<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="\d" format="appended" offset="(\d+)" */>)re");
    std::size_t end = 0;
    for (std::sregex_iterator match(header.begin(), header.end(), array), none; match != none; ++match) {
      const std::size_t offset = std::stoul((*match)[3]);
      EXPECT_EQ(offset, end) << "arrays follow each other without gaps";
      type[(*match)[2]] = (*match)[1];
      if (compressed) {
        end = offset + inflate(file.data() + data + offset, bytes[(*match)[2]]);
        continue;
      }
      const std::uint64_t size = number(file.data() + data + offset);
      bytes[(*match)[2]] = file.substr(data + offset + sizeof size, size);
      end = offset + sizeof size + size;
    }
    EXPECT_EQ(file.substr(data + end), "\n  </AppendedData>\n</VTKFile>\n");
  }

  static std::uint64_t number(const char* at) {
    std::uint64_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
  }

  /// As VTK documents it: number of blocks, their size, that of the last one if it is smaller, else 0, and the
  /// sizes of what they are compressed to, before these. Returns how long all is.
  static std::size_t inflate(const char* array, std::string& values) {
    const std::uint64_t blocks = number(array), size = number(array + 8), last = number(array + 16);
    std::size_t at = 8 * (3 + blocks);
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    for (std::uint64_t k = 0; k < blocks; ++k) {
      const std::uint64_t packed = number(array + 8 * (3 + k));
      std::string block(k + 1 == blocks && last > 0 ? last : size, '\0');
      EXPECT_EQ(
          libdeflate_zlib_decompress(decompressor.get(), array + at, packed, block.data(), block.size(), nullptr),
          LIBDEFLATE_SUCCESS);
      values += block;
      at += packed;
    }
    return at;
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
                             "header_type=\"UInt64\""),
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
  const fs::path path = directory / "a.vtp";
  // Around the writer's block of 256 KiB, too, which as scalars in single precision are 65536.
  for (const std::uint32_t count : {0u, 1u, 33u, 21845u, 21846u, 65536u, 70000u})
    for (const OutputCompression compression : {OutputCompression::None, OutputCompression::Zlib}) {
      const Frame frame = sampleFrame(3, count);
      std::uint64_t bytes = writeVtp(path, frame, {}, OutputPrecision::Double, compression);
      EXPECT_EQ(bytes, fs::file_size(path));
      if (count > 0) expectFile<double>(RawVtp(path), frame, "Float64");
      bytes = writeVtp(path, frame, {}, OutputPrecision::Single, compression);
      EXPECT_EQ(bytes, fs::file_size(path));
      if (count > 0) expectFile<float>(RawVtp(path), frame, "Float32");
      EXPECT_EQ(readVtp(path).position.size(), count);
    }
}

TEST(Vtp, CompressedFilesAreSmallerAndTheSameWhateverTheNumberOfThreads) {
  TemporaryDirectory directory;
  const Frame frame = sampleFrame(2, 100000);  // whose third components, materials and bodies say little
  const int threads = omp_get_max_threads();
  for (const int k : {1, 3}) {
    omp_set_num_threads(k);
    writeVtp(directory / std::to_string(k), frame, {}, OutputPrecision::Single, OutputCompression::Zlib);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(content(directory / "1"), content(directory / "3"));
  const auto raw = writeVtp(directory / "raw", frame, {}, OutputPrecision::Single);
  EXPECT_LT(static_cast<double>(fs::file_size(directory / "1")), 0.6 * static_cast<double>(raw));  // 0.55
}

TEST(Vtp, DoublePrecisionReadsBackToTheSameBits) {
  TemporaryDirectory directory;
  for (const OutputCompression compression : {OutputCompression::None, OutputCompression::Zlib}) {
    const int dimensions = compression == OutputCompression::None ? 2 : 3;
    Frame frame = sampleFrame(dimensions, 25000);
    frame.time = 0.1 + 0.2;
    writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Double, compression);
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
  for (const OutputCompression compression : {OutputCompression::None, OutputCompression::Zlib}) {
    writeVtp(path, sampleFrame(2, 40), {}, OutputPrecision::Single, compression);
    const std::string whole = content(path);
    for (std::size_t size = 0; size < whole.size(); size += 13) {
      put(path, whole.substr(0, size));
      const std::string message = messageOf<InputError>([&] { readVtp(path); });
      EXPECT_EQ(message.find(path.string()), 0u) << message;
    }
    put(path, whole.substr(0, whole.size() - 1));
    EXPECT_NE(messageOf<InputError>([&] { readVtp(path); }).find("truncated"), std::string::npos);
  }
}

TEST(Vtp, DamagedBlocksAreFound) {
  TemporaryDirectory directory;
  const fs::path path = directory / "a.vtp";
  writeVtp(path, sampleFrame(2, 40), {}, OutputPrecision::Single, OutputCompression::Zlib);
  const Frame frame = readVtp(path);
  const std::string whole = content(path), vertices = "Name=\"connectivity\"";
  const RawVtp raw(path);
  std::smatch offset;  // of what nobody reads
  const std::regex unread(vertices + ".*offset=\"(\\d+)\"");
  ASSERT_TRUE(std::regex_search(raw.header, offset, unread));
  const std::size_t end = raw.data + std::stoul(offset[1]);
  std::size_t found = 0;
  for (std::size_t at = raw.data; at < end; ++at)
    for (const char bit : {'\x01', '\x80'}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ bit);
      put(path, damaged);
      try {
        const Frame read = readVtp(path);  // whose blocks may be larger, where there is but one
        forEachFrameField([&](const char*, auto member) { EXPECT_EQ(read.*member, frame.*member); });
      } catch (const InputError& e) {
        ++found;
        EXPECT_EQ(std::string(e.what()).find(path.string() + ": damaged"), 0u) << e.what();
      }
    }
  EXPECT_GT(found, 2 * (end - raw.data) * 9 / 10);
}

TEST(Vtp, TablesThatLieTakeNoMemory) {
  TemporaryDirectory directory;
  const fs::path path = directory / "a.vtp";
  OutputFields none;
  for (const OutputFieldName& field : outputFieldNames) none.*field.flag = false;
  writeVtp(path, sampleFrame(2, 40), none, OutputPrecision::Single, OutputCompression::Zlib);
  const std::string whole = content(path);
  const std::size_t table = RawVtp(path).data;  // that of the positions
  const auto messageWith = [&](const std::string& count, const std::vector<std::uint64_t>& numbers) {
    std::string file = whole;
    std::memcpy(file.data() + table, numbers.data(), 8 * numbers.size());
    put(path, file);
    replaceIn(path, "NumberOfPoints=\"40\"", "NumberOfPoints=\"" + count + "\"");
    // The header grows or shrinks by the digits; all else stays where it is said to be.
    return messageOf<InputError>([&] { readVtp(path); });
  };
  const auto expectPart = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  constexpr std::uint64_t block = 1 << 18, huge = 1ull << 62;
  expectPart(messageWith("40", {2, block, 480}), "2 blocks of 262144 bytes, the last of 480, expected 480 bytes");
  expectPart(messageWith("40", {0, block, 480}), "expected 480 bytes");
  expectPart(messageWith("40", {1, 0, 480}), "expected 480 bytes");
  expectPart(messageWith("40", {160, 3, 0}), "160 blocks of 3 bytes");
  expectPart(messageWith("40", {120, 4, 0}), "more blocks than the file");
  expectPart(messageWith("40", {480 / 16, 16, 0}), "blocks that end beyond the file");
  expectPart(messageWith("40", {1, block, 480, huge}), "blocks that end beyond the file");
  expectPart(messageWith("4000000000", {1, huge, 48000000000}), "too few for 48000000000");
  expectPart(messageWith("4000000000", {12000000000, 4, 0}), "more blocks than the file");
  expectPart(messageWith("5000000000", {1, block, 480}), "truncated");
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
  expectPart(messageAfter("header_type=", "compressor=\"vtkLZ4DataCompressor\" header_type="),
             "expected the compressor vtkZLibDataCompressor or none, found vtkLZ4DataCompressor");

  put(path, std::string(100000, 'x'));
  expectPart(messageOf<InputError>([&] { readVtp(path); }), "not a particle file");
  expectPart(messageOf<InputError>([&] { readVtp(directory / "none.vtp"); }), "No such file");
  expectPart(messageOf<InputError>([&] { readVtp(directory.path()); }), directory.path().string());
}

TEST(Vtp, FullDiskLeavesNoFile) {
  TemporaryDirectory directory;
  const Frame frame = sampleFrame(3, 10000);
  for (const OutputCompression compression : {OutputCompression::None, OutputCompression::Zlib})
    EXPECT_TRUE(withFileLimit(100 << 10, [&] {
      return !messageOf<RunError>([&] {
                writeVtp(directory / "a.vtp", frame, {}, OutputPrecision::Double, compression);
              }).empty();
    }));
  EXPECT_TRUE(fs::is_empty(directory.path()));
}
