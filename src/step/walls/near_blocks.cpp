#include "treacle/step/walls/near_blocks.hpp"

#include "run/selected.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/search/cell_sort.hpp"

#include <atomic>
#include <utility>

namespace treacle {

template <int D>
NearBlocks<D>::NearBlocks(const Case& c, const CellGrid<D>& cells) : cells_(cells), blocks_(cells) {
  for (int k = 0; k < D; ++k) blocks_.count[k] = std::max(1, cells.count[k] / cellsOfBlock);
  // Gas is bounded by walls wherever they are, and walls have sides that nothing else remembers.
  near_.resize(blocks_.cellCount(), c.gas || c.hasThinSheets() ? 1 : 0);
  for (const Body& body : c.bodies)
    bodyRests_.push_back(body.kind == BodyKind::Wall && body.velocity == Vec<3>{} &&
                         body.oscillation.period == 0 && !isDriven(body.displacement) && !body.rotation);
}

template <int D>
void NearBlocks<D>::addMoving(std::span<const Vec<D>> position) {
  constexpr std::size_t piece = 4096;
  parallelFor((position.size() + piece - 1) / piece, 2, [&](std::size_t p) {
    std::size_t last = near_.size();  // particles that follow each other are in the same block, most of them
    for (const Vec<D>& x : position.subspan(p * piece, std::min(piece, position.size() - p * piece))) {
      if (!isFinitePosition(x)) continue;  // the sort says so
      const Vec<D, int> at = blockAt(x);
      const std::size_t block = blocks_.linear(at);
      if (std::exchange(last, block) == block) continue;
      forEachAdjacentCell(blocks_, at, [&](const Vec<D, int>& touching) {
        std::atomic_ref(near_[blocks_.linear(touching)]).store(1, std::memory_order_relaxed);
      });
    }
  });
}

template <int D>
void NearBlocks<D>::addMovingWalls(const Particles<D>& particles) {
  for (const std::uint32_t i : movingWalls(particles)) addMoving({&particles.position[i], 1});
}

template <int D>
void NearBlocks<D>::add(const Particles<D>& particles) {
  addMoving(particles.position.span().first(particles.fluidCount));
  addMovingWalls(particles);
}

template <int D>
bool NearBlocks<D>::rests(const Particles<D>& particles, std::uint32_t i) const {
  const std::size_t body = particles.body[i];
  if (!(particles.velocity[i] == Vec<D>{}) || (body < bodyRests_.size() && !bodyRests_[body])) return false;
  Vec<D> x = particles.position[i];
  return cells_.wrap(x) && x == particles.position[i];
}

template <int D>
Buffer<std::uint32_t> NearBlocks<D>::movingWalls(const Particles<D>& particles) const {
  return selected(particles.fluidCount, particles.count, [&](std::uint32_t i) { return !rests(particles, i); });
}

/// Between something that moves and a wall that is not near there are two cells or more. Before their cells touch
/// it has crossed one of them.
template <int D>
double NearBlocks<D>::margin() const {
  return 0.99 * *std::min_element(cells_.edge.v, cells_.edge.v + D);
}

template <int D>
Particles<D> nearParticles(const NearBlocks<D>& near, const Particles<D>& all) {
  const std::uint32_t n = all.fluidCount;
  const Buffer<std::uint32_t> walls = selected(n, all.count, [&](std::uint32_t i) { return !near.isFar(all, i); });
  Particles<D> some;
  ParticleNumbers numbers = all.numbers();
  numbers.wall = walls.size(), numbers.ghosts = 0;
  if (numbers.surfaces > 0) numbers.surfaces = walls.size();
  some.resize(numbers);
  some.copyNumbers(all);
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); };
  forEachFluidFieldOf(copy, all, some);
  copy(all.modes.vectors, some.modes.vectors);
  forEachSharedFieldOf(
      [&](const auto& from, auto& to) {
        std::copy_n(from.begin(), n, to.begin());
        gather(from.span(), walls, to.data() + n);
      },
      all, some);
  if (!all.wallSurface.empty()) gather(all.wallSurface.span(), walls, some.wallSurface.data(), n);
  return some;
}

template class NearBlocks<2>;
template class NearBlocks<3>;
template Particles<2> nearParticles<2>(const NearBlocks<2>&, const Particles<2>&);
template Particles<3> nearParticles<3>(const NearBlocks<3>&, const Particles<3>&);

}  // namespace treacle
