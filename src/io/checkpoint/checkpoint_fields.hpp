#pragma once

#include "hdf5_values.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/model/particles/particle_part.hpp"
#include "treacle/model/particles/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace treacle {

/// The fields of a checkpoint: which there are, how they are written, and how all of them or one process's part
/// are read. Errors, of all functions: Hdf5Error.

/// What a field has values for: all particles; the fluid; the fluid once for each mode.
enum class Of { All, Fluid, Modes };

/// A field as the file holds it.
struct FieldInfo {
  const char* name;
  Of of;
  std::uint64_t count;  // of its values
};

/// Calls f(info, field) for every field but the surfaces of the walls, which follow from the case; `modeValues`:
/// vectors that the modes have together. The binding names all members of Particles: it does not compile once one
/// is added that is not written here.
template <class P, class F>
void forEachNamedField(P& particles, std::uint64_t modeValues, F&& f) {
  auto& [fluidCount, ghostCount, count, position, velocity, pressure, numberDensity, heldPressure, material, body,
         id, start, side, acceleration, jerk, has, shearRate, temperature, viscosityFactor, states, conformation,
         modes, steps, bulk, flow, rigid, gas, response, wallSurface] = particles;
  static_cast<void>(steps), static_cast<void>(bulk), static_cast<void>(flow), static_cast<void>(rigid);
  static_cast<void>(gas), static_cast<void>(response);       // numbers, all of these
  static_cast<void>(wallSurface), static_cast<void>(start);  // there is none between steps
  f(FieldInfo{"position", Of::All, count}, position), f(FieldInfo{"velocity", Of::All, count}, velocity);
  f(FieldInfo{"pressure", Of::All, count}, pressure);
  f(FieldInfo{"number_density", Of::All, count}, numberDensity);
  f(FieldInfo{"held_pressure", Of::All, count}, heldPressure);
  f(FieldInfo{"material", Of::All, count}, material), f(FieldInfo{"body", Of::All, count}, body);
  f(FieldInfo{"id", Of::All, count}, id);
  f(FieldInfo{"side", Of::All, has.sides ? count : 0}, side);
  f(FieldInfo{"acceleration", Of::Fluid, fluidCount}, acceleration);
  f(FieldInfo{"jerk", Of::Fluid, fluidCount}, jerk);
  f(FieldInfo{"shear_rate", Of::Fluid, has.shearRates ? fluidCount : 0}, shearRate);
  f(FieldInfo{"temperature", Of::Fluid, has.temperatures ? fluidCount : 0}, temperature);
  f(FieldInfo{"viscosity_factor", Of::Fluid, has.viscosityFactors ? fluidCount : 0}, viscosityFactor);
  constexpr std::array<const char*, maxStates> stateFields{"state_0", "state_1", "state_2", "state_3"};
  for (std::size_t k = 0; k < has.states; ++k) f(FieldInfo{stateFields[k], Of::Fluid, fluidCount}, states[k]);
  constexpr std::array<const char*, maxElasticModes> modeFields{"conformation_0", "conformation_1",
                                                                "conformation_2", "conformation_3"};
  for (std::size_t k = 0; k < has.elasticModes; ++k)
    f(FieldInfo{modeFields[k], Of::Fluid, fluidCount}, conformation[k]);
  f(FieldInfo{"modes", Of::Modes, modeValues}, modes.vectors);
}

template <class P, class F>
void forEachNamedField(P& particles, F&& f) {
  forEachNamedField(particles, particles.modes.vectors.size(), f);
}

template <class T>
void writeField(hid_t file, const FieldInfo& info, const Buffer<T>& field) {
  const Layout layout = layoutOf(field.data());
  const Extents extents(info.count, layout);
  const Hdf5Handle space(H5Screate_simple(extents.rank, extents.size.data(), nullptr), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  // Without the date the same state gives the same file.
  hdf5Checked(H5Pset_obj_track_times(properties, false));
  const Hdf5Handle dataset(H5Dcreate2(file, info.name, layout.file, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                           H5Dclose);
  hdf5Checked(H5Dwrite(dataset, layout.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.data()));
}

/// Rows that follow each other in the file.
struct RowRange {
  std::uint64_t begin, count;
};

/// What is read of a file.
struct Selection {
  ParticlePart part;
  std::uint32_t fluid = 0, walls = 0;      // particles in the file
  std::vector<std::uint32_t> chosenWalls;  // of a part, from the first wall on, in the order of their ids

  /// The rows of the fluid that a field has; none of a field that is empty.
  std::vector<RowRange> fluidRows(const FieldInfo& info) const {
    if (info.count == 0) return {};
    const std::uint64_t begin = part.begin(fluid), size = part.size(fluid);
    if (info.of != Of::Modes) return {{begin, size}};
    std::vector<RowRange> rows;
    for (std::uint64_t row = 0; row < info.count; row += fluid) rows.push_back({row + begin, size});
    return rows;
  }
  std::uint64_t count(const FieldInfo& info) const {
    if (info.count == 0) return 0;
    const std::uint64_t times = info.of == Of::Modes && fluid > 0 ? info.count / fluid : 1;
    return times * part.size(fluid) + (info.of == Of::All ? part.size(walls) : 0);
  }
};

/// A field of the file, which is known to hold its values. Errors: Hdf5Error.
template <class T>
class FieldReader {
 public:
  FieldReader(hid_t file, const FieldInfo& info)
      : layout_(layoutOf(static_cast<const T*>(nullptr))),
        dataset_(H5Dopen2(file, info.name, H5P_DEFAULT), H5Dclose),
        space_(H5Dget_space(dataset_), H5Sclose) {
    const Extents expected(info.count, layout_);
    const Hdf5Handle type(H5Dget_type(dataset_), H5Tclose);
    Extents found = expected;
    if (H5Sget_simple_extent_ndims(space_) != expected.rank ||
        H5Sget_simple_extent_dims(space_, found.size.data(), nullptr) < 0 ||
        !std::equal(found.size.begin(), found.size.begin() + expected.rank, expected.size.begin()))
      throw Hdf5Error(fmt::format("the field {} does not have {} values", info.name, info.count));
    if (H5Tget_class(type) != H5Tget_class(layout_.memory))
      throw Hdf5Error(fmt::format("the field {} has an unexpected type", info.name));
    if (H5Dget_storage_size(dataset_) < info.count * layout_.components * H5Tget_size(type))
      throw Hdf5Error(fmt::format("the file ends before the {} values of the field {} do", info.count, info.name));
  }

  void read(const RowRange& rows, T* to) const {
    if (rows.count == 0) return;
    const Extents some(rows.count, layout_);
    const std::array<hsize_t, 2> start{rows.begin, 0};
    const Hdf5Handle memory(H5Screate_simple(some.rank, some.size.data(), nullptr), H5Sclose);
    hdf5Checked(H5Sselect_hyperslab(space_, H5S_SELECT_SET, start.data(), nullptr, some.size.data(), nullptr));
    hdf5Checked(H5Dread(dataset_, layout_.memory, memory, space_, H5P_DEFAULT, to));
  }

 private:
  Layout layout_;
  Hdf5Handle dataset_, space_;
};

/// What is selected of a field. Nothing is allocated before the file is known to hold as much.
template <class T>
void readField(hid_t file, const FieldInfo& info, const Selection& selection, Buffer<T>& field) {
  const FieldReader<T> reader(file, info);
  field.resize(selection.count(info));
  T* to = field.data();
  for (const RowRange& rows : selection.fluidRows(info)) reader.read(rows, std::exchange(to, to + rows.count));
  if (info.of != Of::All || info.count == 0) return;
  const RowRange walls{selection.fluid, selection.walls};
  if (selection.part.isAll()) return reader.read(walls, to);
  Buffer<T> all(selection.walls);  // of one field they may stand anywhere
  reader.read(walls, all.data());
  for (const std::uint32_t k : selection.chosenWalls) *to++ = all[k];
}

}  // namespace treacle
