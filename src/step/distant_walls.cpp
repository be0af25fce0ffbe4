#include "treacle/step/distant_walls.hpp"

#include "selected.hpp"
#include "treacle/model/wall_motion.hpp"

#include <numbers>

namespace treacle {
namespace {

/// The largest speed of a wall's centre at any time [m/s].
double largestSpeed(const Body& body) {
  const Oscillation& o = body.oscillation;
  return norm(body.velocity) + (o.period > 0 ? 2 * std::numbers::pi * norm(o.amplitude) / o.period : 0);
}

/// A speed that none of these wall particles exceeds, whenever it is [m/s]; `time`: of the state [s].
template <int D>
double largestSpeed(const Case& c, const Particles<D>& p, std::span<const std::uint32_t> walls, double time) {
  std::vector<WallMotion<D>> motion;
  for (const Body& body : c.bodies) motion.push_back(wallMotion<D>(c.domain, body, time, 0));
  double speed = 0;
  for (const std::uint32_t i : walls) {
    speed = std::max(speed, norm(p.velocity[i]));
    if (const std::size_t b = p.body[i]; b < motion.size())
      speed = std::max(speed, largestSpeed(c.bodies[b]) + norm(motion[b].swirl(motion[b].arm(p.position[i]))));
  }
  return speed;
}

}  // namespace

template <int D>
DistantWalls<D>::DistantWalls(const Case& c, const CellGrid<D>& cells, Particles<D>& particles, double time,
                              const Communicator* processes)
    : near_(c, cells), stored_(near_.count()) {
  near_.add(particles);
  if (processes) near_.unite(*processes);
  wallSpeed_ = largestSpeed<D>(c, particles, near_.movingWalls(particles), time);
  const Buffer<std::uint32_t> far =
      selected(particles.fluidCount, particles.count, [&](std::uint32_t i) { return near_.isFar(particles, i); });
  if (far.empty()) return;
  store(particles, far);
  particles = nearParticles(near_, particles);
}

template <int D>
void DistantWalls<D>::store(const Particles<D>& particles, std::span<const std::uint32_t> which) {
  count_ = static_cast<std::uint32_t>(which.size());
  const auto take = [&](const auto& from, auto& to, std::uint32_t first) {
    if (from.empty()) return;
    to.resize(which.size());
    gather(from.span(), which, to.data(), first);
  };
  take(particles.position, position_, 0);
  take(particles.material, material_, 0);
  take(particles.body, body_, 0);
  take(particles.id, id_, 0);
  take(particles.wallSurface, surface_, particles.fluidCount);
  for (const Vec<D>& x : position_) stored_[near_.blockOf(x)] = 1;
}

template <int D>
void DistantWalls<D>::addStep(double dt, double fluidWay) {
  way_ += std::max(fluidWay, dt * wallSpeed_);
}

template <int D>
bool DistantWalls<D>::differs(const NearBlocks<D>& near) const {
  for (std::size_t b = 0; b < stored_.size(); ++b)
    if (stored_[b] && near.isNear(b) != near_.isNear(b)) return true;
  return false;
}

template <int D>
Particles<D> DistantWalls<D>::held(const NearBlocks<D>& near, const Particles<D>& walls) const {
  const Buffer<std::uint32_t> kept = selected(0, walls.count, [&](std::uint32_t i) {
    return !(near.isFar(walls, i) && stored_[near.blockOf(walls.position[i])]);
  });
  const Buffer<std::uint32_t> added =
      selected(0, static_cast<std::uint32_t>(position_.size()), [&](std::uint32_t k) {
        const std::size_t block = near.blockOf(position_[k]);
        return near.isNear(block) && !near_.isNear(block);
      });
  const std::uint64_t size = kept.size() + added.size();
  Particles<D> held;
  held.resize({0, size, 0, surface_.empty() ? 0 : size});
  forEachSharedFieldOf([&](const auto& from, auto& to) { gather(from.span(), kept, to.data()); }, walls, held);
  if (!surface_.empty()) gather(walls.wallSurface.span(), kept, held.wallSurface.data());
  copyTo(held, static_cast<std::uint32_t>(kept.size()), added);
  return held;
}

template <int D>
void DistantWalls<D>::accept(NearBlocks<D> near) {
  near_ = std::move(near);
  way_ = 0;
  count_ = static_cast<std::uint32_t>(missing().size());
}

/// Those of the store that are not held.
template <int D>
Buffer<std::uint32_t> DistantWalls<D>::missing() const {
  return selected(0, static_cast<std::uint32_t>(position_.size()),
                  [&](std::uint32_t k) { return !near_.isNear(near_.blockOf(position_[k])); });
}

template <int D>
Particles<D> DistantWalls<D>::inOwnCells(const CellGrid<D>& cells, const CellOwners<D>& owners) const {
  const Buffer<std::uint32_t> far = missing();
  const Buffer<std::uint32_t> own = selected(0, static_cast<std::uint32_t>(far.size()), [&](std::uint32_t k) {
    return owners.isOwn(cells.linear(cells.cellOf(position_[far[k]])));
  });
  Buffer<std::uint32_t> which(own.size());
  gather(far.span(), own, which.data());
  Particles<D> walls;
  walls.resize({0, which.size(), 0, surface_.empty() ? 0 : which.size()});
  copyTo(walls, 0, which);
  return walls;
}

template <int D>
void DistantWalls<D>::copyTo(Particles<D>& all) const {
  const Buffer<std::uint32_t> which = missing();
  copyTo(all, all.count - static_cast<std::uint32_t>(which.size()), which);
}

template <int D>
void DistantWalls<D>::copyTo(Particles<D>& particles, std::uint32_t first,
                             std::span<const std::uint32_t> which) const {
  gather(position_.span(), which, particles.position.data() + first);
  gather(material_.span(), which, particles.material.data() + first);
  gather(body_.span(), which, particles.body.data() + first);
  gather(id_.span(), which, particles.id.data() + first);
  if (!surface_.empty())
    gather(surface_.span(), which, particles.wallSurface.data() + (first - particles.fluidCount));
  parallelFor(which.size(), parallelGrain, [&](std::size_t k) {
    particles.velocity[first + k] = {};
    particles.pressure[first + k] = particles.numberDensity[first + k] = 0;
  });
}

template class DistantWalls<2>;
template class DistantWalls<3>;

}  // namespace treacle
