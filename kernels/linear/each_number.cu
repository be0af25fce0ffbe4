#include "core/scan.hpp"
#include "linear/each_number.cuh"
#include "treacle/linear/each_number.hpp"
#include "treacle/linear/each_row.hpp"

namespace treacle {
namespace {

/// One warp: the largest eigenvalue of the tridiagonal matrix, whose bounds each round brings 33 times closer to
/// each other, every lane testing one value between them. Reads the scalars; writes one number. No atomics.
template <class T>
__global__ void largestKernel(const LanczosScalars* scalars, double margin, T* largest) {
  if (scalars->count == 0) {
    if (threadIdx.x == 0) *largest = 1;
    return;
  }
  double lower, upper;
  scalars->bounds(lower, upper);
  for (int round = 0; round < 9; ++round) {
    const double part = (upper - lower) / 33;
    const unsigned reached = __ballot_sync(~0u, scalars->reaches(lower + (threadIdx.x + 1) * part));
    const int below = __popc(reached);  // the values reached are the lowest ones
    if (below < 32) upper = lower + (below + 1) * part;
    lower += below * part;
  }
  if (threadIdx.x == 0) *largest = static_cast<T>(margin * upper);
}

}  // namespace

template <class T, class Backend>
void lanczosFinish(Context<Backend>& context, const LanczosScalars* scalars, double margin, T* largest) {
  launch(context, 1, 32, 0, largestKernel<T>, scalars, margin, largest);
}

template <int D, class T, class Backend>
void applyBlockDiagonal(Context<Backend>& context, std::span<const Block<D, T>> inverse, std::span<const Vec<D>> r,
                        std::span<Vec<D>> z) {
  forEachComponent<D>(context, r.size(), [=] __device__(std::size_t i, int row) {
    T sum = 0;
    for (int c = 0; c < D; ++c) sum += inverse[i](row, c) * static_cast<T>(r[i][c]);
    z[i][row] = sum;
  });
}

TREACLE_EACH_NUMBER(Cuda)
TREACLE_EACH_ROW(Cuda)

}  // namespace treacle
