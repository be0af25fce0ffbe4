#include "library_krylov.hpp"

#include "core/launch.hpp"

#include <utility>

namespace treacle {
namespace {

void setStart(const Context<Cuda>& context, KrylovScalars* scalars, LibraryCoefficients* c) {
  forEach(context, 1, [=] __device__(std::size_t) {
    scalars->start(c->sumOfB, c->sum);
    c->one = 1;
  });
}
void setDirection(const Context<Cuda>& context, KrylovScalars* scalars, LibraryCoefficients* c) {
  forEach(context, 1, [=] __device__(std::size_t) {
    scalars->setDirection(c->sum);
    c->beta = scalars->beta;
  });
}
void setStep(const Context<Cuda>& context, KrylovScalars* scalars, LibraryCoefficients* c) {
  forEach(context, 1, [=] __device__(std::size_t) {
    scalars->setStep(c->sum);
    c->alpha = scalars->alpha;
    c->minusAlpha = -scalars->alpha;
  });
}
void endIteration(const Context<Cuda>& context, KrylovScalars* scalars, LibraryCoefficients* c) {
  forEach(context, 1, [=] __device__(std::size_t) { scalars->endIteration(c->sum); });
}

}  // namespace

void LibraryKrylov::record(const LibraryProduct& a, Preconditioner k, Flat b, std::span<double> x,
                           const StoppingRule& rule) {
  a_ = &a;
  k_ = std::move(k);
  b_ = b;
  x_ = x;
  rule_ = rule;
  for (auto* v : {&r_, &s_, &p_, &q_, &y_}) v->resize(context_, b_.size());
  coefficients_.resize(context_, 1);
  const auto body = [this] { kind_ == KrylovKind::Cg ? iterateCg() : iterateCr(); };
  if (loop_.kind().empty()) {
    start();
    body();
  }
  loop_.record(context_, body);
}

SolveReport LibraryKrylov::solve() {
  start();
  return loop_.run(context_);
}

/// r = b - A x, for CR s = K r, and no direction yet.
void LibraryKrylov::start() {
  scalars_ = loop_.begin(context_, rule_);
  copyBytesOnDevice(context_, b_.data(), r_.data(), b_.size_bytes());
  a_->multiply(-1, x_, 1, r_);
  for (auto* v : {&p_, &q_}) clearBytes(context_, v->data(), b_.size_bytes());
  if (k_ && kind_ == KrylovKind::Cr) k_(r_, s_);
  LibraryCoefficients* c = coefficients_.data();
  blas_.dot(b_, b_, &c->sumOfB);
  blas_.dot(r_, r_, &c->sum);
  setStart(context_, scalars_, c);
}

/// s = K r is carried along; without preconditioner it is r, and u = K q is q.
void LibraryKrylov::iterateCr() {
  LibraryCoefficients* c = coefficients_.data();
  Buffer<double, Cuda>&s = k_ ? s_ : r_, &u = k_ ? y_ : q_;
  a_->multiply(1, s, 0, y_);
  blas_.dot(s, y_, &c->sum);
  setDirection(context_, scalars_, c);
  blas_.scale(&c->beta, p_);
  blas_.axpy(&c->one, s, p_);
  blas_.scale(&c->beta, q_);
  blas_.axpy(&c->one, y_, q_);
  if (k_) k_(q_, u);
  blas_.dot(q_, u, &c->sum);
  setStep(context_, scalars_, c);
  blas_.axpy(&c->alpha, p_, x_);
  blas_.axpy(&c->minusAlpha, q_, r_);
  if (k_) blas_.axpy(&c->minusAlpha, u, s);
  blas_.dot(r_, r_, &c->sum);
  endIteration(context_, scalars_, c);
}

/// Without preconditioner s = K r is r, and r.s is still there from the end of the last iteration.
void LibraryKrylov::iterateCg() {
  LibraryCoefficients* c = coefficients_.data();
  Buffer<double, Cuda>& s = k_ ? s_ : r_;
  if (k_) {
    k_(r_, s);
    blas_.dot(r_, s, &c->sum);
  }
  setDirection(context_, scalars_, c);
  blas_.scale(&c->beta, p_);
  blas_.axpy(&c->one, s, p_);
  a_->multiply(1, p_, 0, q_);
  blas_.dot(p_, q_, &c->sum);
  setStep(context_, scalars_, c);
  blas_.axpy(&c->alpha, p_, x_);
  blas_.axpy(&c->minusAlpha, q_, r_);
  blas_.dot(r_, r_, &c->sum);
  endIteration(context_, scalars_, c);
}

}  // namespace treacle
