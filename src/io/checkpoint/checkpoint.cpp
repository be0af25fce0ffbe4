#include "treacle/io/checkpoint/checkpoint.hpp"

#include "checkpoint_fields.hpp"
#include "checkpoint_motion.hpp"
#include "files/checksum.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace treacle {
namespace {

constexpr std::string_view formatName = "treacle checkpoint";
constexpr std::int32_t formatVersion = 12;  // no other one is read

/// Takes so many bytes and gives them back: HDF5 ends the program where memory gives out. Errors: std::bad_alloc.
void requireRoom(std::size_t bytes) { ::operator delete(::operator new(bytes)); }

bool isFinite(double x) { return std::isfinite(x); }
template <int D, class T>
bool isFinite(const Vec<D, T>& x) {
  return std::all_of(x.v, x.v + D, [](T component) { return std::isfinite(component); });
}

template <int D>
bool isFinite(const SymmetricBlock<D>& m) {
  return std::all_of(m.a, m.a + m.size, [](double component) { return std::isfinite(component); });
}

/// Errors: Hdf5Error.
template <int D>
void requireSound(const Particles<D>& particles) {
  forEachNamedField(particles, [&]<class T>(const FieldInfo& info, const Buffer<T>& field) {
    if constexpr (!std::is_integral_v<T>)
      for (std::size_t k = 0; k < field.size(); ++k)
        if (!isFinite(field[k]))
          throw Hdf5Error(fmt::format("value {} of the field {} is not finite", k, info.name));
  });
  for (const double rate : particles.shearRate)
    if (rate < 0) throw Hdf5Error(fmt::format("a shear rate of {} 1/s, expected at least 0", rate));
  for (const double T : particles.temperature)
    if (!(T > 0)) throw Hdf5Error(fmt::format("a temperature of {} K, expected more than 0", T));
  for (const double factor : particles.viscosityFactor)
    if (!(factor > 0))
      throw Hdf5Error(fmt::format("a factor of the viscosity of {}, expected more than 0", factor));
}

/// Looks at the ids of all particles, `fluid` of which come first: those of walls follow each other, after those
/// that the fluid had at the start. Returns that of the first wall. Errors: Hdf5Error.
std::uint32_t requireIds(std::span<const std::uint32_t> ids, std::uint32_t fluid, const OpenFlow& flow) {
  const bool open = flow.nextId > 0;
  const std::uint64_t end = open ? flow.nextId : ids.size();
  const std::uint32_t walls = static_cast<std::uint32_t>(ids.size()) - fluid;
  const std::uint32_t first = open && walls > 0 ? *std::ranges::min_element(ids.subspan(fluid)) : fluid;
  std::vector<bool> taken(end);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t id = ids[i];
    if (id >= end) throw Hdf5Error(fmt::format("a particle has id {}, expected less than {}", id, end));
    if ((id - first < walls) == (i < fluid))
      throw Hdf5Error(fmt::format("particle {} is among those of the other kind", id));
    if (taken[id]) throw Hdf5Error(fmt::format("two particles have the id {}", id));
    taken[id] = true;
  }
  return first;
}

void writeNames(hid_t file, const std::string& kind, const std::vector<std::string>& names) {
  writeAttribute(file, (kind + "_name_count").c_str(), static_cast<std::uint32_t>(names.size()));
  for (std::size_t k = 0; k < names.size(); ++k)
    writeText(file, fmt::format("{}_name_{}", kind, k).c_str(), names[k]);
}
std::vector<std::string> readNames(hid_t file, const std::string& kind, std::uint32_t most) {
  const auto count = readAttribute<std::uint32_t>(file, (kind + "_name_count").c_str());
  if (count > most) throw Hdf5Error(fmt::format("names of {} {}s, more than {}", count, kind, most));
  std::vector<std::string> names;
  for (std::uint32_t k = 0; k < count; ++k)
    names.push_back(readText(file, fmt::format("{}_name_{}", kind, k).c_str()));
  return names;
}

template <int D>
void fill(hid_t file, const Particles<D>& particles, std::int64_t step, double time, MethodKind method,
          const StateNames& names) {
  writeText(file, "format", formatName);
  writeAttribute(file, "version", formatVersion);
  writeText(file, "method", nameOf(method));
  writeAttribute(file, "dimensions", std::int32_t{D});
  writeAttribute(file, "step", step);
  writeAttribute(file, "time", time);
  writeAttribute(file, "fluid_count", particles.fluidCount);
  writeAttribute(file, "wall_count", particles.wallCount());
  writeAttribute(file, "has_shear_rates", std::uint8_t{particles.has.shearRates});
  writeAttribute(file, "has_temperatures", std::uint8_t{particles.has.temperatures});
  writeAttribute(file, "has_viscosity_factors", std::uint8_t{particles.has.viscosityFactors});
  if (particles.has.states > 0) {
    writeAttribute(file, "states", std::uint8_t{particles.has.states});
    writeNames(file, "state", names.states);
  }
  if (particles.has.elasticModes > 0)
    writeAttribute(file, "elastic_modes", std::uint8_t{particles.has.elasticModes});
  if (particles.has.sides) writeAttribute(file, "has_sides", std::uint8_t{1});
  const ModeAge& age = particles.modes.age;
  writeAttribute(file, "mode_count", particles.modeCount());
  writeAttribute(file, "modes_due", age.due);
  writeAttribute(file, "modes_fewest_iterations", age.fewest);
  const KeptEigenvalue& pressure = particles.modes.pressure;
  writeAttribute(file, "pressure_eigenvalue", pressure.value);
  writeAttribute(file, "pressure_eigenvalue_due", pressure.due);
  writeAttribute(file, "pressure_eigenvalue_fewest_iterations", pressure.fewest);
  writeAttribute(file, "time_step", particles.steps.last);
  writeAttribute(file, "planned_time_step", particles.steps.planned);
  writeAttribute(file, "time_step_error_rate", particles.steps.rate);
  writeBulk(file, particles.bulk);
  writeNames(file, "material", names.materials), writeNames(file, "body", names.bodies);
  writeFlow(file, particles.flow);
  writeRigid(file, particles.rigid);
  writeGas(file, particles.gas);
  writeResponse(file, particles.response);
  forEachNamedField(particles, [&](const FieldInfo& info, const auto& field) { writeField(file, info, field); });
}

/// Errors: Hdf5Error unless the file says that it is a checkpoint of this format and dimension.
void requireFormat(hid_t file, int dimensions) {
  if (readText(file, "format") != formatName) throw Hdf5Error("an HDF5 file of another program");
  if (const auto found = readAttribute<std::int32_t>(file, "version"); found != formatVersion)
    throw Hdf5Error(fmt::format("a checkpoint of format {}, expected format {}", found, formatVersion));
  if (const auto found = readAttribute<std::int32_t>(file, "dimensions"); found != dimensions)
    throw Hdf5Error(fmt::format("{} dimensions, expected {}", found, dimensions));
}

MethodKind readMethod(hid_t file) {
  const std::string word = readText(file, "method");
  const auto method = valueNamed<MethodKind>(word);
  if (!method) throw Hdf5Error(fmt::format("its method is '{}', which is none of this version", word));
  return *method;
}

/// Errors: Hdf5Error for numbers that no simulation has.
template <int D>
void readNumbers(hid_t file, Checkpoint<D>& checkpoint) {
  checkpoint.step = readAttribute<std::int64_t>(file, "step");
  checkpoint.time = readAttribute<double>(file, "time");
  if (checkpoint.step < 0 || !(checkpoint.time >= 0) || !std::isfinite(checkpoint.time))
    throw Hdf5Error(fmt::format("after step {} at t = {} s, expected numbers not less than 0", checkpoint.step,
                                checkpoint.time));
  const std::uint64_t fluid = readAttribute<std::uint32_t>(file, "fluid_count"),
                      wall = readAttribute<std::uint32_t>(file, "wall_count");
  if (fluid + wall > maxParticles)
    throw Hdf5Error(fmt::format("{} particles, more than the limit of {}", fluid + wall, maxParticles));
  checkpoint.particles.fluidCount = static_cast<std::uint32_t>(fluid);
  checkpoint.particles.count = static_cast<std::uint32_t>(fluid + wall);
}

/// How many there are. Errors: Hdf5Error for more than a solver can have.
std::uint32_t readModeNumbers(hid_t file, ModeAge& age) {
  age = {readAttribute<std::int32_t>(file, "modes_due"),
         readAttribute<std::int32_t>(file, "modes_fewest_iterations")};
  const auto count = readAttribute<std::uint32_t>(file, "mode_count");
  if (count > maxModes) throw Hdf5Error(fmt::format("{} modes, more than the limit of {}", count, maxModes));
  return count;
}

/// Errors: Hdf5Error for what no solver keeps.
KeptEigenvalue readEigenvalue(hid_t file) {
  const KeptEigenvalue kept{readAttribute<double>(file, "pressure_eigenvalue"),
                            readAttribute<std::int32_t>(file, "pressure_eigenvalue_due"),
                            readAttribute<std::int32_t>(file, "pressure_eigenvalue_fewest_iterations")};
  if (!(kept.value >= 0) || !std::isfinite(kept.value) || kept.due > KeptEigenvalue::longest)
    throw Hdf5Error(fmt::format("an eigenvalue of {} for {} more solves", kept.value, kept.due));
  return kept;
}

/// Errors: Hdf5Error for what no run remembers.
StepMemory readSteps(hid_t file) {
  const StepMemory steps{readAttribute<double>(file, "time_step"),
                         readAttribute<double>(file, "planned_time_step"),
                         readAttribute<double>(file, "time_step_error_rate")};
  for (const double x : {steps.last, steps.planned, steps.rate})
    if (!(x >= 0) || !std::isfinite(x))
      throw Hdf5Error(fmt::format("time steps of {} and {} s with an error rate of {} 1/s", steps.last,
                                  steps.planned, steps.rate));
  return steps;
}

void requireReadable(const std::filesystem::path& path) {
  std::error_code error;
  static_cast<void>(std::filesystem::file_size(path, error));
  if (error) throw InputError(fmt::format("{}: {}", path.string(), error.message()));
  if (!std::ifstream(path)) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw InputError(fmt::format("{}: not a treacle checkpoint: not an HDF5 file", path.string()));
}

/// The walls of a part; it also looks at all ids, since a part does not see whether others have the same. Returns
/// the id of the first wall of all. Errors: Hdf5Error.
std::uint32_t chooseWalls(hid_t file, const OpenFlow& flow, Selection& selection) {
  const std::uint32_t fluid = selection.fluid, walls = selection.walls;
  const FieldInfo info{"id", Of::All, std::uint64_t{fluid} + walls};
  const FieldReader<std::uint32_t> reader(file, info);
  Buffer<std::uint32_t> ids(info.count);
  reader.read({0, info.count}, ids.data());
  const std::uint32_t firstOfAll = requireIds(ids, fluid, flow), first = firstOfAll + selection.part.begin(walls);
  selection.chosenWalls.resize(selection.part.size(walls));
  for (std::uint32_t k = 0; k < walls; ++k)
    if (const std::uint32_t place = ids[fluid + k] - first; place < selection.chosenWalls.size())
      selection.chosenWalls[place] = k;
  return firstOfAll;
}

/// Errors: Hdf5Error.
template <int D>
Checkpoint<D> readContent(const std::filesystem::path& path, ParticlePart part) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  requireFormat(file, D);
  Checkpoint<D> checkpoint;
  readNumbers(file, checkpoint);
  checkpoint.method = readMethod(file);
  checkpoint.names = {readNames(file, "material", maxMaterials), readNames(file, "body", maxBodies), {}};
  Particles<D>& particles = checkpoint.particles;
  const std::uint32_t modes = readModeNumbers(file, particles.modes.age);
  particles.modes.pressure = readEigenvalue(file);
  particles.steps = readSteps(file);
  particles.bulk = readBulk(file);
  const auto has = [&](const char* name) { return readAttribute<std::uint8_t>(file, name) != 0; };
  particles.has = {has("has_shear_rates"), has("has_temperatures"), has("has_viscosity_factors")};
  particles.has.sides = hasAttribute(file, "has_sides");
  if (hasAttribute(file, "elastic_modes")) {
    particles.has.elasticModes = readAttribute<std::uint8_t>(file, "elastic_modes");
    if (particles.has.elasticModes > maxElasticModes)
      throw Hdf5Error(fmt::format("{} elastic modes, more than {}", particles.has.elasticModes, maxElasticModes));
  }
  if (hasAttribute(file, "states")) {
    checkpoint.names.states = readNames(file, "state", maxStates);
    particles.has.states = readAttribute<std::uint8_t>(file, "states");
    if (particles.has.states > maxStates)
      throw Hdf5Error(fmt::format("{} states, more than {}", particles.has.states, maxStates));
  }
  particles.flow = readFlow(file), particles.rigid = readRigid(file), particles.gas = readGas(file);
  particles.response = readResponse(file);
  Selection selection{part, particles.fluidCount, particles.wallCount(), {}};
  checkpoint.fluidOfAll = selection.fluid, checkpoint.wallsOfAll = selection.walls;
  if (!part.isAll()) checkpoint.firstWall = chooseWalls(file, particles.flow, selection);
  forEachNamedField(particles, std::uint64_t{selection.fluid} * modes,
                    [&](const FieldInfo& info, auto& field) { readField(file, info, selection, field); });
  requireSound(particles);
  if (part.isAll()) checkpoint.firstWall = requireIds(particles.id, particles.fluidCount, particles.flow);
  particles.fluidCount = part.size(selection.fluid);
  particles.count = particles.fluidCount + part.size(selection.walls);
  return checkpoint;
}

}  // namespace

void prepareCheckpoints() {
  requireRoom(6 << 20);
  H5dont_atexit();  // all files are closed; after a lack of memory its end would be that of the program
  const Hdf5Silence silence;
  if (H5open() < 0) throw RunError("HDF5 cannot be started, which writes checkpoints");
}

StateNames StateNames::of(const Case& c) {
  StateNames names;
  for (const Material& m : c.materials) names.materials.push_back(m.name);
  for (const Body& b : c.bodies) names.bodies.push_back(b.name);
  names.states = c.stateNames();
  return names;
}

template <int D>
void writeCheckpoint(const std::filesystem::path& path, const Particles<D>& particles, std::int64_t step,
                     double time, MethodKind method, const StateNames& names) {
  const Hdf5Silence silence;
  try {
    requireSound(particles);  // what cannot be read back must not replace what can
    requireIds(particles.id, particles.fluidCount, particles.flow);
    // HDF5 makes the file in memory: it cannot close a file that a full disk keeps it from finishing.
    std::size_t bytes = 1 << 16;
    forEachNamedField(particles, [&](const FieldInfo&, const auto& field) { bytes += field.bytes(); });
    requireRoom(bytes + (8 << 20));
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    hdf5Checked(H5Pset_fapl_core(access, bytes, false));
    // It would read an existing file of this name first; below a file there is none.
    const auto name = path / "memory";
    const Hdf5Handle file(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    fill(file, particles, step, time, method, names);
    hdf5Checked(H5Fflush(file, H5F_SCOPE_LOCAL));
    const ssize_t size = hdf5Checked(H5Fget_file_image(file, nullptr, 0));
    void* image = nullptr;  // takes the address of the driver's pointer to its memory: the bytes without a copy
    hdf5Checked(H5Fget_vfd_handle(file, access, &image));
    const void* content = *static_cast<const void* const*>(image);
    const ChecksumRecord record = ChecksumRecord::of(content, static_cast<std::size_t>(size));
    AtomicFile target(path);
    target.write(content, static_cast<std::size_t>(size));
    target.write(&record, sizeof record);
    target.commit();
  } catch (const Hdf5Error& e) {
    throw RunError(fmt::format("cannot write {}: {}", path.string(), e.what()));
  }
}

template <int D>
Checkpoint<D> readCheckpoint(const std::filesystem::path& path, ParticlePart part) {
  const Hdf5Silence silence;
  requireReadable(path);
  // HDF5 trusts what it reads, and a damaged file can end the program: the checksum is looked at before.
  const std::optional<bool> holds = checksumHolds(path);
  const auto refuse = [&](std::string_view why) {
    return InputError(fmt::format("{}: no usable checkpoint: {}", path.string(), why));
  };
  if (!holds)
    throw refuse(
        fmt::format("its checksum is missing: it is cut off, another program has written it, or its format is "
                    "older than 4; expected format {}",
                    formatVersion));
  if (!*holds) throw refuse("damaged, its checksum is another one");
  try {
    return readContent<D>(path, part);
  } catch (const Hdf5Error& e) {
    throw refuse(e.what());
  }
}

template void writeCheckpoint<2>(const std::filesystem::path&, const Particles<2>&, std::int64_t, double,
                                 MethodKind, const StateNames&);
template void writeCheckpoint<3>(const std::filesystem::path&, const Particles<3>&, std::int64_t, double,
                                 MethodKind, const StateNames&);
template Checkpoint<2> readCheckpoint<2>(const std::filesystem::path&, ParticlePart);
template Checkpoint<3> readCheckpoint<3>(const std::filesystem::path&, ParticlePart);

}  // namespace treacle
