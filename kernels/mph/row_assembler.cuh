#pragma once

#include "core/reduce.cuh"
#include "treacle/core/block.hpp"
#include "treacle/mph/mph_pairs.hpp"

namespace treacle {

/// What the assembly reads besides the pairs, and what it writes.
template <int D>
struct Assembly {
  const std::uint64_t* gradientStart;  // rows of C
  const std::uint32_t* pressure;
  const Vec<D>* g;
  const Vec<D>* own;         // C_ii per fluid particle
  const Block<D>* ownBlock;  // inertia and walls per fluid particle
  const std::uint64_t* rowStart;
  const std::uint32_t* column;
  Block<D>* block;
};

/// Assembles one row of A by one warp: the lanes take 32 blocks at a time, and for each of them all pressures that
/// particle i feels. Renormalised: whether the pairs have B.
template <int D, class Mph, bool Renormalised>
class RowAssembler {
 public:
  /// Shared memory of a warp.
  struct Scratch {
    static constexpr int stride = D * D | 1;  // odd: no two lanes in one bank
    double block[32 * stride];
    Vec<D> d[32];         // x_k - x_i of pressure k
    Vec<D> weighted[32];  // lambda_k c_ik
    std::uint32_t k[32];
  };

  __device__ RowAssembler(const MphPairs<D>& pairs, const Mph& mph, const Assembly<D>& a, std::uint32_t i,
                          Scratch& scratch)
      : pairs_(pairs),
        mph_(mph),
        a_(a),
        i_(i),
        lane_(threadIdx.x % 32),
        xi_(pairs.position[i]),
        scratch_(scratch) {}

  __device__ void run() {
    const std::uint64_t begin = a_.rowStart[i_], end = a_.rowStart[i_ + 1];
    const auto pressures = static_cast<std::uint32_t>(a_.gradientStart[i_ + 1] - a_.gradientStart[i_]) + 1;
    Block<D> viscous{};  // the own block's part of V
    std::uint64_t ownPlace = begin;
    for (std::uint64_t first = begin; first < end; first += 32) {
      const auto count = static_cast<std::uint32_t>(min(end - first, std::uint64_t{32}));
      const std::uint32_t j = a_.column[first + min(lane_, count - 1)];
      const Vec<D> d = pairs_.grid.difference(xi_, pairs_.position[j]);
      const unsigned own = __ballot_sync(~0u, lane_ < count && j == i_);
      if (own) ownPlace = first + (__ffs(own) - 1);

      const Block<D> pair = viscosity(j, d);
      if (lane_ < count) viscous += pair;
      Block<D> sum{};
      sum -= pair;
      for (std::uint32_t m = 0; m < pressures; m += 32) {
        if (first == begin || pressures > 32) stage(m, pressures);
        addPressures(j, d, min(pressures - m, 32u), sum);
      }
      write(sum, first, count);
    }
    addOwn(viscous, ownPlace);
  }

 private:
  __device__ Block<D> viscosity(std::uint32_t j, const Vec<D>& d) const {
    const double h2 = mph_.viscosityRadius * mph_.viscosityRadius, r2 = norm2(d);
    Block<D> block{};
    if (r2 >= h2 || r2 == 0) return block;
    const double mu = pairs_.viscosityOf(i_, j);
    block.addOuter(mph_.viscous(mu * mph_.viscousFactor, ExactDistance(r2)), d, d);
    return block;
  }

  /// Brings up to 32 pressures of the row from the m-th on into shared memory; i's own is the last.
  __device__ void stage(std::uint32_t m, std::uint32_t pressures) {
    __syncwarp();
    m += lane_;
    if (m < pressures) {
      const bool own = m + 1 == pressures;
      const std::uint64_t place = a_.gradientStart[i_] + m;
      const std::uint32_t k = own ? i_ : a_.pressure[place];
      const double lambda = pairs_.bulkViscosity(k);
      scratch_.k[lane_] = k;
      scratch_.d[lane_] = pairs_.grid.difference(xi_, pairs_.position[k]);
      scratch_.weighted[lane_] = lambda * corrected(k, own ? a_.own[i_] : a_.g[place]);
    }
    __syncwarp();
  }

  /// sum += lambda_k c_ik c_jk^T over the staged pressures; c_jk = g_jk follows from the distance.
  __device__ void addPressures(std::uint32_t j, const Vec<D>& d, std::uint32_t count, Block<D>& sum) const {
    const double h2 = mph_.pressureRadius * mph_.pressureRadius;
    for (std::uint32_t t = 0; t < count; ++t) {
      const Vec<D> toPressure = scratch_.d[t] - d;
      const double r2 = norm2(toPressure);
      const std::uint32_t k = scratch_.k[t];
      if (k == j)
        sum.addOuter(1, scratch_.weighted[t], corrected(k, a_.own[j]));
      else if (r2 < h2 && r2 > 0)
        sum.addOuter(1, scratch_.weighted[t], mph_.gradient(ExactDistance(r2)) * corrected(k, toPressure));
    }
  }

  /// Writes the lanes' blocks, consecutive lanes to consecutive numbers.
  __device__ void write(const Block<D>& sum, std::uint64_t first, std::uint32_t count) {
    __syncwarp();
    for (int e = 0; e < D * D; ++e) scratch_.block[lane_ * Scratch::stride + e] = sum.a[e];
    __syncwarp();
    double* target = a_.block[first].a;
    for (std::uint32_t e = lane_; e < count * (D * D); e += 32)
      target[e] = scratch_.block[e / (D * D) * Scratch::stride + e % (D * D)];
  }

  __device__ void addOwn(const Block<D>& viscous, std::uint64_t place) {
    __syncwarp();
    for (int e = 0; e < D * D; ++e) {
      const double sum = warpSum(viscous.a[e]);
      if (lane_ == 0) a_.block[place].a[e] += sum + a_.ownBlock[i_].a[e];
    }
  }

  __device__ Vec<D> corrected(std::uint32_t k, const Vec<D>& v) const {
    if constexpr (Renormalised) return pairs_.corrected(k, v);
    return v;
  }

  const MphPairs<D>& pairs_;
  const Mph& mph_;
  const Assembly<D>& a_;
  std::uint32_t i_, lane_;
  Vec<D> xi_;
  Scratch& scratch_;
};

}  // namespace treacle
