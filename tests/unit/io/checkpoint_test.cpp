#include "treacle/io/checkpoint/checkpoint.hpp"

#include "files/checksum.hpp"
#include "limited_files.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <type_traits>
#include <vector>

using namespace treacle;
using namespace treacle::test;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

constexpr double time3 = 3 * 0.1;  // [s]; not the decimal 0.3

/// Every number of every field is random, the ids in a random order.
template <int D>
Particles<D> randomParticles(std::uint32_t fluid, std::uint32_t wall) {
  Particles<D> particles;
  particles.resize({fluid,
                    wall,
                    fluid % 4,
                    0,
                    0,
                    {fluid % 2 == 0, fluid % 2 == 0, fluid % 2 == 0, static_cast<std::uint8_t>(fluid % 5),
                     static_cast<std::uint8_t>(fluid % 3), false, fluid % 2 == 0}});
  particles.modes.age = {7, 13};
  particles.modes.pressure = {3.75, 4, 6};
  particles.steps = {0.01, 0.02, 0.3};
  particles.bulk = {2, 64, 4, 0.007, 0.05};
  std::mt19937_64 random(D);
  std::uniform_real_distribution<double> real(-1, 1);
  particles.forEachField([&]<class T>(Buffer<T>& field) {
    for (T& value : field)
      if constexpr (requires { value.v; })
        std::generate(std::begin(value.v), std::end(value.v), [&] { return real(random); });
      else if constexpr (requires { value.a; })
        std::generate(std::begin(value.a), std::end(value.a), [&] { return real(random); });
      else if constexpr (std::is_floating_point_v<T>)
        value = std::abs(real(random));
      else if constexpr (std::is_integral_v<T>)
        value = static_cast<T>(random());
  });
  std::iota(particles.id.begin(), particles.id.end(), 0u);
  std::shuffle(particles.id.begin(), particles.id.begin() + fluid, random);
  std::shuffle(particles.id.begin() + fluid, particles.id.end(), random);
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
  EXPECT_TRUE(sameBits(a.side, b.side));
  EXPECT_TRUE(sameBits(a.velocity, b.velocity));
  EXPECT_TRUE(sameBits(a.pressure, b.pressure));
  EXPECT_TRUE(sameBits(a.numberDensity, b.numberDensity));
  EXPECT_TRUE(sameBits(a.material, b.material));
  EXPECT_TRUE(sameBits(a.body, b.body));
  EXPECT_TRUE(sameBits(a.id, b.id));
  EXPECT_TRUE(sameBits(a.acceleration, b.acceleration));
  EXPECT_TRUE(sameBits(a.jerk, b.jerk));
  EXPECT_EQ(a.has, b.has);
  EXPECT_TRUE(sameBits(a.shearRate, b.shearRate));
  EXPECT_TRUE(sameBits(a.temperature, b.temperature));
  EXPECT_TRUE(sameBits(a.viscosityFactor, b.viscosityFactor));
  for (std::size_t k = 0; k < maxStates; ++k) EXPECT_TRUE(sameBits(a.states[k], b.states[k]));
  for (std::size_t k = 0; k < maxElasticModes; ++k) EXPECT_TRUE(sameBits(a.conformation[k], b.conformation[k]));
  EXPECT_EQ(a.modeCount(), b.modeCount());
  EXPECT_TRUE(sameBits(a.modes.vectors, b.modes.vectors));
  EXPECT_EQ(a.modes.age, b.modes.age);
  EXPECT_EQ(a.modes.pressure, b.modes.pressure);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.bulk, b.bulk);
}

template <int D>
void checkRoundTrip(std::uint32_t fluid, std::uint32_t wall) {
  TemporaryDirectory directory;
  const Particles<D> particles = randomParticles<D>(fluid, wall);
  const std::int64_t step = std::int64_t{1} << 40;
  writeCheckpoint<D>(directory / "c.h5", particles, step, time3, MethodKind::MphI);
  const Checkpoint<D> read = readCheckpoint<D>(directory / "c.h5");
  EXPECT_EQ(read.step, step);
  EXPECT_EQ(read.time, time3);
  EXPECT_EQ(read.method, MethodKind::MphI);
  expectSame(read.particles, particles);
}

/// Puts a checksum at the end of the file.
void seal(const std::filesystem::path& path) {
  const std::string changed = content(path);
  const ChecksumRecord record = ChecksumRecord::of(changed.data(), changed.size());
  put(path, changed + std::string(reinterpret_cast<const char*>(&record), sizeof record));
}

/// HDF5 cuts the checksum off the files that it changes.
void close(hid_t file, const std::filesystem::path& path) {
  H5Fclose(file);
  seal(path);
}

/// A checkpoint with one attribute replaced by another number.
void changeAttribute(const std::filesystem::path& path, const char* name, double value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value), 0);
  H5Aclose(attribute);
  close(file, path);
}

/// The attribute becomes one of `count` values of a type.
void replaceAttribute(const std::filesystem::path& path, const char* name, hid_t type, hsize_t count) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Adelete(file, name), 0);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(attribute, 0);
  H5Aclose(attribute);
  H5Sclose(space);
  close(file, path);
}

/// A field becomes one of other extents that no value was ever written to.
void replaceField(const std::filesystem::path& path, const char* name, hid_t type, std::vector<hsize_t> extents) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
  const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  const hid_t field = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(field, 0);
  H5Dclose(field);
  H5Sclose(space);
  close(file, path);
}

/// Another number at this place of a field, counted over all components.
void changeField(const std::filesystem::path& path, const char* name, std::size_t place, double value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t field = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(field);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  ASSERT_GE(H5Dread(field, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  values.at(place) = value;
  ASSERT_GE(H5Dwrite(field, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(field);
  close(file, path);
}

void removeField(const std::filesystem::path& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
  close(file, path);
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

/// As many walls as the modes of the fluid have values: fields must not be taken for each other.
TEST(Checkpoint, PartsOfTheFluidAreRead) {
  TemporaryDirectory directory;
  for (const std::uint32_t wall : {0u, 31u, 62u}) {
    const std::uint32_t fluid = 31;
    const Particles<3> whole = randomParticles<3>(fluid, wall);
    ASSERT_EQ(whole.modeCount(), 3u);
    writeCheckpoint<3>(directory / "c.h5", whole, 7, 0.5, MethodKind::MphI);
    for (const std::uint32_t parts : {1u, 2u, 5u, 31u})
      for (std::uint32_t k = 0; k < parts; ++k) {
        const ParticlePart part{k, parts};
        const Checkpoint<3> read = readCheckpoint<3>(directory / "c.h5", part);
        const std::uint32_t begin = part.begin(fluid), size = part.size(fluid);
        EXPECT_EQ(read.fluidOfAll, fluid);
        EXPECT_EQ(read.wallsOfAll, wall);
        // Walls stand in the file in whatever order; a part has those with its ids.
        std::vector<std::uint32_t> walls(wall);
        std::iota(walls.begin(), walls.end(), fluid);
        if (parts > 1) {
          std::ranges::sort(walls, {}, [&](std::uint32_t i) { return whole.id[i]; });
          walls.erase(walls.begin() + part.end(wall), walls.end());
          walls.erase(walls.begin(), walls.begin() + part.begin(wall));
        }
        Particles<3> expected;
        expected.resize({size, walls.size(), 3, 0, 0, whole.has});
        expected.copyNumbers(whole);
        forEachSharedFieldOf(
            [&](const auto& from, auto& to) {
              std::copy_n(from.begin() + begin, size, to.begin());
              for (std::size_t w = 0; w < walls.size(); ++w) to[size + w] = from[walls[w]];
            },
            whole, expected);
        forEachFluidFieldOf(
            [&](const auto& from, auto& to) { std::copy_n(from.begin() + begin, size, to.begin()); }, whole,
            expected);
        for (std::uint32_t m = 0; m < 3; ++m)
          std::copy_n(whole.modes.vectors.begin() + m * fluid + begin, size,
                      expected.modes.vectors.begin() + m * size);
        expectSame(read.particles, expected);
      }
  }
}

TEST(Checkpoint, TheSameStateGivesTheSameFileAndLeavesNoTemporaryOne) {
  TemporaryDirectory directory;
  const auto particles = randomParticles<3>(100, 50);
  writeCheckpoint<3>(directory / "a.h5", particles, 7, time3, MethodKind::MphI);
  put(directory / "b.h5", "an older file");
  writeCheckpoint<3>(directory / "b.h5", particles, 7, time3, MethodKind::MphI);
  EXPECT_EQ(content(directory / "a.h5"), content(directory / "b.h5"));
  EXPECT_FALSE(std::filesystem::exists(AtomicFile::temporaryName(directory / "b.h5")));
}

TEST(Checkpoint, AFullDiskKeepsTheOlderOne) {
  TemporaryDirectory directory;
  const auto small = randomParticles<2>(4, 4);
  writeCheckpoint<2>(directory / "c.h5", small, 1, time3, MethodKind::MphI);
  EXPECT_TRUE(withFileLimit(1 << 16, [&] {
    const auto message = messageOf<RunError>([&] {
      writeCheckpoint<2>(directory / "c.h5", randomParticles<2>(4000, 0), 2, 2 * time3, MethodKind::MphI);
    });
    return message == "cannot write " + (directory / "c.h5").string() + ": File too large";
  }));
  EXPECT_EQ(readCheckpoint<2>(directory / "c.h5").step, 1);
  EXPECT_FALSE(std::filesystem::exists(AtomicFile::temporaryName(directory / "c.h5")));
}

TEST(Checkpoint, DirectoryThatDoesNotExist) {
  TemporaryDirectory directory;
  const auto path = directory / "none/c.h5";
  EXPECT_EQ(
      messageOf<RunError>([&] { writeCheckpoint<2>(path, randomParticles<2>(1, 1), 1, 1, MethodKind::MphI); }),
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
  EXPECT_THAT(refusal<2>(directory / "other.h5"),
              HasSubstr("its checksum is missing: it is cut off, another program has written it"));
  H5Fclose(H5Fcreate((directory / "sealed.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  seal(directory / "sealed.h5");
  EXPECT_THAT(refusal<2>(directory / "sealed.h5"), HasSubstr("an HDF5 file of another program"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 prints its own errors";
}

TEST(Checkpoint, OtherFormatsAndDimensionsAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<3>(path, randomParticles<3>(5, 5), 1, 1, MethodKind::MphI);
  EXPECT_THAT(refusal<2>(path), HasSubstr("3 dimensions, expected 2"));
  for (const int format : {0, 3, 11, 13}) {
    changeAttribute(path, "version", format);
    EXPECT_THAT(refusal<3>(path), HasSubstr(fmt::format("a checkpoint of format {}, expected format 12", format)));
  }
}

/// A field that a state has or not, and a value that it cannot have.
void expectFieldOrNot(const char* name, bool FluidExtras::*has, Buffer<double> Particles<2>::*field, double bad,
                      const std::string& text) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  Particles<2> particles = randomParticles<2>(6, 5);
  ASSERT_TRUE(particles.has.*has);
  writeCheckpoint<2>(path, particles, 7, time3, MethodKind::MphI);
  expectSame(readCheckpoint<2>(path).particles, particles);
  removeField(path, name);
  EXPECT_THAT(refusal<2>(path), HasSubstr(name));
  Particles<2> without = randomParticles<2>(6, 5);
  without.has.*has = false;
  (without.*field).resize(0);
  writeCheckpoint<2>(path, without, 7, time3, MethodKind::MphI);
  expectSame(readCheckpoint<2>(path).particles, without);
  (particles.*field)[3] = bad;
  EXPECT_THAT(messageOf<RunError>([&] { writeCheckpoint<2>(path, particles, 7, time3, MethodKind::MphI); }),
              HasSubstr(text));
}

TEST(Checkpoint, ShearRatesAreThereOrNot) {
  expectFieldOrNot("shear_rate", &FluidExtras::shearRates, &Particles<2>::shearRate, -1,
                   "a shear rate of -1 1/s, expected at least 0");
}

TEST(Checkpoint, TemperaturesAreThereOrNot) {
  expectFieldOrNot("temperature", &FluidExtras::temperatures, &Particles<2>::temperature, 0,
                   "a temperature of 0 K, expected more than 0");
}

TEST(Checkpoint, FactorsOfViscositiesAreThereOrNot) {
  expectFieldOrNot("viscosity_factor", &FluidExtras::viscosityFactors, &Particles<2>::viscosityFactor, 0,
                   "a factor of the viscosity of 0, expected more than 0");
}

TEST(Checkpoint, StatesComeBackWithTheirNames) {
  TemporaryDirectory directory;
  Particles<2> particles = randomParticles<2>(100, 50);
  particles.has.states = 2;
  for (std::size_t k = 0; k < 2; ++k) {
    particles.states[k].resize(100);
    for (std::uint32_t i = 0; i < 100; ++i) particles.states[k][i] = 0.1 * i - static_cast<double>(k);
  }
  StateNames names;
  names.states = {"cure", "structure"};
  writeCheckpoint<2>(directory / "c.h5", particles, 7, time3, MethodKind::MphI, names);
  const Checkpoint<2> read = readCheckpoint<2>(directory / "c.h5");
  EXPECT_EQ(read.names.states, names.states);
  expectSame(read.particles, particles);
  particles.states[1][3] = std::nan("");
  EXPECT_THAT(messageOf<RunError>(
                  [&] { writeCheckpoint<2>(directory / "c.h5", particles, 7, time3, MethodKind::MphI, names); }),
              HasSubstr("value 3 of the field state_1 is not finite"));
}

TEST(Checkpoint, DamagedFilesAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<2>(path, randomParticles<2>(100, 50), 1, 1, MethodKind::MphI);
  const std::string whole = content(path);
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{600}, std::size_t{9}}) {
    put(path, whole.substr(0, size));
    refusal<2>(path);
  }
  put(path, whole.substr(0, whole.size() - sizeof(ChecksumRecord)));
  EXPECT_THAT(refusal<2>(path), HasSubstr("its checksum is missing"));
  put(path, whole);
  changeAttribute(path, "wall_count", 51);
  EXPECT_THAT(refusal<2>(path), HasSubstr("the field position does not have 151 values"));
}

TEST(Checkpoint, AttributesOfOtherSizesAndTypesAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  const auto expectRefused = [&](const char* name, hid_t type, hsize_t count, const std::string& why) {
    writeCheckpoint<2>(path, randomParticles<2>(5, 5), 1, 1, MethodKind::MphI);
    replaceAttribute(path, name, type, count);
    EXPECT_THAT(refusal<2>(path), HasSubstr(why)) << name;
  };
  const hid_t text = H5Tcreate(H5T_STRING, 1000);
  for (const char* name : {"version", "dimensions", "step", "time", "fluid_count", "wall_count", "mode_count",
                           "modes_due", "modes_fewest_iterations"}) {
    expectRefused(name, H5T_NATIVE_DOUBLE, 1000, fmt::format("the attribute {} has 1000 values", name));
    expectRefused(name, text, 1, fmt::format("the attribute {} has an unexpected type", name));
  }
  for (const char* name : {"format", "method"}) {
    expectRefused(name, text, 1, fmt::format("the attribute {} is no short text", name));
    expectRefused(name, text, 3, fmt::format("the attribute {} has 3 values", name));
    expectRefused(name, H5T_NATIVE_INT, 1, fmt::format("the attribute {} has an unexpected type", name));
  }
  H5Tclose(text);
}

TEST(Checkpoint, NumbersThatNoSimulationHasAreRefused) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  const auto expectRefused = [&](const char* name, double value, const std::string& why) {
    writeCheckpoint<2>(path, randomParticles<2>(5, 5), 1, 1, MethodKind::MphI);
    changeAttribute(path, name, value);
    EXPECT_THAT(refusal<2>(path), HasSubstr(why)) << name;
  };
  expectRefused("time", std::nan(""), "after step 1 at t = nan s");
  expectRefused("time", -1, "after step 1 at t = -1 s");
  expectRefused("time", INFINITY, "after step 1 at t = inf s");
  expectRefused("step", -1, "after step -1 at t = 1 s");
  expectRefused("fluid_count", 4294967295.0, "particles, more than the limit of 4294966272");
  expectRefused("fluid_count", 4e9, " does not have 4000000005 values");  // before there is memory for them
  expectRefused("time_step", -1, "time steps of -1 and 0.02 s with an error rate of 0.3 1/s");
  expectRefused("planned_time_step", INFINITY, "time steps of 0.01 and inf s");
  expectRefused("time_step_error_rate", std::nan(""), "an error rate of nan 1/s");
  // 16 bytes for each of the particles and modes would be 51 GB.
  expectRefused("mode_count", 4e9, "4000000000 modes, more than the limit of 16");
}

TEST(Checkpoint, FieldsWithoutTheirValuesAreRefusedBeforeMemoryIsTaken) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<2>(path, randomParticles<2>(5, 5), 1, 1, MethodKind::MphI);
  replaceField(path, "pressure", H5T_NATIVE_INT, {10});
  EXPECT_THAT(refusal<2>(path), HasSubstr("the field pressure has an unexpected type"));
  changeAttribute(path, "fluid_count", 1e8);
  replaceField(path, "position", H5T_NATIVE_DOUBLE, {100000005, 2});
  EXPECT_THAT(refusal<2>(path), HasSubstr("the file ends before the 100000005 values of the field position do"));
}

TEST(Checkpoint, ValuesThatNoSimulationHasAreNotRead) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  const Particles<2> sound = randomParticles<2>(5, 5);
  const auto expectRefused = [&](const char* field, std::vector<std::pair<std::size_t, double>> changes,
                                 const std::string& why) {
    writeCheckpoint<2>(path, sound, 1, 1, MethodKind::MphI);
    for (const auto& [place, value] : changes) changeField(path, field, place, value);
    EXPECT_THAT(refusal<2>(path), HasSubstr(why));
  };
  const auto expectNotFinite = [&](const char* field, std::size_t place, double value) {
    expectRefused(field, {{place, value}}, fmt::format("value 3 of the field {} is not finite", field));
  };
  expectNotFinite("position", 7, std::nan(""));
  expectNotFinite("velocity", 6, INFINITY);
  expectNotFinite("pressure", 3, std::nan(""));
  expectNotFinite("number_density", 3, std::nan(""));
  expectNotFinite("acceleration", 6, std::nan(""));
  expectNotFinite("jerk", 6, std::nan(""));
  expectNotFinite("modes", 6, std::nan(""));
  expectRefused("id", {{3, 10}}, "a particle has id 10, expected less than 10");
  expectRefused("id", {{3, sound.id[4]}}, "two particles have the id ");
  expectRefused("id", {{3, sound.id[7]}, {7, sound.id[3]}}, "is among those of the other kind");
}

TEST(Checkpoint, AStateThatCannotBeReadDoesNotReplaceAnother) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<2>(path, randomParticles<2>(5, 5), 7, time3, MethodKind::MphI);
  const auto expectRefused = [&](auto change, const std::string& why) {
    Particles<2> particles = randomParticles<2>(5, 5);
    change(particles);
    EXPECT_THAT(messageOf<RunError>([&] { writeCheckpoint<2>(path, particles, 8, 1, MethodKind::MphI); }),
                HasSubstr(why));
    EXPECT_EQ(readCheckpoint<2>(path).step, 7);
  };
  expectRefused([](auto& p) { p.velocity[3][0] = std::nan(""); }, "value 3 of the field velocity is not finite");
  expectRefused([](auto& p) { p.modes.vectors[3][0] = NAN; }, "value 3 of the field modes is not finite");
  expectRefused([](auto& p) { p.id[3] = p.id[4]; }, "two particles have the id ");
}

TEST(Checkpoint, AChangedByteIsFoundWhereverItIs) {
  TemporaryDirectory directory;
  const auto path = directory / "c.h5";
  writeCheckpoint<2>(path, randomParticles<2>(5, 5), 7, time3, MethodKind::MphI);
  const std::string whole = content(path);
  for (std::size_t k = 0; k < whole.size(); k += 7) {
    std::string changed = whole;
    changed[k] = static_cast<char>(changed[k] ^ 1 << k % 8);
    put(path, changed);
    refusal<2>(path);
  }
}
