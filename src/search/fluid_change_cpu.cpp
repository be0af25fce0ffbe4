#include "treacle/search/fluid_change.hpp"

#include "migration.hpp"

#include <algorithm>
#include <cstddef>

namespace treacle {

template <int D, class Backend>
void changeFluid(Context<Backend>&, std::span<const std::uint8_t> gone, const Particles<D>& added,
                 Particles<D, Backend>& particles) {
  std::vector<std::uint32_t> kept;
  kept.reserve(particles.fluidCount);
  for (std::uint32_t i = 0; i < particles.fluidCount; ++i)
    if (gone.empty() || gone[i] == 0) kept.push_back(i);
  keepFluid<D>(particles, kept, added.fluidCount);
  const std::size_t first = kept.size();
  const auto put = [&](const auto& from, auto& to) {
    std::copy_n(from.begin(), added.fluidCount, to.begin() + static_cast<std::ptrdiff_t>(first));
  };
  forEachSharedFieldOf(put, added, particles);
  forEachFluidFieldOf(put, added, particles);
  for (std::size_t m = 0; m < particles.modeCount(); ++m)
    std::fill_n(particles.modes.vectors.begin() + static_cast<std::ptrdiff_t>(m * particles.fluidCount + first),
                added.fluidCount, Vec<D, float>{});
}

template void changeFluid(Context<Cpu>&, std::span<const std::uint8_t>, const Particles<2>&, Particles<2>&);
template void changeFluid(Context<Cpu>&, std::span<const std::uint8_t>, const Particles<3>&, Particles<3>&);

}  // namespace treacle
