#include "treacle/step/outflow.hpp"

#include "core/launch.hpp"
#include "treacle/core/copy_values.hpp"

namespace treacle {

/// One thread per particle; reads its place and, of those that leave, the material, writes its mark; an atomic sum
/// for each one that leaves.
template <int D>
std::vector<std::uint32_t> markOutflow(Context<Cuda>& context, const OutflowTest<D>& test,
                                       std::span<std::uint8_t> gone) {
  std::vector<std::uint32_t> counts(test.regions.size() * maxMaterials);
  Buffer<OutflowRegion<D>, Cuda> regions;
  fromHost(context, std::span<const OutflowRegion<D>>(test.regions), regions);
  Buffer<std::uint32_t, Cuda> sums(context, counts.size());
  clearBytes(context, sums.data(), sums.bytes());
  forEach(context, gone.size(),
          [regions = regions.data(), count = regions.size(), x = test.position.data(), m = test.material.data(),
           gone = gone.data(), sums = sums.data()] __device__(std::size_t i) {
            const std::uint8_t region = regionOf(regions, count, x[i]);
            gone[i] = region;
            if (region > 0) atomicAdd(sums + (region - 1u) * maxMaterials + m[i], 1u);
          });
  copyToHost(context, std::span<const std::uint32_t>(sums), counts.data());
  return counts;
}

template std::vector<std::uint32_t> markOutflow(Context<Cuda>&, const OutflowTest<2>&, std::span<std::uint8_t>);
template std::vector<std::uint32_t> markOutflow(Context<Cuda>&, const OutflowTest<3>&, std::span<std::uint8_t>);

}  // namespace treacle
