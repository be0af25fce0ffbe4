#include "treacle/step/flow/outflow.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D>
std::vector<std::uint32_t> markOutflow(Context<Cpu>&, const OutflowTest<D>& test, std::span<std::uint8_t> gone) {
  parallelFor(gone.size(), parallelGrain, [&](std::size_t i) {
    gone[i] = regionOf(test.regions.data(), test.regions.size(), test.position[i]);
  });
  std::vector<std::uint32_t> counts(test.regions.size() * maxMaterials);
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (gone[i] > 0) ++counts[(gone[i] - 1u) * maxMaterials + test.material[i]];
  return counts;
}

template std::vector<std::uint32_t> markOutflow(Context<Cpu>&, const OutflowTest<2>&, std::span<std::uint8_t>);
template std::vector<std::uint32_t> markOutflow(Context<Cpu>&, const OutflowTest<3>&, std::span<std::uint8_t>);

}  // namespace treacle
