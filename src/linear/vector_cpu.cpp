#include "treacle/linear/vector.hpp"

#include "sum_chunks.hpp"
#include "treacle/core/processes.hpp"

#include <algorithm>

namespace treacle {
namespace {

double subtractFromChunk(const double* b, double* r, std::size_t n) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t i = 0; i < n; ++i) {
    r[i] = b[i] - r[i];
    sum += r[i] * r[i];
  }
  return sum;
}

double subtractChunk(double alpha, const double* q, double* r, std::size_t n) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t i = 0; i < n; ++i) {
    r[i] -= alpha * q[i];
    sum += r[i] * r[i];
  }
  return sum;
}

void roundChunk(double* p, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) p[i] = static_cast<float>(p[i]);
}

double ownDot(Context<Cpu>& context, std::span<const double> x, std::span<const double> y) {
  return sumChunks(context, x.size(),
                   [&](std::size_t k, std::size_t n) { return dotChunk(x.data() + k, y.data() + k, n); });
}

double dot(Context<Cpu>& context, std::span<const double> x, std::span<const double> y) {
  return sumOverProcesses(context, ownDot(context, x, y));
}

}  // namespace

void copy(Context<Cpu>&, std::span<const double> from, std::span<double> to) {
  std::copy(from.begin(), from.end(), to.begin());
}

void residual(Context<Cpu>& context, std::span<const double> b, std::span<double> r, KrylovScalars* scalars) {
  const double rr = sumChunks(context, b.size(), [&](std::size_t k, std::size_t n) {
    return subtractFromChunk(b.data() + k, r.data() + k, n);
  });
  double sums[] = {ownDot(context, b, b), rr};
  sumOverProcesses(context, std::span<double>(sums));
  scalars->start(sums[0], sums[1]);
}

void directionDot(Context<Cpu>& context, std::span<const double> x, std::span<const double> y,
                  KrylovScalars* scalars) {
  scalars->setDirection(dot(context, x, y));
}

void stepDot(Context<Cpu>& context, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars) {
  scalars->setStep(dot(context, x, y));
}

void direction(Context<Cpu>& context, std::span<const double> z, std::span<double> p, const KrylovScalars* scalars,
               bool single) {
  const bool first = scalars->iteration == 0;
  if (first && !single) return copy(context, z, p);
  sumChunks(context, z.size(), [&](std::size_t k, std::size_t n) {
    if (first)
      std::copy_n(z.data() + k, n, p.data() + k);
    else
      directionChunk(z.data() + k, scalars->beta, p.data() + k, n);
    if (single) roundChunk(p.data() + k, n);
    return 0.0;
  });
}

void directionsCr(Context<Cpu>& context, const CrDirections& v, const KrylovScalars* scalars) {
  if (scalars->iteration == 0) {
    copy(context, v.s, v.p);
    copy(context, v.y, v.q);
    return;
  }
  sumChunks(context, v.s.size(), [&](std::size_t k, std::size_t n) {
    directionChunk(v.s.data() + k, scalars->beta, v.p.data() + k, n);
    return directionChunk(v.y.data() + k, scalars->beta, v.q.data() + k, n), 0.0;
  });
}

void updateCg(Context<Cpu>& context, const CgVectors& v, KrylovScalars* scalars) {
  const double alpha = scalars->alpha;
  const double rr = sumChunks(context, v.x.size(), [&](std::size_t k, std::size_t n) {
    addChunk(alpha, v.p.data() + k, v.x.data() + k, n);
    return subtractChunk(alpha, v.q.data() + k, v.r.data() + k, n);
  });
  scalars->endIteration(sumOverProcesses(context, rr));
}

void updateCr(Context<Cpu>& context, const CrVectors& v, KrylovScalars* scalars) {
  const double alpha = scalars->alpha;
  const double rr = sumChunks(context, v.x.size(), [&](std::size_t k, std::size_t n) {
    addChunk(alpha, v.p.data() + k, v.x.data() + k, n);
    addChunk(-alpha, v.u.data() + k, v.s.data() + k, n);
    return subtractChunk(alpha, v.q.data() + k, v.r.data() + k, n);
  });
  scalars->endIteration(sumOverProcesses(context, rr));
}

}  // namespace treacle
