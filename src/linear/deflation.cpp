#include "treacle/linear/deflation.hpp"

namespace treacle {

template <class Backend>
void Deflation<Backend>::deflateBy(std::span<const float> modes, std::size_t n) {
  use_ = modes.empty() ? Use::Nothing : Use::Modes;
  n_ = n;
  modes_ = modes;
}

template <class Backend>
void Deflation<Backend>::recordNumbers(Context<Backend>& context) {
  use_ = Use::Record;
  recorded_ = {};
  scalars_.resize(context, 1);
}

template <class Backend>
void Deflation<Backend>::record(Context<Backend>& context, std::size_t n) {
  recordNumbers(context);
  work_.resize(context, n * DeflationScalars::maxBasis * sizeof(float));
  recorded_ = {reinterpret_cast<float*>(work_.data()), n * DeflationScalars::maxBasis};
}

template <class Backend>
void Deflation<Backend>::prepare(Context<Backend>& context, const Product& a, std::span<double> spare) {
  if (use_ != Use::Modes) return;
  scalars_.resize(context, 1);
  work_.resize(context, modes_.size() * sizeof(double));
  for (int j = 0; j < modeCount(); ++j) {
    widen(context, modes_.subspan(j * n_, n_), spare);
    a(spare, product(j));
    galerkinRow(context, view(), j);
  }
  ModeMatrix inverse;
  if (invert(onHost(context).galerkin, modeCount(), inverse) > 0)
    setInverse(context, inverse, scalars_.data());
  else
    use_ = Use::Nothing;
}

template <class Backend>
void Deflation<Backend>::guess(Context<Backend>& context, std::span<double> x, std::span<double> r,
                               KrylovScalars* krylov) {
  if (use_ == Use::Modes) deflateGuess(context, view(), x, r, krylov);
}

template <class Backend>
void Deflation<Backend>::direction(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                                   std::span<double> p, KrylovScalars* krylov) {
  switch (use_) {
    case Use::Nothing:
      return plainDirection(context, r, z, p, krylov);
    case Use::Modes:
      return deflatedDirection(context, view(), r, z, p, krylov);
    case Use::Record:
      return recordedDirection(context, r, z, p, krylov, scalars_.data(), recorded_);
  }
}

template <class Backend>
RitzVectors Deflation<Backend>::ritzVectors(Context<Backend>& context, int iterations, int most) const {
  return largestRitzVectors(onHost(context), iterations, most, leastValue);
}

template <class Backend>
void Deflation<Backend>::takeModes(Context<Backend>& context, const RitzVectors& ritz, std::span<float> to) {
  combine(context, recorded_, ritz, to);
}

template <class Backend>
DeflationScalars Deflation<Backend>::onHost(const Context<Backend>& context) const {
  if constexpr (std::is_same_v<Backend, Cuda>)
    return valueOnHost(context, scalars_.data());
  else
    return scalars_[0];
}

template <class Backend>
Deflated Deflation<Backend>::view() {
  const std::size_t size = modes_.size();
  return {modes_, {reinterpret_cast<const double*>(work_.data()), size}, modeCount(), scalars_.data()};
}

#define TREACLE_INSTANTIATE(Backend) template class Deflation<Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
