#pragma once

#include "support/device_particles.hpp"
#include "support/device_scene.hpp"
#include "support/isph_scene.hpp"
#include "support/matrices.hpp"

namespace treacle::test {

inline NeighbourRows<Cuda> onDevice(const Context<Cuda>& context, const NeighbourRows<>& rows) {
  NeighbourRows<Cuda> copy;
  copy.first = rows.first;
  copy.count = rows.count;
  copyToDevice<std::uint64_t>(context, rows.start, copy.start);
  copyToDevice<std::uint32_t>(context, rows.column, copy.column);
  return copy;
}

/// A scene of ISPH as the CPU prepared it, in device memory.
template <int D>
struct DeviceIsph {
  Context<Cuda> context;
  Particles<D, Cuda> particles;
  CellRanges<Cuda> ranges;
  NeighbourRows<Cuda> fluidOfFluid, wallsOfFluid, fluidOfWalls;
  Buffer<double, Cuda> density;
  Buffer<std::uint8_t, Cuda> surface;
  Buffer<SymmetricBlock<D, float>, Cuda> renormalisation, acrossWalls;
  Buffer<float, Cuda> missing;
  IsphPairs<D> pairs;  // looks at the members above

  explicit DeviceIsph(const IsphScene<D>& s) : pairs(s.pairs) {
    particles = onDevice(context, s.particles);
    ranges = onDevice(context, s.ranges);
    fluidOfFluid = onDevice(context, s.fluidOfFluid);
    wallsOfFluid = onDevice(context, s.wallsOfFluid);
    fluidOfWalls = onDevice(context, s.fluidOfWalls);
    copyToDevice<double>(context, s.density, density);
    copyToDevice<std::uint8_t>(context, s.surface, surface);
    copyToDevice<SymmetricBlock<D, float>>(context, s.renormalisation, renormalisation);
    copyToDevice<float>(context, s.missing, missing);
    pairs.renormalisation = pairs.acrossWalls = renormalisation.data();
    if (pairs.wallSurface) {
      copyToDevice<SymmetricBlock<D, float>>(context, s.acrossWalls, acrossWalls);
      pairs.acrossWalls = acrossWalls.data();
      pairs.wallSurface = particles.wallSurface.data();
    }
    pairs.missing = missing.data();
    pairs.position = particles.position;
    pairs.material = particles.material;
    pairs.body = particles.body.data();
    pairs.cells = viewOf(ranges);
    pairs.fluidOfFluid = fluidOfFluid.view();
    pairs.wallsOfFluid = wallsOfFluid.view();
    pairs.fluidOfWalls = fluidOfWalls.view();
  }
  DeviceIsph(const DeviceIsph&) = delete;
};

/// IsphTestSystem in device memory, packed or not, made there.
template <int D, class T>
struct DeviceIsphTestSystem {
  Buffer<T, Cuda> coefficient, inverseNear;
  PackedEntries<Cuda> entries;
  Buffer<double, Cuda> diagonal;
  Buffer<IsphMoments<D>, Cuda> moments;
  IsphMatrix<T> a;

  template <class Row>
  DeviceIsphTestSystem(DeviceIsph<D>& d, const Row& row, bool packed) {
    const std::uint32_t n = d.pairs.fluidCount;
    coefficient.resize(d.context, packed ? 0 : d.pairs.fluidEntries);
    if (packed) preparePacked(d.context, d.pairs, entries);
    inverseNear.resize(d.context, n);
    diagonal.resize(d.context, n);
    moments.resize(d.context, n);
    IsphMatrixParts<D, T> parts{};
    parts.coefficient = coefficient;
    if (packed) parts.packed = entries.view();
    parts.unit = row.largest(d.pairs) / 255;
    parts.diagonal = diagonal;
    parts.inverseNear = inverseNear;
    parts.moments = moments;
    fillIsphMatrix(d.context, d.pairs, row, parts);
    a.rows = n;
    a.start = d.pairs.fluidOfFluid.start;
    a.column = d.pairs.fluidOfFluid.column;
    a.coefficient = coefficient.data();
    a.packed = parts.packed;
    a.unit = parts.unit;
    a.diagonal = diagonal.data();
    a.inverseNear = inverseNear.data();
  }
  DeviceIsphTestSystem(const DeviceIsphTestSystem&) = delete;
};

/// |x - y| / |y| of a result in device memory.
template <class V>
double differ(const Context<Cuda>& context, const Buffer<V, Cuda>& found, std::span<const V> expected) {
  const Buffer<V> x = copyToHost(context, found);
  using T = std::conditional_t<std::is_same_v<V, float>, float, double>;
  if (x.size() != expected.size()) return std::numeric_limits<double>::infinity();
  return relativeDifference<T>(x.span(), expected);
}

}  // namespace treacle::test
