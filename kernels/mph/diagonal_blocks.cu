#include "mph/cluster_sum.cuh"
#include "mph/product_terms.cuh"
#include "treacle/mph/mph_assembly.hpp"

namespace treacle {
namespace {

template <int D>
inline constexpr int diagonalValues = D*(D + 1) / 2 + D;

/// Sums of a diagonal block of A per fluid particle: the upper triangle of V_ii + sum_j lambda_j C_ij C_ij^T, then
/// C_ii. The viscous part of walls stands in the wall terms.
template <int D, class Mph, bool Renormalised>
struct DiagonalTerms {
  static constexpr int values = diagonalValues<D>;
  static constexpr bool uses(ListSegment s) { return s != ListSegment::FarWall; }
  struct Other {
    std::uint32_t j;
    double lambda;
    ViscousSide side;
  };
  using Own = ViscousSide;

  Mph mph;
  double* sums;  // `values` per fluid particle

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.viscousSide(i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return {j, pairs.bulkViscosity(j), pairs.viscousSide(j)};
  }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, const Other& other, ListSegment segment) const {
    const double g = mph.gradient(r);
    double f = other.lambda * g * g;
    if constexpr (Renormalised) {
      const Vec<D> column = pairs.corrected(other.j, d);
      int n = 0;
      for (int r = 0; r < D; ++r)
        for (int c = r; c < D; ++c) sum[n++] += f * column[r] * column[c];
      f = 0;
    }
    if (isFluid(segment)) f += pairs.viscosityOf(own, other.side) * mph.viscousFactor * mph.viscousShape(r);
    int n = 0;
    for (int r = 0; r < D; ++r)
      for (int c = r; c < D; ++c) sum[n++] += f * d[r] * d[c];
    for (int r = 0; r < D; ++r) sum[n++] += g * d[r];
  }

  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    sums[std::size_t{values} * i + n] = sum;
  }
};

/// One thread per own fluid particle; reads its sums and its wall block; writes its diagonal block. No atomics.
template <int D>
__global__ void finishKernel(const __grid_constant__ MphPairs<D> pairs, const double* sums, const Block<D>* wall,
                             Block<D>* diagonal) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.ownFluid()) return;
  const double* sum = sums + std::size_t{diagonalValues<D>} * i;
  Block<D> block = wall[i];
  for (int r = 0; r < D; ++r)
    for (int c = r; c < D; ++c) {
      const double value = *sum++;
      block(r, c) += value;
      if (c != r) block(c, r) += value;
    }
  Vec<D> own;
  for (int r = 0; r < D; ++r) own[r] = sum[r];
  own = pairs.corrected(i, own);
  block.addOuter(pairs.bulkViscosity(i), own, own);
  diagonal[i] = block;
}

}  // namespace

template <int D>
void diagonalBlocks(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                    std::span<Block<D>> diagonal) {
  Buffer<double, Cuda> sums(context, std::size_t{diagonalValues<D>} * pairs.fluidCount);
  const auto places = LocalPositions<D, double>::make(pairs);
  withSchemeTerms(pairs, [&](const auto& mph, auto renormalised) {
    using Terms = DiagonalTerms<D, std::decay_t<decltype(mph)>, decltype(renormalised)::value>;
    const ListTask<Terms> task{pairs.fluidList, {mph, sums.data()}};
    if (!pairs.fluidList.offset)
      launchClusterSums<D, double, Sharing<2, 1, true>>(context, pairs, task, places);
    else if (pairs.fluidList.clusterCount() < fewClusters)
      launchClusterSums<D, double, Sharing<2, 4>>(context, pairs, task, places);
    else
      launchClusterSums<D, double, Sharing<2, 1>>(context, pairs, task, places);
  });

  launch(context, blocksFor(pairs.ownFluid(), 256), 256, 0, finishKernel<D>, pairs, sums.data(),
         terms.block.data(), diagonal.data());
}

template void diagonalBlocks<2>(Context<Cuda>&, const MphPairs<2>&, const WallTerms<2>&, std::span<Block<2>>);
template void diagonalBlocks<3>(Context<Cuda>&, const MphPairs<3>&, const WallTerms<3>&, std::span<Block<3>>);

}  // namespace treacle
