#include "library_mgcg.hpp"

namespace treacle {

void LibraryMgcg::setup(const ScalarCsr& a, std::span<const double> inverse,
                        std::span<const Buffer<std::uint32_t, Cuda>> members, int n) {
  byA_.prepare(context_, krylov_.cusparse(), a, algorithm_);
  preconditioned_ = !members.empty();
  if (!preconditioned_) return;
  const CycleSweeps sweeps{.finest = n, .middle = n, .coarsest = 2 * n};
  multigrid_.setup(context_, krylov_.cusparse(), a, LibraryCycle{inverse, members, sweeps}, algorithm_);
}

void LibraryMgcg::record(std::span<const double> b, std::span<double> x, const StoppingRule& rule) {
  LibraryKrylov::Preconditioner k;
  if (preconditioned_) k = [this](std::span<const double> r, std::span<double> z) { multigrid_.apply(r, z); };
  krylov_.record(byA_, std::move(k), b, x, rule);
}

}  // namespace treacle
