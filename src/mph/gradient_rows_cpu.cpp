#include "treacle/mph/mph_assembly.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_neighbours.hpp"

namespace treacle {

template <int D>
void gradientRows(Context<Cpu>&, const MphPairs<D>& pairs, GradientRows<D>& rows) {
  rows.rowStart.resize(pairs.activeCount + 1);
  rows.rowStart[0] = 0;
  parallelFor(pairs.activeCount, parallelGrain, [&](std::size_t i) {
    std::uint64_t count = 0;
    forEachNear(pairs, static_cast<std::uint32_t>(i),
                [&](std::uint32_t, const Vec<D>&, const Vec<D>&) { ++count; });
    rows.rowStart[i + 1] = count;
  });
  for (std::uint32_t i = 0; i < pairs.activeCount; ++i) rows.rowStart[i + 1] += rows.rowStart[i];

  rows.column.resize(rows.rowStart[pairs.activeCount]);
  rows.value.resize(rows.rowStart[pairs.activeCount]);
  parallelFor(pairs.activeCount, parallelGrain, [&](std::size_t i) {
    std::uint64_t next = rows.rowStart[i];
    forEachNear(pairs, static_cast<std::uint32_t>(i), [&](std::uint32_t j, const Vec<D>&, const Vec<D>& g) {
      rows.column[next] = j;
      rows.value[next++] = g;
    });
  });
}

template void gradientRows<2>(Context<Cpu>&, const MphPairs<2>&, GradientRows<2>&);
template void gradientRows<3>(Context<Cpu>&, const MphPairs<3>&, GradientRows<3>&);

}  // namespace treacle
