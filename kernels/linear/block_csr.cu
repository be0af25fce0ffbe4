#include "linear/row_sums.cuh"

namespace treacle {
namespace {

template <class T>
struct Magnitude {
  __device__ T operator()(T value, const std::uint32_t*, int) const { return abs(value); }
};

template <int D, class T>
struct StoreSum {
  Vec<D, T>* y;
  __device__ void operator()(std::size_t row, int r, T sum) const { y[row][r] = sum; }
};

template <int D, class T, class S>
struct StoreInverse {
  Vec<D, S>* inverse;
  __device__ void operator()(std::size_t row, int r, T sum) const {
    inverse[row][r] = sum == 0 ? S(0) : static_cast<S>(2 / sum);
  }
};

}  // namespace

template <int D, class T, class Backend>
void multiply(Context<Backend>& context, const BlockCsr<D, T, Backend>& a, std::span<const Vec<D, T>> x,
              std::span<Vec<D, T>> y) {
  rowSums<Reading::Streamed>(context, viewOf(a), ProductWith<D, T>{x.data()}, StoreSum<D, T>{y.data()});
}

template <int D, class T, class S, class Backend>
void extendedJacobiInverse(Context<Backend>& context, const BlockCsr<D, T, Backend>& a,
                           std::span<Vec<D, S>> inverse) {
  rowSums<Reading::Streamed>(context, viewOf(a), Magnitude<T>{}, StoreInverse<D, T, S>{inverse.data()});
}

TREACLE_BLOCK_CSR(1, Cuda)
TREACLE_BLOCK_CSR(2, Cuda)
TREACLE_BLOCK_CSR(3, Cuda)

}  // namespace treacle
