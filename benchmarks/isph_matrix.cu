#include "isph_matrix.hpp"

#include "core/reduce.cuh"
#include "core/scan.hpp"
#include "treacle/core/error.hpp"

#include <limits>
#include <string>

namespace treacle {
namespace {

/// f(j, r) for the fluid within `radius` around a fluid particle, itself included.
template <int D, class F>
__device__ void forEachFluid(const IsphPairs<D>& pairs, double radius, std::uint32_t i, F&& f) {
  const Vec<D> x = pairs.position[i];
  forEachAdjacentCell(pairs.grid, pairs.grid.cellOf(x), [&](const Vec<D, int>& cell) {
    const std::size_t c = pairs.grid.linear(cell);
    for (std::uint32_t j = pairs.cells.fluidBegin[c]; j < pairs.cells.fluidEnd[c]; ++j) {
      const double r = norm(pairs.grid.difference(x, pairs.position[j]));
      if (r < radius) f(j, r);
    }
  });
}

/// One thread per fluid particle; reads the particles around it; writes the number of its nonzeros. No atomics.
template <int D>
__global__ void countKernel(const __grid_constant__ IsphPairs<D> pairs, double radius, PressureRow<D> row,
                            std::int32_t* count) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.fluidCount) return;
  std::int32_t sum = 0;
  if (row.isUnknown(i)) forEachFluid(pairs, radius, i, [&](std::uint32_t j, double) { sum += row.isUnknown(j); });
  count[i] = row.isUnknown(i) ? sum : 1;
}

/// One thread per fluid particle; reads the particles around it; writes its row. No atomics.
template <int D>
__global__ void fillKernel(const __grid_constant__ IsphPairs<D> pairs, double radius, PressureRow<D> row,
                           const std::int32_t* start, std::int32_t* column, double* value, double* inverse) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.fluidCount) return;
  std::int32_t place = start[i], own = place;
  const bool unknown = row.isUnknown(i);
  double diagonal = unknown ? row.own(pairs, i) : 0;
  if (unknown)
    forEachFluid(pairs, radius, i, [&](std::uint32_t j, double) {
      const Vec<D> d = pairs.grid.difference(pairs.position[i], pairs.position[j]);
      const double c = i == j ? 0 : row.coefficient(pairs, i, j, d, Distance(d));
      diagonal += c;
      if (!row.isUnknown(j)) return;
      if (i == j) own = place;
      column[place] = static_cast<std::int32_t>(j);
      value[place++] = -c;
    });
  column[own] = static_cast<std::int32_t>(i);
  value[own] = unknown ? diagonal : 1;
  inverse[i] = unknown && diagonal > 0 ? 1 / diagonal : 0;
}

/// Number of particle i's neighbours within a radius.
template <int D>
struct CountWithin {
  IsphPairs<D> pairs;
  double radius;
  __device__ double operator()(std::size_t i) const {
    double sum = 0;
    forEachFluid(pairs, radius, static_cast<std::uint32_t>(i), [&](std::uint32_t, double) { ++sum; });
    return sum;
  }
};

/// Of whole numbers.
template <class Body>
std::uint64_t sumOf(Context<Cuda>& context, std::size_t count, const Body& body) {
  Buffer<double, Cuda> sum(context, 1);
  reduce(context, count, body, [to = sum.data()] __device__(double total) { *to = total; });
  return static_cast<std::uint64_t>(valueOnHost(context, sum.data()));
}

}  // namespace

template <int D>
void assemblePressure(Context<Cuda>& context, const IsphPairs<D>& pairs, const PressureRow<D>& row, ScalarCsr& a,
                      Buffer<double, Cuda>& inverse) {
  const std::uint32_t n = pairs.fluidCount;
  a.resize(context, n, n);
  inverse.resize(context, n);
  const double radius = pairs.kernel.radius();
  std::int32_t* start = a.start.data();
  launch(context, blocksFor(n, 128), 128, 0, countKernel<D>, pairs, radius, row, start);
  const std::uint64_t entries =
      sumOf(context, n, [start] __device__(std::size_t i) { return static_cast<double>(start[i]); });
  if (entries > std::numeric_limits<std::int32_t>::max())
    throw RunError("the matrix has " + std::to_string(entries) +
                   " nonzeros, more than cuSPARSE's 32-bit rows count");
  clearBytes(context, a.start.data() + a.start.size() - 1, sizeof(std::int32_t));
  sumBefore(context, std::span{reinterpret_cast<std::uint32_t*>(a.start.data()), a.start.size()});
  a.reserveEntries(context, static_cast<std::int64_t>(entries));
  launch(context, blocksFor(n, 128), 128, 0, fillKernel<D>, pairs, radius, row, start, a.column.data(),
         a.value.data(), inverse.data());
}

template <int D>
void clearKnown(Context<Cuda>& context, const PressureRow<D>& row, std::span<double> x) {
  forEach(context, x.size(), [row, x = x.data()] __device__(std::size_t i) {
    if (!row.isUnknown(static_cast<std::uint32_t>(i))) x[i] = 0;
  });
}

template <int D>
PairCounts countPairs(Context<Cuda>& context, const IsphPairs<D>& pairs, double near) {
  const auto within = [&](double radius) {
    return sumOf(context, pairs.fluidCount, CountWithin<D>{pairs, radius});
  };
  return {within(pairs.kernel.radius()), within(near)};
}

#define TREACLE_INSTANTIATE(D)                                                                              \
  template void assemblePressure<D>(Context<Cuda>&, const IsphPairs<D>&, const PressureRow<D>&, ScalarCsr&, \
                                    Buffer<double, Cuda>&);                                                 \
  template void clearKnown<D>(Context<Cuda>&, const PressureRow<D>&, std::span<double>);                    \
  template PairCounts countPairs<D>(Context<Cuda>&, const IsphPairs<D>&, double);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
