#pragma once

#include "core/reduce_many.cuh"

#include <array>

namespace treacle {

/// The same as on the CPU (each.hpp), by reduceMany: one thread per element, grid-stride.
template <int N, class Add>
std::array<double, N> sumEach(Context<Cuda>& context, std::size_t n, const Add& add) {
  using Sums = std::array<double, N>;
  auto* result = static_cast<double*>(context.scratch(sizeof(Sums)));
  reduceMany<N>(
      context, n, [add] __device__(std::size_t i, double* sums) { add(i, sums); },
      [result] __device__(const double* sums, int lane) {
        if (lane < N) result[lane] = sums[lane];
      });
  return valueOnHost(context, reinterpret_cast<const Sums*>(result));
}

}  // namespace treacle
