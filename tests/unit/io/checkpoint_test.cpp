#include "treacle/io/checkpoint.hpp"

#include "limited_files.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/atomic_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <hdf5.h>

#include <cstring>
#include <random>

using namespace treacle;
using namespace treacle::test;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

constexpr double time3 = 3 * 0.1;  // [s]; not the decimal 0.3

/// Every byte of every field is random.
template <int D>
Particles<D> randomParticles(std::uint32_t fluid, std::uint32_t wall) {
  Particles<D> particles;
  particles.resize(fluid, wall, fluid % 4);
  particles.modes.age = {7, 13};
  std::mt19937_64 random(D);
  particles.forEachField([&](auto& field) {
    auto* bytes = reinterpret_cast<unsigned char*>(field.data());
    for (std::size_t k = 0; k < field.size() * sizeof(field[0]); ++k)
      bytes[k] = static_cast<unsigned char>(random());
  });
  return particles;
}

template <class T>
bool sameBits(const Buffer<T>& a, const Buffer<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <int D>
void expectSame(const Particles<D>& a, const Particles<D>& b) {
  EXPECT_EQ(a.fluidCount, b.fluidCount);
  EXPECT_EQ(a.count, b.count);
  EXPECT_TRUE(sameBits(a.position, b.position));
  EXPECT_TRUE(sameBits(a.velocity, b.velocity));
  EXPECT_TRUE(sameBits(a.pressure, b.pressure));
  EXPECT_TRUE(sameBits(a.numberDensity, b.numberDensity));
  EXPECT_TRUE(sameBits(a.material, b.material));
  EXPECT_TRUE(sameBits(a.body, b.body));
  EXPECT_TRUE(sameBits(a.id, b.id));
  EXPECT_TRUE(sameBits(a.acceleration, b.acceleration));
  EXPECT_TRUE(sameBits(a.jerk, b.jerk));
  EXPECT_EQ(a.modeCount(), b.modeCount());
  EXPECT_TRUE(sameBits(a.modes.vectors, b.modes.vectors));
  EXPECT_EQ(a.modes.age, b.modes.age);
}

template <int D>
void checkRoundTrip(std::uint32_t fluid, std::uint32_t wall) {
  TemporaryDirectory directory;
  const Particles<D> particles = randomParticles<D>(fluid, wall);
  const std::int64_t step = std::int64_t{1} << 40;
  writeCheckpoint<D>(directory / "c.h5", particles, step, time3);
  const Checkpoint<D> read = readCheckpoint<D>(directory / "c.h5");
  EXPECT_EQ(read.step, step);
  EXPECT_EQ(read.time, time3);
  expectSame(read.particles, particles);
}

/// A checkpoint with one attribute replaced by another integer.
void changeAttribute(const std::filesystem::path& path, const char* name, int value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_INT, &value), 0);
  H5Aclose(attribute);
  H5Fclose(file);
}

void removeField(const std::filesystem::path& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
  H5Fclose(file);
}

template <int D>
std::string refusal(const std::filesystem::path& path) {
  const std::string message = messageOf<InputError>([&] { readCheckpoint<D>(path); });
  EXPECT_THAT(message, StartsWith(path.string() + ": "));
  return message;
}

}  // namespace

TEST(Checkpoint, ReadsBackToTheSameBits) {
  checkRoundTrip<2>(1, 0);
  checkRoundTrip<2>(33, 31);
  checkRoundTrip<3>(33, 31);
  checkRoundTrip<3>(20000, 5000);  // larger than what HDF5 and the file collect before they write
}

TEST(Checkpoint, TheSameStateGivesTheSameFileAndLeavesNoTemporaryOne) {
  TemporaryDirectory directory;
  const auto particles = randomParticles<3>(100, 50);
  writeCheckpoint<3>(directory / "a.h5", particles, 7, time3);
  put(directory / "b.h5", "an older file");
  writeCheckpoint<3>(directory / "b.h5", particles, 7, time3);
  EXPECT_EQ(content(directory / "a.h5"), content(directory / "b.h5"));
  EXPECT_FALSE(std::filesystem::exists(AtomicFile::temporaryName(directory / "b.h5")));
}

TEST(Checkpoint, AFullDiskKeepsTheOlderOne) {
  TemporaryDirectory directory;
  const auto small = randomParticles<2>(4, 4);
  writeCheckpoint<2>(directory / "c.h5", small, 1, time3);
  EXPECT_TRUE(withFileLimit(1 << 16, [&] {
    const auto message = messageOf<RunError>(
        [&] { writeCheckpoint<2>(directory / "c.h5", randomParticles<2>(4000, 0), 2, 2 * time3); });
    return message == "cannot write " + (directory / "c.h5").string() + ": File too large";
  }));
  EXPECT_EQ(readCheckpoint<2>(directory / "c.h5").step, 1);
  EXPECT_FALSE(std::filesystem::exists(AtomicFile::temporaryName(directory / "c.h5")));
}

TEST(Checkpoint, DirectoryThatDoesNotExist) {
  TemporaryDirectory directory;
  const auto path = directory / "none/c.h5";
  EXPECT_EQ(messageOf<RunError>([&] { writeCheckpoint<2>(path, randomParticles<2>(1, 1), 1, 1); }),
            "cannot write " + path.string() + ": No such file or directory");
}

TEST(Checkpoint, MissingFilesAndDirectoriesAreRefused) {
  TemporaryDirectory directory;
  EXPECT_THAT(refusal<2>(directory / "none.h5"), HasSubstr("No such file or directory"));
  EXPECT_THAT(refusal<2>(directory.path()), HasSubstr("Is a directory"));
}

TEST(Checkpoint, ForeignFilesAreRefused) {
  TemporaryDirectory directory;
  put(directory / "text.h5", "title = \"a case\"\n");
  EXPECT_THAT(refusal<2>(directory / "text.h5"), HasSubstr("not an HDF5 file"));
  H5Fclose(H5Fcreate((directory / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  testing::internal::CaptureStderr();
  EXPECT_THAT(refusal<2>(directory / "other.h5"), HasSubstr("an HDF5 file of another program"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 prints its own errors";
}

TEST(Checkpoint, OtherVersionsAndDimensionsAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<3>(path, randomParticles<3>(5, 5), 1, 1);
  EXPECT_THAT(refusal<2>(path), HasSubstr("3 dimensions, expected 2"));
  for (const int version : {0, 4}) {
    changeAttribute(path, "version", version);
    EXPECT_THAT(refusal<3>(path), HasSubstr(fmt::format("version {}, expected 1 to 3", version)));
  }
}

TEST(Checkpoint, EarlierVersionsAreReadWithoutBodiesAndMemoryOfTheFlow) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  Particles<3> particles = randomParticles<3>(33, 31);
  writeCheckpoint<3>(path, particles, 7, time3);
  ASSERT_EQ(particles.modeCount(), 1u);
  removeField(path, "modes");
  EXPECT_THAT(refusal<3>(path), HasSubstr("modes"));
  removeField(path, "body");
  EXPECT_THAT(refusal<3>(path), HasSubstr("body"));
  changeAttribute(path, "version", 2);
  std::fill(particles.body.begin(), particles.body.end(), unknownBody);
  particles.modes.drop();
  expectSame(readCheckpoint<3>(path).particles, particles);

  removeField(path, "acceleration");
  removeField(path, "jerk");
  EXPECT_THAT(refusal<3>(path), HasSubstr("acceleration"));
  changeAttribute(path, "version", 1);
  const Checkpoint<3> read = readCheckpoint<3>(path);
  EXPECT_EQ(read.step, 7);
  for (auto* field : {&particles.acceleration, &particles.jerk}) std::fill(field->begin(), field->end(), Vec<3>{});
  expectSame(read.particles, particles);
}

TEST(Checkpoint, DamagedFilesAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<2>(path, randomParticles<2>(100, 50), 1, 1);
  const std::string whole = content(path);
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{600}, std::size_t{9}}) {
    put(path, whole.substr(0, size));
    refusal<2>(path);
  }
  put(path, whole);
  changeAttribute(path, "wall_count", 51);
  EXPECT_THAT(refusal<2>(path), HasSubstr("the field position does not have 151 values"));
}
