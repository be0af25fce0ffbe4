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

template <int D, class T>
void multiply(Context<Cuda>& context, const BlockCsr<D, T, Cuda>& a, std::span<const Vec<D, T>> x,
              std::span<Vec<D, T>> y) {
  rowSums<Reading::Streamed>(context, viewOf(a), ProductWith<D, T>{x.data()}, StoreSum<D, T>{y.data()});
}

template <int D, class T, class S>
void extendedJacobiInverse(Context<Cuda>& context, const BlockCsr<D, T, Cuda>& a, std::span<Vec<D, S>> inverse) {
  rowSums<Reading::Streamed>(context, viewOf(a), Magnitude<T>{}, StoreInverse<D, T, S>{inverse.data()});
}

#define TREACLE_INSTANTIATE(D, T)                                                                       \
  template void multiply<D, T>(Context<Cuda>&, const BlockCsr<D, T, Cuda>&, std::span<const Vec<D, T>>, \
                               std::span<Vec<D, T>>);                                                   \
  template void extendedJacobiInverse<D, T, T>(Context<Cuda>&, const BlockCsr<D, T, Cuda>&, std::span<Vec<D, T>>);
TREACLE_INSTANTIATE(1, double)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(1, float)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE
template void extendedJacobiInverse<1, double, float>(Context<Cuda>&, const BlockCsr<1, double, Cuda>&,
                                                      std::span<Vec<1, float>>);
template void extendedJacobiInverse<2, double, float>(Context<Cuda>&, const BlockCsr<2, double, Cuda>&,
                                                      std::span<Vec<2, float>>);
template void extendedJacobiInverse<3, double, float>(Context<Cuda>&, const BlockCsr<3, double, Cuda>&,
                                                      std::span<Vec<3, float>>);

}  // namespace treacle
