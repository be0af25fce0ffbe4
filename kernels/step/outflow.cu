#include "treacle/step/flow/outflow.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per particle; reads its place and, of those that leave, the material, writes its mark; an atomic sum
/// for each one that leaves.
template <int D>
std::vector<std::uint32_t> markOutflow(Context<Cuda>& context, const OutflowTest<D>& test,
                                       std::span<std::uint8_t> gone) {
  std::vector<std::uint32_t> counts(test.regions.size() * maxMaterials);
  const std::size_t bytes = counts.size() * sizeof(std::uint32_t);
  auto* sums = static_cast<std::uint32_t*>(context.scratch(bytes));
  clearBytes(context, sums, bytes);
  forEach(context, gone.size(),
          [regions = test.regions, x = test.position.data(), m = test.material.data(), gone = gone.data(),
           sums] __device__(std::size_t i) {
            const std::uint8_t region = regionOf(regions.data(), regions.size(), x[i]);
            gone[i] = region;
            if (region > 0) atomicAdd(sums + (region - 1u) * maxMaterials + m[i], 1u);
          });
  copyBytesToHost(context, sums, counts.data(), bytes);
  return counts;
}

template std::vector<std::uint32_t> markOutflow(Context<Cuda>&, const OutflowTest<2>&, std::span<std::uint8_t>);
template std::vector<std::uint32_t> markOutflow(Context<Cuda>&, const OutflowTest<3>&, std::span<std::uint8_t>);

}  // namespace treacle
