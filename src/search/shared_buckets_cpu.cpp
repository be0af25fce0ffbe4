#include "treacle/core/parallel.hpp"
#include "treacle/search/shared_buckets.hpp"

namespace treacle {

void bucketCells(Context<Cpu>&, std::span<const std::uint64_t> key, std::span<const std::uint32_t> begin,
                 int shift, std::span<std::uint64_t> cells) {
  for (std::size_t b = 0; b < cells.size(); ++b) cells[b] = key[begin[b]] >> shift;
}

template <int D>
void sortKeys(Context<Cpu>&, const CellGrid<D>& grid, std::span<const Vec<D>> position,
              std::span<std::uint64_t> key) {
  parallelFor(position.size(), parallelGrain, [&](std::size_t i) { key[i] = grid.key(position[i]); });
}

template void sortKeys<2>(Context<Cpu>&, const CellGrid<2>&, std::span<const Vec<2>>, std::span<std::uint64_t>);
template void sortKeys<3>(Context<Cpu>&, const CellGrid<3>&, std::span<const Vec<3>>, std::span<std::uint64_t>);

}  // namespace treacle
