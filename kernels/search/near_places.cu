#include "treacle/search/near_places.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/core/copy_values.hpp"

namespace treacle {
namespace {

/// Appends the particles of [begin, begin + count) that are in the surroundings to `index`, which has room for
/// `listed` and them, ascending; returns how many the list has then. One thread per particle; reads its position
/// and how many come before it, writes its index; atomics no.
template <int D>
std::uint32_t listNear(Context<Cuda>& context, const Surroundings<D>& near, const Vec<D>* position,
                       std::uint32_t begin, std::uint32_t count, std::uint32_t* index, std::uint32_t listed) {
  Buffer<std::uint32_t, Cuda> place(context, std::size_t{count} + 1);  // the last one: of all
  forEach(context, std::size_t{count} + 1,
          [near, position = position + begin, count, place = place.data()] __device__(std::size_t i) {
            place[i] = i < count && near.holds(position[i]) ? 1 : 0;
          });
  sumBefore(context, place.span());
  forEach(context, count, [begin, place = place.data(), index = index + listed] __device__(std::size_t i) {
    if (place[i] != place[i + 1]) index[place[i]] = begin + static_cast<std::uint32_t>(i);
  });
  return listed + valueOnHost(context, place.data() + count);
}

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
  const Vec<D>* position = particles.position.data();
  const std::uint32_t fluid = listNear(context, near, position, 0, particles.fluidCount, index.data(), 0);
  const std::uint32_t all = listNear(context, near, position, particles.wallBegin(), walls, index.data(), fluid);
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
