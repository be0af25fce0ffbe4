#include "treacle/search/near_places.hpp"

#include <vector>

namespace treacle {

template <int D>
void copyNear(Context<Cpu>&, const Surroundings<D>& near, const Particles<D>& particles, std::uint32_t walls,
              Particles<D>& host) {
  std::vector<std::uint32_t> index;
  const auto list = [&](std::uint32_t begin, std::uint32_t count) {
    for (std::uint32_t i = begin; i < begin + count; ++i)
      if (near.holds(particles.position[i])) index.push_back(i);
    return index.size();
  };
  const std::size_t fluid = list(0, particles.fluidCount), all = list(particles.wallBegin(), walls);
  host.resize(numbersOfSome(particles, fluid, all - fluid));
  const auto take = [&](std::size_t count) {
    return [&, count](const auto& from, auto& to) {
      for (std::size_t k = 0; k < count; ++k) to[k] = from[index[k]];
    };
  };
  forEachSharedFieldOf(take(all), particles, host);
  forEachFluidFieldOf(take(fluid), particles, host);
}

template void copyNear(Context<Cpu>&, const Surroundings<2>&, const Particles<2>&, std::uint32_t, Particles<2>&);
template void copyNear(Context<Cpu>&, const Surroundings<3>&, const Particles<3>&, std::uint32_t, Particles<3>&);

}  // namespace treacle
