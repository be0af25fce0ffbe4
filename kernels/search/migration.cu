#include "search/migration.cuh"

#include "core/device_link.hpp"
#include "search/cell_sort.cuh"
#include "treacle/core/communicator.hpp"
#include "treacle/search/fluid_fields.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace treacle {
namespace {

using Message = Communicator::Message;

/// Of all fields of so many fluid particles, one after the other.
template <int D>
std::size_t packedBytes(Particles<D, Cuda>& p, std::size_t count) {
  std::size_t sum = 0;
  forEachFieldOfFluid(p, [&]<class T>(const T*) { sum += padded(count * sizeof(T)); });
  return sum;
}

/// One message for each of the others that there is something for, or from.
void addMessages(std::vector<Message>& messages, std::byte* data, std::span<const std::uint32_t> counts,
                 std::size_t size) {
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (counts[r] > 0) messages.push_back({static_cast<int>(r), data, counts[r] * size});
    data += counts[r] * size;
  }
}

/// Room for the largest field, and for so many numbers of modes.
template <int D>
std::byte* fieldRoom(Context<Cuda>& context, Buffer<std::byte, Cuda>& room, std::size_t largest,
                     std::size_t modeValues) {
  room.resize(context, std::max(largest, modeValues * sizeof(Vec<D, float>)));
  return room.data();
}

}  // namespace

template <int D>
void joinFluid(Context<Cuda>& context, Particles<D, Cuda>& p, const std::uint32_t* index, std::uint32_t kept,
               const std::byte* arrived, std::uint32_t come, Buffer<std::byte, Cuda>& room) {
  const std::uint32_t before = p.fluidCount, fluid = kept + come, walls = p.wallCount(), wallBegin = p.wallBegin();
  const std::uint32_t modes = p.modeCount();
  std::byte* one =
      fieldRoom<D>(context, room, p.largestField(std::size_t{fluid} + walls, fluid), std::size_t{modes} * fluid);
  const auto join = [&]<class T>(const T* field, T* joint) {
    gather(context, field, index, kept, joint);
    copyBytesOnDevice(context, arrived, joint + kept, come * sizeof(T));
    arrived += padded(come * sizeof(T));
  };
  const auto replace = [&]<class T>(Buffer<T, Cuda>& field, std::size_t count) {
    field.resize(context, count);
    copyBytesOnDevice(context, one, field.data(), count * sizeof(T));
  };
  forEachSharedFieldOf(
      [&]<class T>(Buffer<T, Cuda>& field) {
        T* joint = reinterpret_cast<T*>(one);
        join(field.data(), joint);
        copyBytesOnDevice(context, field.data() + wallBegin, joint + fluid, walls * sizeof(T));
        replace(field, std::size_t{fluid} + walls);
      },
      p);
  forEachFluidFieldOf(
      [&]<class T>(Buffer<T, Cuda>& field) {
        join(field.data(), reinterpret_cast<T*>(one));
        replace(field, fluid);
      },
      p);
  auto* mode = reinterpret_cast<Vec<D, float>*>(one);
  for (std::size_t m = 0; m < modes; ++m) join(p.modes.vectors.data() + m * before, mode + m * fluid);
  replace(p.modes.vectors, std::size_t{modes} * fluid);
  p.fluidCount = fluid;
  p.ghostCount = 0;
  p.count = fluid + walls;
}

template <int D>
void exchangeFluid(Context<Cuda>& context, Particles<D, Cuda>& p, SortWorkspace<Cuda>& w,
                   std::span<const std::uint32_t> begins, std::span<const std::uint32_t> arriving) {
  const std::size_t size = arriving.size(), rank = context.communicator->rank();
  const std::uint32_t* index = w.sortedIndex.data();
  const std::uint32_t keptBegin = begins[rank], keptEnd = begins[rank + 1], kept = keptEnd - keptBegin;
  const std::uint32_t after = begins[size] - keptEnd;  // of ranks behind this one
  std::vector<std::uint32_t> leaving(size);
  for (std::size_t r = 0; r < size; ++r)
    if (r != rank) leaving[r] = begins[r + 1] - begins[r];
  const auto sumOf = [](std::span<const std::uint32_t> counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint32_t{0});
  };
  const std::uint32_t left = sumOf(leaving), come = sumOf(arriving);

  Buffer<std::byte, Cuda> out(context, packedBytes(p, left)), in(context, packedBytes(p, come));
  std::vector<Message> sent, received;
  std::byte *to = out.data(), *from = in.data();
  forEachFieldOfFluid(p, [&]<class T>(const T* field) {
    if (left > 0) {
      T* packed = reinterpret_cast<T*>(to);
      gather(context, field, index, keptBegin, packed);
      gather(context, field, index + keptEnd, after, packed + keptBegin);
    }
    addMessages(sent, to, leaving, sizeof(T));
    addMessages(received, from, arriving, sizeof(T));
    to += padded(left * sizeof(T));
    from += padded(come * sizeof(T));
  });
  context.link->exchange(sent, received);

  joinFluid(context, p, index + keptBegin, kept, in.data(), come, w.field);
}

template <int D>
void arrange(Context<Cuda>& context, Particles<D, Cuda>& p, SortWorkspace<Cuda>& w, std::uint32_t ghosts) {
  const std::uint32_t fluid = p.fluidCount, walls = p.wallCount(), wallBegin = fluid + ghosts;
  const std::uint32_t* index = w.sortedIndex.data();
  const std::size_t count = std::size_t{wallBegin} + walls;
  std::byte* room = fieldRoom<D>(context, w.field, p.largestField(count, fluid), p.modes.vectors.size());
  permuteModes(context, w, p);
  forEachSharedFieldOf(
      [&]<class T>(Buffer<T, Cuda>& field) {
        T* sorted = reinterpret_cast<T*>(room);
        gather(context, field.data(), index, fluid, sorted);
        gather(context, field.data(), index + fluid, walls, sorted + fluid);
        field.resize(context, count);
        copyBytesOnDevice(context, sorted, field.data(), fluid * sizeof(T));
        copyBytesOnDevice(context, sorted + fluid, field.data() + wallBegin, walls * sizeof(T));
      },
      p);
  forEachFluidFieldOf([&](auto& field) { permute(context, w, index, field); }, p);
  const std::uint32_t before = p.wallBegin();
  forEachWallFieldOf([&](auto& field) { permute(context, w, index + fluid, field, before); }, p);
  p.ghostCount = ghosts;
  p.count = static_cast<std::uint32_t>(count);
}

#define TREACLE_INSTANTIATE(D)                                                                      \
  template void exchangeFluid(Context<Cuda>&, Particles<D, Cuda>&, SortWorkspace<Cuda>&,            \
                              std::span<const std::uint32_t>, std::span<const std::uint32_t>);      \
  template void joinFluid(Context<Cuda>&, Particles<D, Cuda>&, const std::uint32_t*, std::uint32_t, \
                          const std::byte*, std::uint32_t, Buffer<std::byte, Cuda>&);               \
  template void arrange(Context<Cuda>&, Particles<D, Cuda>&, SortWorkspace<Cuda>&, std::uint32_t);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
