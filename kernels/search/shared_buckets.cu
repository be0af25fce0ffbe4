#include "treacle/search/shared_buckets.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per bucket; reads the key of its first particle, writes its cell; atomics no.
void bucketCells(Context<Cuda>& context, std::span<const std::uint64_t> key, std::span<const std::uint32_t> begin,
                 int shift, std::span<std::uint64_t> cells) {
  forEach(context, cells.size(),
          [key = key.data(), begin = begin.data(), shift, cells = cells.data()] __device__(std::size_t b) {
            cells[b] = key[begin[b]] >> shift;
          });
}

/// One thread per particle; reads its position, writes its key; atomics no.
template <int D>
void sortKeys(Context<Cuda>& context, const CellGrid<D>& grid, std::span<const Vec<D>> position,
              std::span<std::uint64_t> key) {
  forEach(context, position.size(),
          [grid, position = position.data(), key = key.data()] __device__(std::size_t i) {
            key[i] = grid.key(position[i]);
          });
}

template void sortKeys<2>(Context<Cuda>&, const CellGrid<2>&, std::span<const Vec<2>>, std::span<std::uint64_t>);
template void sortKeys<3>(Context<Cuda>&, const CellGrid<3>&, std::span<const Vec<3>>, std::span<std::uint64_t>);

}  // namespace treacle
