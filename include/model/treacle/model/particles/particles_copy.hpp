#pragma once

#include "treacle/core/copy_values.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <utility>

namespace treacle {

/// All fields and counts; they wait until the data are there. Errors: std::bad_alloc.
template <int D>
void copyToDevice(const Context<Cuda>& context, const Particles<D>& host, Particles<D, Cuda>& device) {
  device.resize(context, host.numbers());
  device.copyNumbers(host);
  forEachFieldOf([&](const auto& from, auto& to) { copyFromHost(context, from.span(), to.data()); }, host, device);
}
/// All fields, and the counts of what is not per particle, to the first places of the host's fields, which have as
/// many or more.
template <int D, class Backend>
void copyFieldsToHost(const Context<Backend>& context, const Particles<D, Backend>& particles,
                      Particles<D>& host) {
  host.copyNumbers(particles);
  forEachFieldOf([&](const auto& from, auto& to) { copyToHost(context, from.span(), to.data()); }, particles,
                 host);
}
template <int D, class Backend>
void copyToHost(const Context<Backend>& context, const Particles<D, Backend>& particles, Particles<D>& host) {
  host.resize(particles.numbers());
  copyFieldsToHost(context, particles, host);
}

/// The walls alone, which are then all that `walls` has. Errors: std::bad_alloc.
template <int D, class Backend>
void copyWallsToHost(const Context<Backend>& context, const Particles<D, Backend>& particles,
                     Particles<D>& walls) {
  walls.resize({0, particles.wallCount(), 0, particles.wallSurface.size(), 0, particles.has.ofWalls()});
  const std::uint32_t n = particles.wallBegin();
  forEachSharedFieldOf([&](const auto& from, auto& to) { copyToHost(context, from.span().subspan(n), to.data()); },
                       particles, walls);
  forEachWallFieldOf([&](const auto& from, auto& to) { copyToHost(context, from.span(), to.data()); }, particles,
                     walls);
}

/// These walls of the host's in place of those of the particles. Errors: std::bad_alloc, which leaves all as it
/// was.
template <int D, class Backend>
void replaceWalls(Context<Backend>& context, const Particles<D>& walls, Particles<D, Backend>& particles) {
  const std::uint32_t n = particles.wallBegin(), count = n + walls.wallCount();
  Particles<D, Backend> replaced;
  replaced.resize(context, {0, count, 0, walls.wallSurface.size(), 0, walls.has.ofWalls()});
  forEachSharedFieldOf(
      [&]<class T, class Field>(const Buffer<T>& from, Field& old, Field& field) {
        copyValues(context, std::span<const T>(old).first(n), field.data());
        copyFromHost(context, from.span(), field.data() + n);
        std::swap(old, field);
      },
      walls, particles, replaced);
  forEachWallFieldOf(
      [&](const auto& from, auto& old, auto& field) {
        copyFromHost(context, from.span(), field.data());
        std::swap(old, field);
      },
      walls, particles, replaced);
  particles.count = count;
}

}  // namespace treacle
