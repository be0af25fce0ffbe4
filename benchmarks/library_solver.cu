#include "library_solver.hpp"

#include "core/launch.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/search/cell_grid.hpp"

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

std::string CusparseHandle::version() const {
  int number = 0;
  TREACLE_CUSPARSE_CHECK(cusparseGetVersion(handle_, &number));
  return std::to_string(number / 1000) + "." + std::to_string(number / 100 % 10) + "." +
         std::to_string(number % 100);
}

template <int D>
void LibrarySolver<D>::setup(const MphPairs<D>& pairs, const WallTerms<D>& terms, const ScalarCsr& a,
                             std::span<const std::uint64_t> key) {
  byA_.prepare(context_, cusparse_, a, algorithm_);
  if (method_ == LibraryMethod::Cr) return;
  diagonal_.resize(context_, pairs.fluidCount);
  diagonalBlocks<D>(context_, pairs, terms, diagonal_);
  if (method_ == LibraryMethod::BlockJacobiCg) {
    blockInverse_.resize(context_, pairs.fluidCount);
    blockInverse<D, double>(context_, diagonal_, blockInverse_);
    return;
  }
  inverse_.resize(context_, pairs.fluidCount);
  jacobiInverse<D, double>(context_, diagonal_, inverse_);
  findBuckets(context_, key, D * CellGrid<D>::subBits, D, buckets_);
  multigrid_.setup(context_, cusparse_, a, {inverse_.data()->v, inverse_.size() * D}, buckets_, algorithm_);
}

template <int D>
void LibrarySolver<D>::record(std::span<const Vec<D>> b, std::span<Vec<D>> u, const StoppingRule& rule) {
  b_ = {b.data()->v, b.size() * D};
  x_ = {u.data()->v, u.size() * D};
  rule_ = rule;
  for (auto* v : {&r_, &s_, &p_, &q_, &y_}) v->resize(context_, b_.size());
  coefficients_.resize(context_, 1);
  const auto body = [this] { method_ == LibraryMethod::BlockJacobiCg ? iterateCg() : iterateCr(); };
  if (loop_.kind().empty()) {
    start();
    body();
  }
  loop_.record(context_, body);
}

template <int D>
SolveReport LibrarySolver<D>::solve() {
  start();
  return loop_.run(context_);
}

/// r = b - A x, s = K r, and no direction yet.
template <int D>
void LibrarySolver<D>::start() {
  scalars_ = loop_.begin(context_, rule_);
  copyBytesOnDevice(context_, b_.data(), r_.data(), b_.size_bytes());
  byA_.multiply(-1, x_, 1, r_);
  for (auto* v : {&p_, &q_}) clearBytes(context_, v->data(), b_.size_bytes());
  if (method_ == LibraryMethod::MultigridCr) applyPreconditioner(r_, s_);
  LibraryCoefficients* c = coefficients_.data();
  blas_.dot(b_, b_, &c->sumOfB);
  blas_.dot(r_, r_, &c->sum);
  setStart(context_, scalars_, c);
}

/// s = K r is carried along; without preconditioner it is r, and u = K q is q.
template <int D>
void LibrarySolver<D>::iterateCr() {
  LibraryCoefficients* c = coefficients_.data();
  const bool plain = method_ == LibraryMethod::Cr;
  Buffer<double, Cuda>&s = plain ? r_ : s_, &u = plain ? q_ : y_;
  byA_.multiply(1, s, 0, y_);
  blas_.dot(s, y_, &c->sum);
  setDirection(context_, scalars_, c);
  blas_.scale(&c->beta, p_);
  blas_.axpy(&c->one, s, p_);
  blas_.scale(&c->beta, q_);
  blas_.axpy(&c->one, y_, q_);
  if (!plain) applyPreconditioner(q_, u);
  blas_.dot(q_, u, &c->sum);
  setStep(context_, scalars_, c);
  blas_.axpy(&c->alpha, p_, x_);
  blas_.axpy(&c->minusAlpha, q_, r_);
  if (!plain) blas_.axpy(&c->minusAlpha, u, s);
  blas_.dot(r_, r_, &c->sum);
  endIteration(context_, scalars_, c);
}

template <int D>
void LibrarySolver<D>::iterateCg() {
  LibraryCoefficients* c = coefficients_.data();
  applyPreconditioner(r_, s_);
  blas_.dot(r_, s_, &c->sum);
  setDirection(context_, scalars_, c);
  blas_.scale(&c->beta, p_);
  blas_.axpy(&c->one, s_, p_);
  byA_.multiply(1, p_, 0, q_);
  blas_.dot(p_, q_, &c->sum);
  setStep(context_, scalars_, c);
  blas_.axpy(&c->alpha, p_, x_);
  blas_.axpy(&c->minusAlpha, q_, r_);
  blas_.dot(r_, r_, &c->sum);
  endIteration(context_, scalars_, c);
}

template <int D>
void LibrarySolver<D>::applyPreconditioner(Flat r, std::span<double> z) {
  if (method_ == LibraryMethod::MultigridCr) return multigrid_.apply(r, z);
  using Vectors = std::span<const Vec<D>>;
  applyBlockDiagonal<D, double>(context_, blockInverse_,
                                Vectors(reinterpret_cast<const Vec<D>*>(r.data()), r.size() / D),
                                std::span<Vec<D>>(reinterpret_cast<Vec<D>*>(z.data()), z.size() / D));
}

template class LibrarySolver<2>;
template class LibrarySolver<3>;

}  // namespace treacle
