#include "core/reduce.cuh"
#include "treacle/linear/vector.hpp"

namespace treacle {

void copy(Context<Cuda>& context, std::span<const double> from, std::span<double> to) {
  copyBytesOnDevice(context, from.data(), to.data(), from.size_bytes());
}

void residual(Context<Cuda>& context, std::span<const double> b, std::span<double> r, KrylovScalars* scalars) {
  const double* pb = b.data();
  double* pr = r.data();
  reduce(
      context, b.size(), [=] __device__(std::size_t i) { return pb[i] * pb[i]; },
      [=] __device__(double bb) { scalars->bb = bb; });
  reduce(
      context, b.size(),
      [=] __device__(std::size_t i) {
        const double ri = pb[i] - pr[i];
        pr[i] = ri;
        return ri * ri;
      },
      [=] __device__(double rr) { scalars->start(scalars->bb, rr); });
}

void directionDot(Context<Cuda>& context, std::span<const double> x, std::span<const double> y,
                  KrylovScalars* scalars) {
  const double *px = x.data(), *py = y.data();
  reduce(
      context, x.size(), [=] __device__(std::size_t i) { return px[i] * py[i]; },
      [=] __device__(double sum) { scalars->setDirection(sum); });
}

void stepDot(Context<Cuda>& context, std::span<const double> x, std::span<const double> y,
             KrylovScalars* scalars) {
  const double *px = x.data(), *py = y.data();
  reduce(
      context, x.size(), [=] __device__(std::size_t i) { return px[i] * py[i]; },
      [=] __device__(double sum) { scalars->setStep(sum); });
}

void direction(Context<Cuda>& context, std::span<const double> z, std::span<double> p,
               const KrylovScalars* scalars, bool single) {
  const double* pz = z.data();
  double* pp = p.data();
  forEach(context, z.size(), [=] __device__(std::size_t i) {
    const double next = scalars->iteration == 0 ? pz[i] : pz[i] + scalars->beta * pp[i];
    pp[i] = single ? static_cast<double>(static_cast<float>(next)) : next;
  });
}

void directionsCr(Context<Cuda>& context, const CrDirections& v, const KrylovScalars* scalars) {
  const double *s = v.s.data(), *y = v.y.data();
  double *p = v.p.data(), *q = v.q.data();
  forEach(context, v.s.size(), [=] __device__(std::size_t i) {
    const bool first = scalars->iteration == 0;
    const double beta = scalars->beta;
    p[i] = first ? s[i] : s[i] + beta * p[i];
    q[i] = first ? y[i] : y[i] + beta * q[i];
  });
}

void updateCg(Context<Cuda>& context, const CgVectors& v, KrylovScalars* scalars) {
  const double *p = v.p.data(), *q = v.q.data();
  double *x = v.x.data(), *r = v.r.data();
  reduce(
      context, v.x.size(),
      [=] __device__(std::size_t i) {
        const double alpha = scalars->alpha;
        x[i] += alpha * p[i];
        const double ri = r[i] - alpha * q[i];
        r[i] = ri;
        return ri * ri;
      },
      [=] __device__(double rr) { scalars->endIteration(rr); });
}

void updateCr(Context<Cuda>& context, const CrVectors& v, KrylovScalars* scalars) {
  const double *p = v.p.data(), *q = v.q.data(), *u = v.u.data();
  double *x = v.x.data(), *r = v.r.data(), *s = v.s.data();
  reduce(
      context, v.x.size(),
      [=] __device__(std::size_t i) {
        const double alpha = scalars->alpha;
        x[i] += alpha * p[i];
        s[i] -= alpha * u[i];
        const double ri = r[i] - alpha * q[i];
        r[i] = ri;
        return ri * ri;
      },
      [=] __device__(double rr) { scalars->endIteration(rr); });
}

}  // namespace treacle
