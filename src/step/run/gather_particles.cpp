#include "gather_particles.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace treacle {
namespace {

/// What its owner alone knows of an active wall particle.
struct WallState {
  std::uint32_t id;
  double pressure, numberDensity, heldPressure;
};

template <int D>
std::vector<WallState> ownWallStates(const HaloCounts& halo, const Particles<D>& p) {
  std::vector<WallState> states(halo.ownWalls);
  for (std::uint32_t k = 0; k < halo.ownWalls; ++k) {
    const std::uint32_t i = halo.fluid + k;
    states[k] = {p.id[i], p.pressure[i], p.numberDensity[i], p.heldPressure[i]};
  }
  return states;
}

/// Walls as the process knows them, sorted by id, and their states by those who own them.
template <int D>
void putWalls(const Particles<D>& own, const std::vector<WallState>& states, Particles<D>& whole) {
  std::vector<std::uint32_t> order(own.wallCount());
  std::iota(order.begin(), order.end(), own.wallBegin());
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return own.id[i]; });
  forEachSharedFieldOf(
      [&](const auto& from, auto& to) {
        for (std::size_t k = 0; k < order.size(); ++k) to[whole.fluidCount + k] = from[order[k]];
      },
      own, whole);
  forEachWallFieldOf(
      [&](const auto& from, auto& to) {
        if (!from.empty())
          for (std::size_t k = 0; k < order.size(); ++k) to[k] = from[order[k] - own.wallBegin()];
      },
      own, whole);
  std::fill(whole.pressure.begin() + whole.fluidCount, whole.pressure.end(), 0.0);
  std::fill(whole.numberDensity.begin() + whole.fluidCount, whole.numberDensity.end(), 0.0);
  std::fill(whole.heldPressure.begin() + whole.fluidCount, whole.heldPressure.end(), 0.0);
  const auto ids = whole.id.span().subspan(whole.fluidCount, order.size());
  for (const WallState& s : states) {
    const std::size_t i = whole.fluidCount + (std::ranges::lower_bound(ids, s.id) - ids.begin());
    whole.pressure[i] = s.pressure;
    whole.numberDensity[i] = s.numberDensity;
    whole.heldPressure[i] = s.heldPressure;
  }
}

}  // namespace

template <int D>
void gatherParticles(const Communicator& processes, const HaloCounts& halo, const Particles<D>& own,
                     ParticleNumbers all, Particles<D>& whole) {
  const bool first = processes.rank() == 0;
  // No process without fluid has a part where there are modes.
  const std::uint32_t modes = halo.someHaveNone ? 0 : own.modeCount();
  if (first) {
    all.modes = modes;
    whole.resize(all);
    whole.copyNumbers(own);
  }
  // What the others' fields are gathered into: none, but all take part in the same ones.
  Particles<D> nothing;
  nothing.has = own.has;
  Particles<D>& target = first ? whole : nothing;
  const auto gather = [&]<class T>(std::span<const T> part, T* to) { collectTo(processes, part, to); };
  const auto gatherField = [&]<class T>(const Buffer<T>& from, Buffer<T>& to) {
    gather(from.span().first(own.fluidCount), to.data());
  };
  forEachSharedFieldOf(gatherField, own, target);
  forEachFluidFieldOf(gatherField, own, target);
  for (std::size_t m = 0; m < modes; ++m)
    gather(own.modes.vectors.span().subspan(m * own.fluidCount, own.fluidCount),
           target.modes.vectors.data() + (first ? m * target.fluidCount : 0));
  const std::vector<WallState> states = processes.collect(std::span<const WallState>(ownWallStates(halo, own)));
  if (first) putWalls(own, states, whole);
}

template void gatherParticles(const Communicator&, const HaloCounts&, const Particles<2>&, ParticleNumbers,
                              Particles<2>&);
template void gatherParticles(const Communicator&, const HaloCounts&, const Particles<3>&, ParticleNumbers,
                              Particles<3>&);

}  // namespace treacle
