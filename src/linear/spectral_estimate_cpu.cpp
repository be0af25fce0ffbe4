#include "treacle/linear/spectral_estimate.hpp"

#include "sum_chunks.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/core/processes.hpp"

#include <cmath>
#include <limits>

namespace treacle {

template <class T>
void lanczosStart(Context<Cpu>& context, const LanczosVectors<T>& v) {
  const double rho = sumChunks(context, v.r.size(), [&](std::size_t begin, std::size_t n) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + n; ++i) {
      const T inverse = v.inverseDiagonal[i];
      const auto index = static_cast<std::uint32_t>(i);
      const auto seed = context.halo ? static_cast<std::uint32_t>(context.halo->indexOfAll(index)) : index;
      v.r[i] = inverse > 0 ? pseudoRandom(seed) * std::sqrt(1 / inverse) : T(0);
      v.p[i] = inverse * v.r[i];
      sum += double(v.r[i]) * double(v.p[i]);
    }
    return sum;
  });
  if (context.halo) std::fill(v.q.begin(), v.q.end(), T(0));  // products do not set that of ghosts
  v.scalars->start(sumOverProcesses(context, rho), std::numeric_limits<T>::epsilon());
}

template <class T>
void lanczosStep(Context<Cpu>& context, const LanczosVectors<T>& v) {
  const double sigma = sumChunks(context, v.p.size(), [&](std::size_t begin, std::size_t n) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + n; ++i) sum += double(v.p[i]) * double(v.q[i]);
    return sum;
  });
  v.scalars->setStep(sumOverProcesses(context, sigma));
}

template <class T>
void lanczosDirection(Context<Cpu>& context, const LanczosVectors<T>& v) {
  const T alpha = static_cast<T>(v.scalars->alpha);
  const double rho = sumChunks(context, v.r.size(), [&](std::size_t begin, std::size_t n) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + n; ++i) {
      v.r[i] -= alpha * v.q[i];
      sum += double(v.r[i]) * double(v.r[i]) * double(v.inverseDiagonal[i]);
    }
    return sum;
  });
  v.scalars->setDirection(sumOverProcesses(context, rho));
  const T beta = static_cast<T>(v.scalars->beta);
  parallelFor(v.p.size(), parallelGrain,
              [&](std::size_t i) { v.p[i] = v.inverseDiagonal[i] * v.r[i] + beta * v.p[i]; });
}

template <class T>
void lanczosFinish(Context<Cpu>&, const LanczosScalars* scalars, double margin, T* largest) {
  if (scalars->count == 0) {
    *largest = 1;
    return;
  }
  double lower, upper;
  scalars->bounds(lower, upper);
  for (int halving = 0; halving < 45; ++halving) {
    const double middle = (lower + upper) / 2;
    (scalars->reaches(middle) ? lower : upper) = middle;
  }
  *largest = static_cast<T>(margin * upper);
}

template <class T>
void setNumber(Context<Cpu>&, T value, T* to) {
  *to = value;
}

#define TREACLE_INSTANTIATE(T)                                                      \
  template void lanczosStart<T>(Context<Cpu>&, const LanczosVectors<T>&);           \
  template void lanczosStep<T>(Context<Cpu>&, const LanczosVectors<T>&);            \
  template void lanczosDirection<T>(Context<Cpu>&, const LanczosVectors<T>&);       \
  template void lanczosFinish<T>(Context<Cpu>&, const LanczosScalars*, double, T*); \
  template void setNumber<T>(Context<Cpu>&, T, T*);
TREACLE_INSTANTIATE(double)
TREACLE_INSTANTIATE(float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
