#include "treacle/linear/spectral_estimate.hpp"

#include "core/reduce.cuh"
#include "treacle/core/halo.hpp"

#include <limits>

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

template <class T>
void lanczosStart(Context<Cuda>& context, const LanczosVectors<T>& v) {
  const T* inverseDiagonal = v.inverseDiagonal.data();
  T *r = v.r.data(), *p = v.p.data();
  // Alone, all particles are the own ones.
  const HaloCounts counts =
      context.halo ? *context.halo : HaloCounts{.fluid = static_cast<std::uint32_t>(v.r.size())};
  reduce(
      context, v.r.size(),
      [=] __device__(std::size_t i) {
        const T inverse = inverseDiagonal[i];
        const auto seed = static_cast<std::uint32_t>(counts.indexOfAll(static_cast<std::uint32_t>(i)));
        const T ri = inverse > 0 ? pseudoRandom(seed) * std::sqrt(1 / inverse) : T(0);
        r[i] = ri;
        const T pi = inverse * ri;
        p[i] = pi;
        return double(ri) * double(pi);
      },
      [s = v.scalars] __device__(double rho) {
        constexpr double epsilon = std::numeric_limits<T>::epsilon();
        s->start(rho, epsilon);
      });
}

template <class T>
void lanczosStep(Context<Cuda>& context, const LanczosVectors<T>& v) {
  const T *p = v.p.data(), *q = v.q.data();
  reduce(
      context, v.p.size(), [=] __device__(std::size_t i) { return double(p[i]) * double(q[i]); },
      [s = v.scalars] __device__(double sigma) { s->setStep(sigma); });
}

template <class T>
void lanczosDirection(Context<Cuda>& context, const LanczosVectors<T>& v) {
  const T *inverseDiagonal = v.inverseDiagonal.data(), *q = v.q.data();
  T *r = v.r.data(), *p = v.p.data();
  LanczosScalars* s = v.scalars;
  reduce(
      context, v.r.size(),
      [=] __device__(std::size_t i) {
        const T ri = r[i] - static_cast<T>(s->alpha) * q[i];
        r[i] = ri;
        return double(ri) * double(ri) * double(inverseDiagonal[i]);
      },
      [=] __device__(double rho) { s->setDirection(rho); });
  forEach(context, v.p.size(),
          [=] __device__(std::size_t i) { p[i] = inverseDiagonal[i] * r[i] + static_cast<T>(s->beta) * p[i]; });
}

template <class T>
void lanczosFinish(Context<Cuda>& context, const LanczosScalars* scalars, double margin, T* largest) {
  launch(context, 1, 32, 0, largestKernel<T>, scalars, margin, largest);
}

template <class T>
void setNumber(Context<Cuda>& context, T value, T* to) {
  forEach(context, 1, [=] __device__(std::size_t) { *to = value; });
}

#define TREACLE_INSTANTIATE(T)                                                       \
  template void lanczosStart<T>(Context<Cuda>&, const LanczosVectors<T>&);           \
  template void lanczosStep<T>(Context<Cuda>&, const LanczosVectors<T>&);            \
  template void lanczosDirection<T>(Context<Cuda>&, const LanczosVectors<T>&);       \
  template void lanczosFinish<T>(Context<Cuda>&, const LanczosScalars*, double, T*); \
  template void setNumber<T>(Context<Cuda>&, T, T*);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
