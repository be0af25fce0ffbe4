#include "treacle/step/walls/near_blocks.hpp"

#include "run/selected.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/search/cell_sort.hpp"

#include <atomic>

namespace treacle {

template <int D>
NearBlocks<D>::NearBlocks(const Case& c, const CellGrid<D>& cells) : cells_(cells), blocks_(cells) {
  for (int k = 0; k < D; ++k) blocks_.count[k] = std::max(1, cells.count[k] / cellsOfBlock);
  // Gas is bounded by walls wherever they are, and walls have sides that nothing else remembers.
  steps_.resize(blocks_.cellCount(), c.gas || c.hasThinSheets() ? blocksBetween + 1 : 0);
  for (const Body& body : c.bodies)
    bodyRests_.push_back(body.kind == BodyKind::Wall && body.velocity == Vec<3>{} &&
                         body.oscillation.period == 0 && !isDriven(body.displacement) && !body.rotation);
}

/// Threads may store fewer steps over more of another one, which has gone on with its own then: what is near is
/// the same.
template <int D>
void NearBlocks<D>::spread(const Vec<D, int>& block, std::uint8_t steps) {
  const std::atomic_ref known(steps_[blocks_.linear(block)]);
  if (known.load(std::memory_order_relaxed) >= steps) return;
  known.store(steps, std::memory_order_relaxed);
  if (steps > 1)
    forEachAdjacentCell(blocks_, block, [&](const Vec<D, int>& touching) { spread(touching, steps - 1); });
}

template <int D>
void NearBlocks<D>::addMoving(std::span<const Vec<D>> position) {
  parallelFor(position.size(), parallelGrain, [&](std::size_t i) {
    if (isFinitePosition(position[i]))
      spread(blockAt(position[i]), blocksBetween + 1);  // of others the sort says so
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

/// The cells of these blocks lie between something that moves and a wall that is not near. Before their cells
/// touch it has crossed all of them but one.
template <int D>
double NearBlocks<D>::margin() const {
  return 0.99 * (blocksBetween * cellsOfBlock - 1) * *std::min_element(cells_.edge.v, cells_.edge.v + D);
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
