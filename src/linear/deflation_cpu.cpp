#include "treacle/linear/deflation.hpp"

#include "sum_chunks.hpp"
#include "treacle/linear/vector.hpp"

#include <algorithm>
#include <vector>

namespace treacle {
namespace {

/// sums[j] = column j times y, chunk by chunk, so that y is read once.
template <class T>
void products(Context<Cpu>& context, const T* columns, int count, std::span<const double> y, double* sums) {
  const std::size_t n = y.size(), chunks = (n + reductionChunk - 1) / reductionChunk;
  std::vector<double>& partial = context.partialSums;
  partial.resize(chunks * count);
  forChunks(n, [&](std::size_t k, std::size_t length) {
    for (int j = 0; j < count; ++j)
      partial[k / reductionChunk * count + j] = dotChunk(columns + j * n + k, y.data() + k, length);
  });
  std::fill_n(sums, count, 0.0);
  for (std::size_t c = 0; c < chunks; ++c)
    for (int j = 0; j < count; ++j) sums[j] += partial[c * count + j];
  sumOverProcesses(context, std::span(sums, count));
}

template <class T>
void setWeights(Context<Cpu>& context, const Deflated& d, const T* columns, std::span<const double> y) {
  double sums[DeflationScalars::maxModes];
  products(context, columns, d.modes, y, sums);
  for (int j = 0; j < d.modes; ++j) d.scalars->setWeight(j, sums, d.modes);
}

}  // namespace

void galerkinRow(Context<Cpu>& context, const Deflated& d, int j) {
  const std::size_t n = d.w.size() / d.modes;
  products(context, d.w.data(), d.modes, d.aw.subspan(j * n, n), &d.scalars->galerkin(j, 0));
}

void deflateGuess(Context<Cpu>& context, const Deflated& d, std::span<double> x, std::span<double> r,
                  KrylovScalars* krylov) {
  setWeights(context, d, d.w.data(), r);
  const std::size_t n = x.size();
  const double rr = sumChunks(context, n, [&](std::size_t k, std::size_t length) {
    for (int j = 0; j < d.modes; ++j) {
      const double c = d.scalars->weight[j];
      addChunk(c, d.w.data() + j * n + k, x.data() + k, length);
      addChunk(-c, d.aw.data() + j * n + k, r.data() + k, length);
    }
    return dotChunk(r.data() + k, r.data() + k, length);
  });
  krylov->start(krylov->bb, sumOverProcesses(context, rr));
}

void deflatedDirection(Context<Cpu>& context, const Deflated& d, std::span<const double> r,
                       std::span<const double> z, std::span<double> p, KrylovScalars* krylov) {
  directionDot(context, r, z, krylov);
  setWeights(context, d, d.aw.data(), z);
  const std::size_t n = z.size();
  const bool first = krylov->iteration == 0;
  forChunks(n, [&](std::size_t k, std::size_t length) {
    if (first)
      std::copy_n(z.data() + k, length, p.data() + k);
    else
      directionChunk(z.data() + k, krylov->beta, p.data() + k, length);
    for (int j = 0; j < d.modes; ++j)
      addChunk(-d.scalars->weight[j], d.w.data() + j * n + k, p.data() + k, length);
  });
}

void combine(Context<Cpu>&, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w) {
  if (ritz.modes == 0) return;
  const std::size_t n = w.size() / ritz.modes;
  forChunks(n, [&](std::size_t k, std::size_t length) {
    for (int j = 0; j < ritz.modes; ++j) {
      float* mode = w.data() + j * n + k;
      std::fill_n(mode, length, 0.0f);
      for (int i = 0; i < ritz.rows; ++i) addChunk(ritz.coefficient[j][i], basis.data() + i * n + k, mode, length);
    }
  });
}

}  // namespace treacle
