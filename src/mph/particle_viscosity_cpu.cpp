#include "treacle/mph/particle_viscosity.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/core/processes.hpp"

#include <algorithm>
#include <vector>

namespace treacle {

RheologyTable RheologyTable::make(const Case& c) {
  RheologyTable table;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    const Material& material = c.materials[m];
    table.of[m] = material.rheology.value_or(Rheology::newtonian(material.dynamicViscosity));
    if (material.viscosityShift) table.shift[m] = ShiftFactor::make(*material.viscosityShift);
  }
  return table;
}

void setViscosities(Context<Cpu>&, const ViscosityTerms& terms) {
  parallelFor(terms.rate.size(), parallelGrain, [&](std::size_t i) { terms.set(i); });
}

void setClasses(Context<Cpu>&, const ClassTerms& terms) {
  parallelFor(terms.kind.size(), parallelGrain, [&](std::size_t i) { terms.set(i); });
}

double nextRates(Context<Cpu>& context, const RateTerms& terms) {
  using Sums = std::array<double, RateTerms::count>;
  const std::size_t count = terms.found.size();
  std::vector<Sums> parts((count + reductionChunk - 1) / reductionChunk);
  parallelFor(parts.size(), 2, [&](std::size_t part) {
    const std::size_t end = std::min(count, (part + 1) * reductionChunk);
    for (std::size_t i = part * reductionChunk; i < end; ++i) terms.add(i, parts[part].data());
  });
  Sums sums{};
  for (const Sums& part : parts)
    for (int k = 0; k < RateTerms::count; ++k) sums[k] += part[k];
  sumOverProcesses(context, std::span<double>(sums));
  return RateTerms::change(sums);
}

}  // namespace treacle
