#include "treacle/step/flow/outflow_start.hpp"

#include "treacle/core/error.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <fmt/format.h>

#include <numeric>

namespace treacle {

std::vector<std::uint64_t> fluidInOutflows(const Case& c, const AnyParticles& particles) {
  std::vector<std::uint64_t> held(c.outflows.size());
  particles.visit([&]<int D>(const Particles<D>& p) {
    std::vector<OutflowRegion<D>> regions;
    for (const Outflow& o : c.outflows) regions.push_back(OutflowRegion<D>::of(o));
    for (std::size_t i = 0; i < p.fluidCount; ++i)
      if (const std::uint8_t region = regionOf(regions.data(), regions.size(), p.position[i])) ++held[region - 1];
  });
  return held;
}

void noteFluidInOutflows(const Case& c, std::span<const std::uint64_t> held, std::uint64_t fluid,
                         std::vector<std::string>& notes) {
  const std::uint64_t all = std::accumulate(held.begin(), held.end(), std::uint64_t{0});
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (held[k] == 0) continue;
    std::string note =
        fmt::format("outflow '{}' holds {} of {} fluid particles at the start, which leave in the first step",
                    c.outflows[k].name, held[k], fluid);
    if (all == fluid && !c.hasInflow())
      throw InputError(note + "; no fluid would be left: expected an outflow beside the fluid");
    notes.push_back(std::move(note));
  }
}

}  // namespace treacle
