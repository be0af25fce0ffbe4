#include "treacle/linear/hat_multigrid.hpp"

namespace treacle {

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::setup(Context<Backend>& context, const HatNodes<D, Backend>& finestNodes,
                                           const BlockCsr<B, double, Backend>& finest, const HatOptions& options,
                                           DenseInverses<T, Backend>& inverses) {
  finestNodes_ = &finestNodes;
  finestMatrix_ = &finest;
  options_ = options;
  addCoarserLevels(context);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].b.resize(context, unknowns(l));
    levels_[l].x.resize(context, unknowns(l));
    if (!isDense(l)) prepareSmoother(context, l);
  }
  const std::size_t last = levels_.size() - 1, n = isDense(last) ? unknowns(last) : 0;
  inverse_.resize(context, n * n);
  if (n > 0) inverses.add(context, operatorOf(last), inverse_.span());
}

/// The memory of an earlier setup's levels is used again.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::addCoarserLevels(Context<Backend>& context) {
  std::size_t count = 1;
  if (levels_.empty()) levels_.resize(1);
  const std::uint64_t most = mostWhole(options_.mostWhole);
  for (; unknownsOfAll(count - 1) > denseUnknowns_; ++count) {
    if (levels_.size() == count) levels_.emplace_back();
    Level& coarse = levels_[count];
    const HatNodes<D, Backend>& fine = nodes(count - 1);
    coarserNodes<D>(context, fine, coarse.nodes, most);
    // Scattered drops have as many coarse nodes as fine ones, or more.
    const auto coarseOfAll = static_cast<double>(coarse.nodes.ofAll()), ofAll = static_cast<double>(fine.ofAll());
    if (B * coarseOfAll > denseUnknowns_ && coarseOfAll > 0.9 * ofAll) break;
    coarsenHats<D>(context, fine, operatorOf(count - 1), coarse.nodes, coarse.galerkin, options_.reach);
  }
  levels_.resize(count);
}

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::prepareSmoother(Context<Backend>& context, std::size_t l) {
  Level& level = levels_[l];
  for (Buffer<T, Backend>* v : {&level.inverseDiagonal, &level.res, &level.z0, &level.z1})
    v->resize(context, unknowns(l));
  if constexpr (!std::is_same_v<T, double>) {
    level.value.resize(context, operatorOf(l).value.size());
    hatValues<T, B>(context, operatorOf(l), level.value, level.inverseDiagonal);
  }
  const auto inverse = reinterpret_cast<Vec<B, T>*>(level.inverseDiagonal.data());
  extendedJacobiInverse<B>(context, operatorOf(l), std::span<Vec<B, T>>{inverse, operatorOf(l).rows()});
}

template <int D, class T, class Backend, int B>
BlockCsrView<B, T> HatMultigrid<D, T, Backend, B>::matrix(std::size_t l) const {
  const BlockCsr<B, double, Backend>& a = operatorOf(l);
  BlockCsrView<B, T> view{nodes(l).own(), a.value.size(), a.rowStart.data(), a.column.data(),
                          levels_[l].value.data()};
  if constexpr (std::is_same_v<T, double>) view.value = a.value.data();
  return view;
}

template <int D, class T, class Backend, int B>
HatVectors<T> HatMultigrid<D, T, Backend, B>::vectors(std::size_t l) {
  Level& v = levels_[l];
  return {isDense(l) ? nullptr : v.inverseDiagonal.data(),
          v.b.data(),
          v.res.data(),
          v.x.data(),
          {v.z0.data(), v.z1.data()}};
}

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::cycle(Context<Backend>& context) {
  if (!isDense(0)) hatFirstStep<T>(context, ownUnknowns(0), vectors(0));
  cycle(context, 0);
}

/// b of level l + 1 = P^T res of level l, and the first smoothing step there.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::restrictResidual(Context<Backend>& context, std::size_t l) {
  HatVectors<T> coarse = vectors(l + 1);
  if (!nodes(l).division) return hatRestrict<D, B, T>(context, nodes(l), nodes(l + 1), vectors(l).res, coarse);
  coarse.inverseDiagonal = nullptr;  // first the parts of all processes have to be summed
  hatRestrict<D, B, T>(context, nodes(l), nodes(l + 1), vectors(l).res, coarse);
  sumAtNodes<B>(context, nodes(l + 1), levels_[l + 1].b.span());
  if (!isDense(l + 1)) hatFirstStep<T>(context, ownUnknowns(l + 1), vectors(l + 1));
}

/// b, and the first smoothing step of it, are there; what comes out is x, that of ghosts, too.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::cycle(Context<Backend>& context, std::size_t l) {
  const HatVectors<T> v = vectors(l);
  if (isDense(l))
    return denseMultiply<T>(context, static_cast<std::uint32_t>(unknowns(l)), inverse_.data(), v.b, v.x);

  const BlockCsrView<B, T> a = matrix(l);
  const T* from = v.b;
  int last = 0;  // which z is the latest; the same at the start of each cycle
  for (int i = 2; i <= degreeOf(l); ++i, last = 1 - last, from = v.res) {
    fillNodes<B>(context, nodes(l), v.z[last]);
    hatStep<T>(context, a, ChebyshevStep<T>::at(i), v, from, last);
  }
  if (isLast(l)) return fillNodes<B>(context, nodes(l), v.x);

  fillNodes<B>(context, nodes(l), v.z[last]);
  hatResidual<T>(context, a, v, from, last);
  restrictResidual(context, l);
  cycle(context, l + 1);
  hatProlong<D, B, T>(context, nodes(l), nodes(l + 1), vectors(l + 1).x, v);  // for ghosts, too
  last = 0;
  for (int i = 1; i <= options_.degree; ++i, last = 1 - last) {
    if (i > 1) fillNodes<B>(context, nodes(l), v.z[last]);
    hatStep<T>(context, a, ChebyshevStep<T>::at(i), v, v.res, last);
  }
  fillNodes<B>(context, nodes(l), v.x);
}

template <int D, class T, class Backend, int B>
std::size_t HatMultigrid<D, T, Backend, B>::bytes() const {
  std::size_t sum = inverse_.bytes();
  for (const Level& l : levels_) {
    sum += l.nodes.bytes() + l.galerkin.bytes() + l.value.bytes() + l.inverseDiagonal.bytes();
    sum += l.b.bytes() + l.res.bytes() + l.x.bytes() + l.z0.bytes() + l.z1.bytes();
  }
  return sum;
}

#define TREACLE_INSTANTIATE(Backend)                  \
  template class HatMultigrid<2, double, Backend, 1>; \
  template class HatMultigrid<2, double, Backend, 2>; \
  template class HatMultigrid<3, double, Backend, 1>; \
  template class HatMultigrid<3, double, Backend, 3>; \
  template class HatMultigrid<2, float, Backend, 1>;  \
  template class HatMultigrid<2, float, Backend, 2>;  \
  template class HatMultigrid<3, float, Backend, 1>;  \
  template class HatMultigrid<3, float, Backend, 3>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
