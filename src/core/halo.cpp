#include "treacle/core/halo.hpp"

#include <cstring>

namespace treacle {
namespace {

/// Copies of `size` bytes each, which a compiler makes moves of where it knows how many.
template <std::size_t... Known>
void pack(const std::byte* values, std::span<const std::uint32_t> indices, std::size_t size, std::byte* to) {
  const auto copy = [&](auto bytes) {
    for (std::uint32_t i : indices) {
      std::memcpy(to, values + i * std::size_t{bytes}, bytes);
      to += bytes;
    }
  };
  if (!((size == Known && (copy(std::integral_constant<std::size_t, Known>{}), true)) || ...)) copy(size);
}

}  // namespace

/// The packed fluid of all neighbours stands before the packed walls of all.
template <class Backend>
typename Halo<Backend>::Messages Halo<Backend>::messages(Held held, void* field, std::size_t size) {
  Messages m;
  auto* const values = static_cast<std::byte*>(field);
  std::byte *fluidFrom = packed_.data(), *wallsFrom = fluidFrom + sentFluid.size() * size;
  std::byte *fluidTo = values + ownFluid * size, *wallsTo = values + (std::size_t{fluid} + ownWalls) * size;
  const auto add = [&](std::vector<Communicator::Message>& to, int rank, std::byte*& at, std::uint32_t count) {
    to.push_back({rank, at, count * size});
    at += count * size;
  };
  for (const Neighbour& n : neighbours) {
    add(m.sent, n.rank, fluidFrom, n.sentFluid);
    add(m.received, n.rank, fluidTo, n.fluid);
    if (held == Held::Fluid) continue;
    add(m.sent, n.rank, wallsFrom, n.sentWalls);
    add(m.received, n.rank, wallsTo, n.walls);
  }
  return m;
}

template <>
void Halo<Cpu>::fill(const Context<Cpu>& context, Held held, void* field, std::size_t size) {
  packed_.resize(sentCount(held) * size);
  const auto packAll = [&](std::span<const std::uint32_t> indices, std::byte* to) {
    pack<4, 8, 12, 16, 24>(static_cast<const std::byte*>(field), indices, size, to);
  };
  packAll(sentFluid, packed_.data());
  if (held == Held::Active) packAll(sentWalls, packed_.data() + sentFluid.size() * size);
  const Messages m = messages(held, field, size);
  context.communicator->exchange(m.sent, m.received);
}

template <class Backend>
void Halo<Backend>::messagesBack(const void* ghosts, std::size_t size, void* arrived, Messages& m) const {
  auto* from = static_cast<std::byte*>(const_cast<void*>(ghosts));
  auto* to = static_cast<std::byte*>(arrived);
  for (const Neighbour& n : neighbours) {
    m.sent.push_back({n.rank, from, n.fluid * size});
    m.received.push_back({n.rank, to, n.sentFluid * size});
    from += n.fluid * size, to += n.sentFluid * size;
  }
}

template <>
void Halo<Cpu>::returnGhosts(const Context<Cpu>& context, const void* ghosts, std::size_t size, void* arrived) {
  Messages m;
  messagesBack(ghosts, size, arrived, m);
  context.communicator->exchange(m.sent, m.received);
}

template <>
template <class T>
void Halo<Cpu>::addGhosts(const Context<Cpu>& context, T* field, std::size_t numbers) {
  packed_.resize(sentFluid.size() * numbers * sizeof(T));
  returnGhosts(context, field + ownFluid * numbers, numbers * sizeof(T), packed_.data());
  const T* value = reinterpret_cast<const T*>(packed_.data());
  for (std::uint32_t i : sentFluid)
    for (std::size_t c = 0; c < numbers; ++c) field[i * numbers + c] += *value++;
}
template void Halo<Cpu>::addGhosts(const Context<Cpu>&, double*, std::size_t);
template void Halo<Cpu>::addGhosts(const Context<Cpu>&, float*, std::size_t);

template class Halo<Cpu>;
#ifdef TREACLE_HAS_CUDA
template Halo<Cuda>::Messages Halo<Cuda>::messages(Held, void*, std::size_t);
template void Halo<Cuda>::messagesBack(const void*, std::size_t, void*, Messages&) const;
#endif

}  // namespace treacle
