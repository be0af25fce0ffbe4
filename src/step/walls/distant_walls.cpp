#include "treacle/step/walls/distant_walls.hpp"

#include "run/selected.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "walls_of_all.hpp"

#include <algorithm>
#include <cstddef>
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
    : processes_(processes),
      near_(c, cells),
      stored_(near_.count()),
      hasSurfaces_(!particles.wallSurface.empty()) {
  near_.add(particles);
  if (processes_) near_.unite(*processes_);
  const Buffer<std::uint32_t> far =
      selected(particles.fluidCount, particles.count, [&](std::uint32_t i) { return near_.isFar(particles, i); });
  if (!far.empty()) {
    store(particles, far);
    particles = nearParticles(near_, particles);
  }
  if (processes_) holdThoseOfAll(particles);
  wallSpeed_ = largestSpeed<D>(c, particles, near_.movingWalls(particles), time);
  storedSome_ = std::ranges::find(stored_, 1) != stored_.end();
  countMissing();
}

template <int D>
void DistantWalls<D>::store(const Particles<D>& particles, std::span<const std::uint32_t> which) {
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

/// Each process comes with a part of the walls that are near.
template <int D>
void DistantWalls<D>::holdThoseOfAll(Particles<D>& particles) {
  processes_->anyOf(stored_);
  std::uint8_t surfaces = hasSurfaces_;
  processes_->anyOf({&surfaces, 1});
  hasSurfaces_ = surfaces != 0;
  Context<Cpu> host;
  Particles<D> own;
  copyWallsToHost(host, particles, own);
  replaceWalls(host, wallsOfAll(*processes_, own, hasSurfaces_), particles);
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
  Particles<D> added = chosen(selected(0, static_cast<std::uint32_t>(position_.size()), [&](std::uint32_t k) {
    const std::size_t block = near.blockOf(position_[k]);
    return near.isNear(block) && !near_.isNear(block);
  }));
  if (processes_) added = wallsOfAll(*processes_, added, hasSurfaces_);
  const std::uint64_t size = kept.size() + added.count;
  Particles<D> held;
  held.resize({0, size, 0, hasSurfaces_ ? size : 0});
  const auto join = [&](const auto& from, const auto& more, auto& to) {
    gather(from.span(), kept, to.data());
    std::copy(more.begin(), more.end(), to.data() + kept.size());
  };
  forEachSharedFieldOf(join, walls, added, held);
  if (hasSurfaces_) forEachWallFieldOf(join, walls, added, held);
  return held;
}

template <int D>
void DistantWalls<D>::accept(NearBlocks<D> near) {
  near_ = std::move(near);
  way_ = 0;
  countMissing();
}

template <int D>
void DistantWalls<D>::countMissing() {
  std::uint64_t count = missing().size();
  if (processes_) processes_->sum(std::span<std::uint64_t>(&count, 1));
  countOfAll_ = static_cast<std::uint32_t>(count);
}

/// The walls of the store that are not held.
template <int D>
Buffer<std::uint32_t> DistantWalls<D>::missing() const {
  return selected(0, static_cast<std::uint32_t>(position_.size()),
                  [&](std::uint32_t k) { return !near_.isNear(near_.blockOf(position_[k])); });
}

template <int D>
Particles<D> DistantWalls<D>::ofPart() const {
  return chosen(missing());
}

template <int D>
void DistantWalls<D>::copyTo(Particles<D>& all) const {
  if (processes_) return appendWallsOfAll(*processes_, ofPart(), hasSurfaces_, all);
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
    particles.pressure[first + k] = particles.numberDensity[first + k] = particles.heldPressure[first + k] = 0;
  });
}

/// These of the store as particles.
template <int D>
Particles<D> DistantWalls<D>::chosen(std::span<const std::uint32_t> which) const {
  Particles<D> walls;
  walls.resize({0, which.size(), 0, surface_.empty() ? 0 : which.size()});
  copyTo(walls, 0, which);
  return walls;
}

template class DistantWalls<2>;
template class DistantWalls<3>;

}  // namespace treacle
