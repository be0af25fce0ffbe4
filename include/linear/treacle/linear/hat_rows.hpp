#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/linear/hat_cycle.hpp"

namespace treacle {

// Those operations of hat_cycle.hpp that go row by row, for the sources of both backends, which instantiate all of
// them. Each backend has, beside forEach,
//
//   forEachProduct(context, a, x, store): store(k, number k of A x) for all numbers

template <class T>
struct StoreProduct {
  T* y;
  TREACLE_HD void operator()(std::size_t k, T sum) const { y[k] = sum; }
};

template <class T>
struct StoreResidual {
  const T* from;
  T* res;
  TREACLE_HD void operator()(std::size_t k, T sum) const { res[k] = from[k] - sum; }
};

/// res = from - A z, next z = previous z + gain / hatLambdaMax D^-1 res, x += next z
template <class T>
struct StoreStep {
  ChebyshevStep<T> step;
  const T *inverseDiagonal, *from, *z;
  T *res, *next, *x;

  TREACLE_HD void operator()(std::size_t k, T sum) const {
    const T rest = from[k] - sum;
    const T change = step.previous * z[k] + step.gain / hatLambdaMax * inverseDiagonal[k] * rest;
    res[k] = rest;
    next[k] = change;
    x[k] += change;
  }
};

/// z = x = gain / hatLambdaMax D^-1 b of the first step
template <class T>
struct FirstStep {
  const T* inverseDiagonal;
  T *z, *x;

  explicit FirstStep(const HatVectors<T>& v) : inverseDiagonal(v.inverseDiagonal), z(v.z[0]), x(v.x) {}
  TREACLE_HD void operator()(std::size_t k, T b) const {
    const T change = ChebyshevStep<T>::at(1).gain / hatLambdaMax * inverseDiagonal[k] * b;
    z[k] = change;
    x[k] = change;
  }
};

template <class T, int B, class Backend>
void hatMultiply(Context<Backend>& context, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y) {
  forEachProduct(context, a, x.data(), StoreProduct<T>{y.data()});
}

template <class T, class Backend>
void hatFirstStep(Context<Backend>& context, std::size_t unknowns, const HatVectors<T>& v) {
  const FirstStep<T> step(v);
  const T* const b = v.b;
  forEach(context, unknowns, [=] TREACLE_HD(std::size_t i) { step(i, b[i]); });
}

template <class T, int B, class Backend>
void hatStep(Context<Backend>& context, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last) {
  const T* z = v.z[last];
  forEachProduct(context, a, z, StoreStep<T>{step, v.inverseDiagonal, from, z, v.res, v.z[1 - last], v.x});
}

template <class T, int B, class Backend>
void hatResidual(Context<Backend>& context, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from,
                 int last) {
  forEachProduct(context, a, v.z[last], StoreResidual<T>{from, v.res});
}

#define TREACLE_HAT_CYCLE(T, Backend)                                                    \
  template void hatFirstStep(Context<Backend>&, std::size_t, const HatVectors<T>&);      \
  template void denseMultiply(Context<Backend>&, std::uint32_t, const T*, const T*, T*); \
  TREACLE_HAT_PRODUCTS(T, 1, Backend)                                                    \
  TREACLE_HAT_PRODUCTS(T, 2, Backend)                                                    \
  TREACLE_HAT_PRODUCTS(T, 3, Backend)                                                    \
  TREACLE_HAT_TRANSFERS(2, 1, T, Backend)                                                \
  TREACLE_HAT_TRANSFERS(2, 2, T, Backend)                                                \
  TREACLE_HAT_TRANSFERS(3, 1, T, Backend)                                                \
  TREACLE_HAT_TRANSFERS(3, 3, T, Backend)
#define TREACLE_HAT_PRODUCTS(T, B, Backend)                                                                   \
  template void hatValues(Context<Backend>&, const BlockCsr<B, double, Backend>&, std::span<Block<B, T>>,     \
                          std::span<T>);                                                                      \
  template void hatMultiply(Context<Backend>&, const BlockCsrView<B, T>&, std::span<const T>, std::span<T>);  \
  template void hatStep(Context<Backend>&, const BlockCsrView<B, T>&, ChebyshevStep<T>, const HatVectors<T>&, \
                        const T*, int);                                                                       \
  template void hatResidual(Context<Backend>&, const BlockCsrView<B, T>&, const HatVectors<T>&, const T*, int);
#define TREACLE_HAT_TRANSFERS(D, B, T, Backend)                                                                \
  template void hatRestrict<D, B>(Context<Backend>&, const HatNodes<D, Backend>&, const HatNodes<D, Backend>&, \
                                  const T*, const HatVectors<T>&);                                             \
  template void hatProlong<D, B>(Context<Backend>&, const HatNodes<D, Backend>&, const HatNodes<D, Backend>&,  \
                                 const T*, const HatVectors<T>&);

}  // namespace treacle
