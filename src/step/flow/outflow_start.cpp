#include "treacle/step/flow/outflow_start.hpp"

#include "treacle/core/error.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <fmt/format.h>

#include <numeric>

namespace treacle {

std::vector<std::uint64_t> fluidInOutflows(const Case& c, const AnyParticles& particles) {
  std::vector<std::uint64_t> held(c.outflows.size() + c.openings.size());
  particles.visit([&]<int D>(const Particles<D>& p) {
    std::vector<OutflowRegion<D>> regions;
    for (const Outflow& o : c.outflows) regions.push_back(OutflowRegion<D>::of(o));
    std::vector<OpeningForce<D>> openings;
    for (const Opening& o : c.openings) openings.push_back(OpeningFace<D>(c, o).place());
    for (std::size_t i = 0; i < p.fluidCount; ++i) {
      if (const std::uint8_t region = regionOf(regions.data(), regions.size(), p.position[i])) ++held[region - 1];
      const std::size_t at = openingAt(openings.data(), openings.size(), p.position[i]);
      if (at < openings.size()) ++held[c.outflows.size() + at];
    }
  });
  return held;
}

void noteFluidInOutflows(const Case& c, std::span<const std::uint64_t> held, std::uint64_t fluid,
                         std::vector<std::string>& notes) {
  const auto ofOpenings = held.begin() + static_cast<std::ptrdiff_t>(c.outflows.size());
  for (std::size_t k = 0; k < c.openings.size(); ++k)
    if (held[c.outflows.size() + k] == 0)
      notes.push_back(fmt::format(
          "opening '{}' has no fluid at its face at the start; fluid goes through it once some is there",
          c.openings[k].name));
  const std::uint64_t all = std::accumulate(held.begin(), ofOpenings, std::uint64_t{0});
  for (std::size_t k = 0; k < c.outflows.size(); ++k) {
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
