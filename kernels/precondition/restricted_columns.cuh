#pragma once

#include "mph/cluster_sum.cuh"
#include "mph/product_terms.cuh"
#include "precondition/bucket_cells.cuh"

namespace treacle {

/// (R C)_{I k}, per own particle k for the 2^D cells I around it: the sum of C_ik over the fluid particles i of
/// the cell.
template <int D, class Mph>
struct RestrictedColumns {
  static constexpr int slots = power<D>(2), values = D * slots;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {
    Vec<D, int> cell, lower;
    int slot;  // of its own cell; -1 for walls, whose C_kk is not there
  };
  using Other = Vec<D, int>;  // cell

  Mph mph;
  double* columns;  // `values` per particle

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t k) const {
    const Vec<D> x = pairs.position[k];
    const Vec<D, int> cell = pairs.grid.cellOf(x), lower = lowerCell(pairs.grid, x, cell);
    return {cell, lower, k < pairs.fluidCount ? columnSlot<D>(-lower) : -1};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return pairs.grid.cellOf(pairs.position[j]);
  }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    const double g = mph.gradient(r);
    // A neighbour in none of the cells is at distance h_p to rounding, where g vanishes.
    const int slot = isFluid(segment) ? columnSlot<D>(cellOffset(pairs.grid, own.cell, other) - own.lower) : -1;
#pragma unroll
    for (int s = 0; s < slots; ++s) {
      const double weight = g * ((s == own.slot) - (s == slot));
      for (int c = 0; c < D; ++c) sum[s * D + c] = fma(weight, d[c], sum[s * D + c]);
    }
  }

  __device__ void store(const MphPairs<D>&, std::uint32_t k, int n, double sum) const {
    columns[std::size_t{values} * k + n] = sum;
  }
};

template <int D>
void restrictedColumns(Context<Cuda>& context, const MphPairs<D>& pairs, Buffer<Vec<D>, Cuda>& columns) {
  constexpr int slots = power<D>(2);
  columns.resize(context, std::size_t{slots} * pairs.activeCount);
  const auto places = LocalPositions<D, double>::make(pairs);
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    using Terms = RestrictedColumns<D, Mph>;
    const Terms terms{mph, reinterpret_cast<double*>(columns.data())};
    const ListTask<Terms> fluid{pairs.fluidList, terms}, walls{pairs.wallList, terms};
    if (pairs.fluidList.offset)
      launchClusterSums<D, double, Sharing<1, 1>>(context, pairs, fluid, walls, places);
    else
      launchClusterSums<D, double, Sharing<1, 1, true>>(context, pairs, fluid, walls, places);
  });
  if (pairs.renormalisation)
    forEach(
        context, std::size_t{slots} * pairs.ownFluid(),
        [b = pairs.renormalisation, c = columns.data()] __device__(std::size_t k) { c[k] = b[k / slots] * c[k]; });
}

}  // namespace treacle
