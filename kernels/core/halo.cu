#include "treacle/core/halo.hpp"

#include "core/launch.hpp"
#include "treacle/core/device_link.hpp"

namespace treacle {
namespace {

/// One thread per word of a packed value; reads an index and the word, writes it; atomics no. `words`: of a value.
template <class Word>
void pack(const Context<Cuda>& context, const void* field, std::span<const std::uint32_t> indices,
          std::size_t words, std::byte* to) {
  forEach(context, indices.size() * words,
          [from = static_cast<const Word*>(field), index = indices.data(), words,
           to = reinterpret_cast<Word*>(to)] __device__(std::size_t k) {
            to[k] = from[index[k / words] * words + k % words];
          });
}

void packBytes(const Context<Cuda>& context, const void* field, std::span<const std::uint32_t> indices,
               std::size_t size, std::byte* to) {
  const auto isAligned = [&](std::size_t bytes) {
    return size % bytes == 0 && reinterpret_cast<std::uintptr_t>(to) % bytes == 0 &&
           reinterpret_cast<std::uintptr_t>(field) % bytes == 0;
  };
  if (isAligned(16)) return pack<uint4>(context, field, indices, size / 16, to);
  if (isAligned(8)) return pack<uint2>(context, field, indices, size / 8, to);
  if (isAligned(4)) return pack<unsigned>(context, field, indices, size / 4, to);
  pack<std::uint8_t>(context, field, indices, size, to);
}

}  // namespace

/// Whether the link takes values from where they stand.
template <>
bool Halo<Cuda>::exchangeGathered(const Context<Cuda>& context, Held held, void* field, std::size_t size) {
  std::vector<DeviceLink::Gathered> sent;
  const std::uint32_t *fluid = sentFluid.data(), *walls = sentWalls.data();
  for (const Neighbour& n : neighbours) {
    sent.push_back({n.rank, fluid, n.sentFluid});
    fluid += n.sentFluid;
    if (held == Held::Fluid) continue;
    sent.push_back({n.rank, walls, n.sentWalls});
    walls += n.sentWalls;
  }
  return context.link->exchangeGathered(field, size, sent, messages(held, field, size).received);
}

template <>
void Halo<Cuda>::fill(const Context<Cuda>& context, Held held, void* field, std::size_t size) {
  if (exchangeGathered(context, held, field, size)) return;
  packed_.resize(context, sentCount(held) * size);
  packBytes(context, field, sentFluid, size, packed_.data());
  if (held == Held::Active) packBytes(context, field, sentWalls, size, packed_.data() + sentFluid.size() * size);
  const Messages m = messages(held, field, size);
  context.link->exchange(m.sent, m.received);
}

template <>
void Halo<Cuda>::returnGhosts(const Context<Cuda>& context, const void* ghosts, std::size_t size, void* arrived) {
  Messages m;
  messagesBack(ghosts, size, arrived, m);
  context.link->exchange(m.sent, m.received);
}

/// One neighbour after the other, because several may have a ghost of the same value. One thread per number; no
/// atomics.
template <>
template <class T>
void Halo<Cuda>::addGhosts(const Context<Cuda>& context, T* field, std::size_t numbers) {
  packed_.resize(context, sentFluid.size() * numbers * sizeof(T));
  returnGhosts(context, field + ownFluid * numbers, numbers * sizeof(T), packed_.data());
  const std::uint32_t* index = sentFluid.data();
  const T* value = reinterpret_cast<const T*>(packed_.data());
  for (const Neighbour& n : neighbours) {
    forEach(context, n.sentFluid * numbers, [field, index, value, numbers] __device__(std::size_t k) {
      field[index[k / numbers] * numbers + k % numbers] += value[k];
    });
    index += n.sentFluid;
    value += n.sentFluid * numbers;
  }
}
template void Halo<Cuda>::addGhosts(const Context<Cuda>&, double*, std::size_t);
template void Halo<Cuda>::addGhosts(const Context<Cuda>&, float*, std::size_t);

}  // namespace treacle
