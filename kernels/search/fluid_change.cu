#include "treacle/search/fluid_change.hpp"

#include "core/device_link.hpp"
#include "core/list_where.cuh"
#include "search/migration.cuh"
#include "treacle/core/copy_values.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace treacle {
namespace {

/// The fluid particles that stay, ascending; their number.
std::uint32_t listKept(Context<Cuda>& context, std::span<const std::uint8_t> gone, std::uint32_t count,
                       Buffer<std::uint32_t, Cuda>& kept) {
  kept.resize(context, count);
  return listWhere(
      context, 0, count, [gone] __device__(std::uint32_t i) { return gone.empty() || gone[i] == 0; }, kept.data());
}

/// For so much fluid, before anything has changed: where memory gives out all particles are still there.
template <int D>
void makeRoom(Context<Cuda>& context, Particles<D, Cuda>& p, std::uint32_t fluid, Buffer<std::byte, Cuda>& room) {
  const std::size_t count = std::size_t{fluid} + p.wallCount(), modes = p.modeCount();
  room.resize(context, std::max(p.largestField(count, fluid), modes * fluid * sizeof(Vec<D, float>)));
  const auto grow = [&]<class T>(Buffer<T, Cuda>& field, std::size_t size) {
    const std::size_t capacity = field.bytes() / sizeof(T);
    if (size <= capacity) return;
    Buffer<T, Cuda> larger(context, grownCapacity(capacity, size));
    larger.resize(context, field.size());
    copyValues(context, std::span<const T>(field), larger.data());
    field = std::move(larger);
  };
  forEachSharedFieldOf([&](auto& field) { grow(field, count); }, p);
  forEachFluidFieldOf([&](auto& field) { grow(field, fluid); }, p);
  grow(p.modes.vectors, modes * fluid);
}

/// As joinFluid takes them.
template <int D>
std::vector<std::byte> packed(const Particles<D>& added, std::uint32_t modes) {
  std::vector<std::byte> bytes;
  const auto pack = [&]<class T>(const Buffer<T>& field) {
    const std::size_t at = bytes.size();
    bytes.resize(at + padded(added.fluidCount * sizeof(T)));
    std::memcpy(bytes.data() + at, field.data(), added.fluidCount * sizeof(T));
  };
  forEachSharedFieldOf(pack, added);
  forEachFluidFieldOf(pack, added);
  bytes.resize(bytes.size() + modes * padded(added.fluidCount * sizeof(Vec<D, float>)));
  return bytes;
}

}  // namespace

template <int D, class Backend>
void changeFluid(Context<Backend>& context, std::span<const std::uint8_t> gone, const Particles<D>& added,
                 Particles<D, Backend>& particles) {
  Buffer<std::uint32_t, Cuda> kept;
  const std::uint32_t count = listKept(context, gone, particles.fluidCount, kept);
  Buffer<std::byte, Cuda> arrived, room;
  if (added.fluidCount > 0) {
    const std::vector<std::byte> bytes = packed(added, particles.modeCount());
    arrived.resize(context, bytes.size());
    copyBytesToDevice(context, bytes.data(), arrived.data(), bytes.size());
  }
  makeRoom(context, particles, count + added.fluidCount, room);
  joinFluid(context, particles, kept.data(), count, arrived.data(), added.fluidCount, room);
}

template void changeFluid(Context<Cuda>&, std::span<const std::uint8_t>, const Particles<2>&, Particles<2, Cuda>&);
template void changeFluid(Context<Cuda>&, std::span<const std::uint8_t>, const Particles<3>&, Particles<3, Cuda>&);

}  // namespace treacle
