#include "treacle/linear/bucket_multigrid.hpp"

#include "treacle/core/copy_values.hpp"
#include "treacle/core/device_link.hpp"
#include "treacle/linear/hat_cycle.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace treacle {
namespace {

/// Unit vectors that go through the cycle at a time, when it is turned into a matrix.
constexpr std::uint32_t unitsAtATime = 256;

template <class Backend>
std::uint32_t numberAt([[maybe_unused]] const Context<Backend>& context, const std::uint32_t* place) {
  if constexpr (std::is_same_v<Backend, Cpu>)
    return *place;
  else
    return valueOnHost(context, place);
}

}  // namespace

template <int D, class T, class Backend>
BucketLevel<D, T> BucketMultigrid<D, T, Backend>::view(std::size_t r) const {
  const Level& l = levels_[r];
  return {viewOf(l.a), l.inverseDiagonal.data(), l.members.data(), l.parent.data()};
}

template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::setup(Context<Backend>& context, const BlockCsr<D, double, Backend>& finest,
                                           std::vector<std::span<const std::uint32_t>> members,
                                           const CycleSweeps& sweeps, Spgemm* spgemm) {
  levels_.resize(members.size());
  for (std::size_t r = 0; r < levels_.size(); ++r) {
    Level& level = levels_[r];
    level.members = members[r];
    const bool coarsest = r + 1 == levels_.size();
    level.sweeps = coarsest ? sweeps.coarsest : r == 0 ? sweeps.finest : sweeps.middle;
    const std::uint32_t count = r == 0 ? numberAt(context, &members[0].back()) : levels_[r - 1].a.rows();
    level.parent.resize(context, count);
    findParents(context, members[r], level.parent);
    buildMatrix(context, r, finest, spgemm);
    level.inverseDiagonal.resize(context, level.a.rows());
    extendedJacobiInverse<D, T, T>(context, level.a, level.inverseDiagonal);
  }
  buildDense(context);
  for (std::size_t r = 0; r < levels_.size(); ++r) resizeVectors(context, r, 1);
}

/// On a device operators are formed in double precision, then rounded.
template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::buildMatrix(Context<Backend>& context, std::size_t r,
                                                 const BlockCsr<D, double, Backend>& finest,
                                                 [[maybe_unused]] Spgemm* spgemm) {
  Level& level = levels_[r];
  if (r == 0) return convert<D, T>(context, finest, level.a);
  if constexpr (onDevice) {
    const BlockCsr<D, double, Backend>& finer = r == 1 ? finest : levels_[r - 1].galerkin;
    if (spgemm)
      spgemm->compute(context, finer, level.members, level.galerkin);
    else
      coarsen<D, double>(context, finer, level.members, level.galerkin);
    convert<D, T>(context, level.galerkin, level.a);
  } else {
    coarsen<D, T>(context, levels_[r - 1].a, level.members, level.a);
  }
}

template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::resizeVectors(Context<Backend>& context, std::size_t r,
                                                   std::uint32_t columns) {
  Level& level = levels_[r];
  for (Buffer<Vec<D, T>, Backend>* v : {&level.b, &level.x, &level.next})
    v->resize(context, std::size_t{columns} * level.a.rows());
}

/// The cycle is symmetric but for its rounding errors; as a matrix those would be the same in every application,
/// and CR in single precision stalls on them.
template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::buildDense(Context<Backend>& context) {
  std::size_t first = 0;
  while (first < levels_.size() && unknowns(first) > denseUnknowns_) ++first;
  denseLevel_ = levels_.size();  // for the cycles that make the matrix there is none
  if (first == levels_.size()) return;
  const std::uint32_t n = unknowns(first);
  dense_.resize(context, std::size_t{n} * n);
  for (std::uint32_t unit = 0; unit < n; unit += unitsAtATime) {
    const std::uint32_t columns = std::min(unitsAtATime, n - unit);
    for (std::size_t r = first; r < levels_.size(); ++r) resizeVectors(context, r, columns);
    Level& level = levels_[first];
    bucketUnits<D, T>(context, view(first), unit, {level.b.data(), level.x.data(), level.next.data(), columns});
    cycle(context, first, columns);
    const std::span<const T> rows(reinterpret_cast<const T*>(level.x.data()), std::size_t{columns} * n);
    copyValues(context, rows, dense_.data() + std::size_t{unit} * n);
  }
  symmetrise(context, n, dense_.data());
  denseLevel_ = first;
}

/// b and the first sweep are there; the iterate is left in x.
template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::cycle(Context<Backend>& context, std::size_t r, std::uint32_t columns) {
  Level& level = levels_[r];
  if (r == denseLevel_)
    return denseMultiply<T>(context, unknowns(r), dense_.data(), reinterpret_cast<const T*>(level.b.data()),
                            reinterpret_cast<T*>(level.x.data()));
  const BucketLevel<D, T> fine = view(r);
  const auto vectors = [columns](Level& l) {
    return BucketVectors<D, T>{l.b.data(), l.x.data(), l.next.data(), columns};
  };
  const auto sweep = [&](const BucketCorrection<D, T>* correction = nullptr) {
    bucketSweep(context, fine, vectors(level), correction);
    std::swap(level.x, level.next);
  };
  for (int s = 1; s < level.sweeps; ++s) sweep();
  if (r + 1 == levels_.size()) return;
  const BucketLevel<D, T> coarse = view(r + 1);
  bucketRestrictResidual(context, fine, vectors(level), coarse, vectors(levels_[r + 1]));
  cycle(context, r + 1, columns);
  const BucketCorrection<D, T> correction{coarse, levels_[r + 1].x.data()};
  sweep(&correction);
  for (int s = 1; s < level.sweeps; ++s) sweep();
}

template <int D, class T, class Backend>
void BucketMultigrid<D, T, Backend>::apply(Context<Backend>& context, std::span<const Vec<D, T>> inverse,
                                           std::span<const Vec<D>> r, std::span<Vec<D>> z) {
  Level& finest = levels_[0];
  bucketRestrict<D, T>(context, view(0), inverse, r, {finest.b.data(), finest.x.data(), finest.next.data()});
  for (Buffer<Vec<D, T>, Backend>* v : {&finest.b, &finest.x})  // the first sweep is linear
    sumOverSharing(context, std::span(reinterpret_cast<T*>(v->data()), D * v->size()));
  cycle(context, 0);
  bucketProlong<D, T>(context, view(0), finest.x.data(), inverse, r, z);
}

template <int D, class T, class Backend>
std::size_t BucketMultigrid<D, T, Backend>::bytes() const {
  std::size_t sum = dense_.bytes();
  for (const Level& l : levels_)
    sum += l.galerkin.bytes() + l.a.bytes() + l.inverseDiagonal.bytes() + l.b.bytes() + l.x.bytes() +
           l.next.bytes() + l.parent.bytes();
  return sum;
}

#define TREACLE_INSTANTIATE(Backend)                  \
  template class BucketMultigrid<1, double, Backend>; \
  template class BucketMultigrid<2, double, Backend>; \
  template class BucketMultigrid<3, double, Backend>; \
  template class BucketMultigrid<1, float, Backend>;  \
  template class BucketMultigrid<2, float, Backend>;  \
  template class BucketMultigrid<3, float, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
