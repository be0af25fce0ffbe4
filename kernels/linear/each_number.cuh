#pragma once

#include "core/reduce.cuh"

namespace treacle {

// As each_number.hpp takes them.

template <class S, class Body>
void forEachNumber(const Context<Cuda>& context, std::size_t n, const S* scalars, Body body) {
  forEach(context, n, [=] __device__(std::size_t i) { body(i, *scalars); });
}

template <class S, class Body, class Finish>
void reduceNumbers(Context<Cuda>& context, std::size_t n, S* scalars, Body body, Finish finish) {
  reduce(
      context, n, [=] __device__(std::size_t i) { return body(i, *scalars); },
      [=] __device__(double sum) { finish(sum, *scalars); });
}
template <class S, class Body, class Finish>
void reduceInOrder(Context<Cuda>& context, std::size_t n, S* scalars, Body body, Finish finish) {
  reduceNumbers(context, n, scalars, body, finish);
}

/// One thread per component, so that consecutive threads read consecutive numbers.
template <int D, class Body>
void forEachComponent(const Context<Cuda>& context, std::size_t n, Body body) {
  forEach(context, D * n, [=] __device__(std::size_t e) { body(e / D, static_cast<int>(e % D)); });
}

}  // namespace treacle
