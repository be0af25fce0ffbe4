#include "treacle/core/halo.hpp"

namespace treacle {

void Halo::fill(const Communicator& communicator, Held held, void* field, std::size_t size) {
  auto* const values = static_cast<std::byte*>(field);
  const bool walls = held == Held::Active;
  std::size_t count = 0;
  for (const Neighbour& n : neighbours) count += n.sentFluid.size() + (walls ? n.sentWalls.size() : 0);
  packed_.resize(count * size);
  std::vector<Communicator::Message> sent, received;
  std::byte* next = packed_.data();
  const auto pack = [&](const std::vector<std::uint32_t>& indices, int rank) {
    std::byte* const begin = next;
    for (std::uint32_t i : indices) {
      std::memcpy(next, values + i * size, size);
      next += size;
    }
    sent.push_back({rank, begin, indices.size() * size});
  };
  std::size_t fluidAt = ownFluid, wallAt = std::size_t{fluid} + ownWalls;
  for (const Neighbour& n : neighbours) {
    pack(n.sentFluid, n.rank);
    received.push_back({n.rank, values + fluidAt * size, n.fluid * size});
    fluidAt += n.fluid;
    if (!walls) continue;
    pack(n.sentWalls, n.rank);
    received.push_back({n.rank, values + wallAt * size, n.walls * size});
    wallAt += n.walls;
  }
  communicator.exchange(sent, received);
}

}  // namespace treacle
