#include "treacle/linear/deflation.hpp"

#include "core/reduce_many.cuh"

namespace treacle {
namespace {

/// One thread per element; reads y and `count` columns; at the end finish(products, lane). One atomic per block.
template <int Most, class T, class Finish>
void productsOf(Context<Cuda>& context, const T* columns, int count, std::span<const double> y, Finish finish) {
  const double* py = y.data();
  const std::size_t n = y.size();
  reduceMany<Most>(
      context, n,
      [=] __device__(std::size_t i, double* sums) {
        const double yi = py[i];
#pragma unroll
        for (int j = 0; j < Most; ++j)
          if (j < count) sums[j] += double(columns[j * n + i]) * yi;
      },
      finish);
}

/// Sums are compiled for three numbers of modes.
template <class T, class Finish>
void products(Context<Cuda>& context, const T* columns, int count, std::span<const double> y, Finish finish) {
  if (count <= 4) return productsOf<4>(context, columns, count, y, finish);
  if (count <= 8) return productsOf<8>(context, columns, count, y, finish);
  productsOf<DeflationScalars::maxModes>(context, columns, count, y, finish);
}

/// One thread per element; reads r, z and A W, leaves beta and c. One atomic per block.
template <int Most>
void directionProducts(Context<Cuda>& context, const Deflated& d, std::span<const double> r,
                       std::span<const double> z, KrylovScalars* krylov) {
  const std::size_t n = z.size();
  const double *pr = r.data(), *pz = z.data(), *aw = d.aw.data();
  const int modes = d.modes;
  reduceMany<Most + 1>(
      context, n,
      [=] __device__(std::size_t i, double* sums) {
        const double zi = pz[i];
        sums[Most] += pr[i] * zi;
#pragma unroll
        for (int j = 0; j < Most; ++j)
          if (j < modes) sums[j] += aw[j * n + i] * zi;
      },
      [=, s = d.scalars] __device__(const double* sums, int lane) {
        if (lane < modes) s->setWeight(lane, sums, modes);
        if (lane == 0) krylov->setDirection(sums[Most]);
      });
}

}  // namespace

void galerkinRow(Context<Cuda>& context, const Deflated& d, int j) {
  const std::size_t n = d.w.size() / d.modes;
  products(context, d.w.data(), d.modes, d.aw.subspan(j * n, n),
           [j, modes = d.modes, s = d.scalars] __device__(const double* sums, int lane) {
             if (lane < modes) s->galerkin(j, lane) = sums[lane];
           });
}

/// Two kernels, one thread per element in each: the first reads W and r and leaves c, the second reads W, A W and
/// updates x and r. One atomic per block.
void deflateGuess(Context<Cuda>& context, const Deflated& d, std::span<double> x, std::span<double> r,
                  KrylovScalars* krylov) {
  DeflationScalars* s = d.scalars;
  const int modes = d.modes;
  products(context, d.w.data(), modes, r, [=] __device__(const double* sums, int lane) {
    if (lane < modes) s->setWeight(lane, sums, modes);
  });
  const std::size_t n = x.size();
  const float* w = d.w.data();
  const double* aw = d.aw.data();
  double *px = x.data(), *pr = r.data();
  reduce(
      context, n,
      [=] __device__(std::size_t i) {
        double xi = px[i], ri = pr[i];
        for (int j = 0; j < modes; ++j) {
          const double c = s->weight[j];
          xi += c * double(w[j * n + i]);
          ri -= c * aw[j * n + i];
        }
        px[i] = xi;
        pr[i] = ri;
        return ri * ri;
      },
      [=] __device__(double rr) { krylov->start(krylov->bb, rr); });
}

/// After directionProducts: one thread per element; reads z and W, updates p; no atomics.
void deflatedDirection(Context<Cuda>& context, const Deflated& d, std::span<const double> r,
                       std::span<const double> z, std::span<double> p, KrylovScalars* krylov) {
  const auto products = d.modes <= 4   ? directionProducts<4>
                        : d.modes <= 8 ? directionProducts<8>
                                       : directionProducts<DeflationScalars::maxModes>;
  products(context, d, r, z, krylov);
  const double* pz = z.data();
  const float* w = d.w.data();
  double* pp = p.data();
  forEach(context, z.size(), [=, n = z.size(), modes = d.modes, s = d.scalars] __device__(std::size_t i) {
    double pi = krylov->iteration == 0 ? pz[i] : pz[i] + krylov->beta * pp[i];
    for (int j = 0; j < modes; ++j) pi -= s->weight[j] * double(w[j * n + i]);
    pp[i] = pi;
  });
}

/// One thread per element; reads the basis, writes its element of each mode; no atomics.
void combine(Context<Cuda>& context, std::span<const float> basis, const RitzVectors& ritz, std::span<float> w) {
  if (ritz.modes == 0) return;
  Buffer<RitzVectors, Cuda> onDevice(context, 1);
  copyBytesToDevice(context, &ritz, onDevice.data(), sizeof(ritz));
  const RitzVectors* from = onDevice.data();
  const std::size_t n = w.size() / ritz.modes;
  forEach(context, n, [=, v = basis.data(), w = w.data()] __device__(std::size_t i) {
    for (int j = 0; j < from->modes; ++j) {
      float sum = 0;
      for (int k = 0; k < from->rows; ++k)
        sum += static_cast<float>(from->coefficient[j][k] * double(v[k * n + i]));
      w[j * n + i] = sum;
    }
  });
}

}  // namespace treacle
