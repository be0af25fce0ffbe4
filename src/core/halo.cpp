#include "treacle/core/halo.hpp"

#include <cstring>

namespace treacle {
namespace {

/// Copies of `size` bytes each, which a compiler makes moves of where it knows how many.
template <std::size_t... Known>
std::byte* pack(const std::byte* values, const std::vector<std::uint32_t>& indices, std::size_t size,
                std::byte* to) {
  const auto copy = [&](auto bytes) {
    for (std::uint32_t i : indices) {
      std::memcpy(to, values + i * std::size_t{bytes}, bytes);
      to += bytes;
    }
  };
  if (!((size == Known && (copy(std::integral_constant<std::size_t, Known>{}), true)) || ...)) copy(size);
  return to;
}

}  // namespace

void Halo::fill(const Communicator& communicator, Held held, void* field, std::size_t size) {
  auto* const values = static_cast<std::byte*>(field);
  const bool walls = held == Held::Active;
  std::size_t count = 0;
  for (const Neighbour& n : neighbours) count += n.sentFluid.size() + (walls ? n.sentWalls.size() : 0);
  packed_.resize(count * size);
  std::vector<Communicator::Message> sent, received;
  std::byte* next = packed_.data();
  const auto send = [&](const std::vector<std::uint32_t>& indices, int rank) {
    sent.push_back({rank, next, indices.size() * size});
    next = pack<4, 8, 12, 16, 24>(values, indices, size, next);
  };
  std::size_t fluidAt = ownFluid, wallAt = std::size_t{fluid} + ownWalls;
  for (const Neighbour& n : neighbours) {
    send(n.sentFluid, n.rank);
    received.push_back({n.rank, values + fluidAt * size, n.fluid * size});
    fluidAt += n.fluid;
    if (!walls) continue;
    send(n.sentWalls, n.rank);
    received.push_back({n.rank, values + wallAt * size, n.walls * size});
    wallAt += n.walls;
  }
  communicator.exchange(sent, received);
}

}  // namespace treacle
