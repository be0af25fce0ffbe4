#include "library_solver.hpp"

#include "treacle/linear/diagonal.hpp"
#include "treacle/search/cell_grid.hpp"

namespace treacle {

template <int D>
void LibrarySolver<D>::setup(const MphPairs<D>& pairs, const WallTerms<D>& terms, const ScalarCsr& a,
                             std::span<const std::uint64_t> key) {
  byA_.prepare(context_, krylov_.cusparse(), a, algorithm_);
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
  const std::span<const double> inverse(inverse_.data()->v, inverse_.size() * D);
  multigrid_.setup(context_, krylov_.cusparse(), a, LibraryCycle{inverse, buckets_.begin, CycleSweeps{}},
                   algorithm_);
}

template <int D>
void LibrarySolver<D>::record(std::span<const Vec<D>> b, std::span<Vec<D>> u, const StoppingRule& rule) {
  const std::span<const double> flatB(b.data()->v, b.size() * D);
  const std::span<double> flatU(u.data()->v, u.size() * D);
  krylov_.record(byA_, preconditioner(), flatB, flatU, rule);
}

template <int D>
LibraryKrylov::Preconditioner LibrarySolver<D>::preconditioner() {
  using Flat = std::span<const double>;
  if (method_ == LibraryMethod::Cr) return {};
  if (method_ == LibraryMethod::MultigridCr)
    return [this](Flat r, std::span<double> z) { multigrid_.apply(r, z); };
  return [this](Flat r, std::span<double> z) {
    using Vectors = std::span<const Vec<D>>;
    applyBlockDiagonal<D, double>(context_, blockInverse_,
                                  Vectors(reinterpret_cast<const Vec<D>*>(r.data()), r.size() / D),
                                  std::span<Vec<D>>(reinterpret_cast<Vec<D>*>(z.data()), z.size() / D));
  };
}

template class LibrarySolver<2>;
template class LibrarySolver<3>;

}  // namespace treacle
