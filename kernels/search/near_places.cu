#include "treacle/search/near_places.hpp"

#include "core/launch.hpp"
#include "core/list_where.cuh"
#include "treacle/core/copy_values.hpp"

namespace treacle {
namespace {

/// The values of these particles. One thread for each: reads its index and value, writes the value.
template <class T>
void gatherToHost(Context<Cuda>& context, std::span<const std::uint32_t> index, const T* from, T* host) {
  Buffer<T, Cuda> some(context, index.size());
  forEach(context, index.size(), [index = index.data(), from, some = some.data()] __device__(std::size_t k) {
    some[k] = from[index[k]];
  });
  copyToHost(context, std::span<const T>(some), host);
}

}  // namespace

template <int D>
void copyNear(Context<Cuda>& context, const Surroundings<D>& near, const Particles<D, Cuda>& particles,
              std::uint32_t walls, Particles<D>& host) {
  Buffer<std::uint32_t, Cuda> index(context, std::size_t{particles.fluidCount} + walls);
  const auto isNear = [near, position = particles.position.data()] __device__(std::uint32_t i) {
    return near.holds(position[i]);
  };
  const std::uint32_t fluid = listWhere(context, 0, particles.fluidCount, isNear, index.data());
  const std::uint32_t all = listWhere(context, particles.wallBegin(), walls, isNear, index.data(), fluid);
  host.resize(numbersOfSome(particles, fluid, all - fluid));
  const auto take = [&](std::uint32_t count) {
    return [&, count](const auto& from, auto& to) {
      gatherToHost(context, index.span().first(count), from.data(), to.data());
    };
  };
  forEachSharedFieldOf(take(all), particles, host);
  forEachFluidFieldOf(take(fluid), particles, host);
}

template void copyNear(Context<Cuda>&, const Surroundings<2>&, const Particles<2, Cuda>&, std::uint32_t,
                       Particles<2>&);
template void copyNear(Context<Cuda>&, const Surroundings<3>&, const Particles<3, Cuda>&, std::uint32_t,
                       Particles<3>&);

}  // namespace treacle
