#include "library_multigrid.hpp"

#include "core/launch.hpp"

namespace treacle {
namespace {

/// x = w b, the first sweep of a cycle, which starts from zero; z = w r.
void scaled(const Context<Cuda>& context, std::span<const double> w, std::span<const double> b,
            std::span<double> x) {
  forEach(context, x.size(),
          [w = w.data(), b = b.data(), x = x.data()] __device__(std::size_t i) { x[i] = w[i] * b[i]; });
}

/// ax = b - ax
void subtractFrom(const Context<Cuda>& context, std::span<const double> b, std::span<double> ax) {
  forEach(context, ax.size(), [b = b.data(), ax = ax.data()] __device__(std::size_t i) { ax[i] = b[i] - ax[i]; });
}

/// x += w (b - ax)
void correct(const Context<Cuda>& context, std::span<const double> w, std::span<const double> b,
             std::span<const double> ax, std::span<double> x) {
  forEach(context, x.size(), [w = w.data(), b = b.data(), ax = ax.data(), x = x.data()] __device__(std::size_t i) {
    x[i] += w[i] * (b[i] - ax[i]);
  });
}

}  // namespace

template <int D>
void LibraryMultigrid<D>::setup(Context<Cuda>& context, cusparseHandle_t handle, const ScalarCsr& a,
                                const LibraryCycle& cycle, cusparseSpMVAlg_t algorithm) {
  context_ = &context;
  inverse_ = cycle.inverse;
  while (levels_.size() > cycle.members.size()) levels_.pop_back();
  while (levels_.size() < cycle.members.size()) levels_.push_back(std::make_unique<Level>());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = *levels_[l];
    const ScalarCsr& fine = l == 0 ? a : levels_[l - 1]->a;
    transferMatrices<D>(context, cycle.members[l], static_cast<std::uint32_t>(fine.rows / D), level.restriction,
                        level.prolongation);
    if (D == 1 && l == 0) leaveOut(context, cycle.inverse, level.restriction, level.prolongation);
    product_.compute(context, fine, level.prolongation, ap_);
    product_.compute(context, level.restriction, ap_, level.a);
    extendedJacobi(context, level.a, level.inverse);
    level.byA.prepare(context, handle, level.a, algorithm);
    level.byRestriction.prepare(context, handle, level.restriction, algorithm);
    level.byProlongation.prepare(context, handle, level.prolongation, algorithm);
    for (auto* v : {&level.b, &level.x, &level.product})
      v->resize(context, static_cast<std::size_t>(level.a.rows));
    const CycleSweeps& sweeps = cycle.sweeps;
    level.sweeps = l + 1 == levels_.size() ? sweeps.coarsest : l == 0 ? sweeps.finest : sweeps.middle;
  }
}

/// An extended Jacobi iteration [K23 eq. (42)].
template <int D>
void LibraryMultigrid<D>::sweep(Level& level) {
  level.byA.multiply(1, level.x, 0, level.product);
  correct(*context_, level.inverse, level.b, level.product, level.x);
}

template <int D>
void LibraryMultigrid<D>::cycle(std::size_t l) {
  Level& level = *levels_[l];
  scaled(*context_, level.inverse, level.b, level.x);
  for (int s = 1; s < level.sweeps; ++s) sweep(level);
  if (l + 1 == levels_.size()) return;
  Level& coarse = *levels_[l + 1];
  level.byA.multiply(1, level.x, 0, level.product);
  subtractFrom(*context_, level.b, level.product);
  coarse.byRestriction.multiply(1, level.product, 0, coarse.b);
  cycle(l + 1);
  coarse.byProlongation.multiply(1, coarse.x, 1, level.x);
  for (int s = 0; s < level.sweeps; ++s) sweep(level);
}

template <int D>
void LibraryMultigrid<D>::apply(std::span<const double> r, std::span<double> z) {
  Level& finest = *levels_[0];
  finest.byRestriction.multiply(1, r, 0, finest.b);
  cycle(0);
  scaled(*context_, inverse_, r, z);
  finest.byProlongation.multiply(1, finest.x, 1, z);
}

template class LibraryMultigrid<1>;
template class LibraryMultigrid<2>;
template class LibraryMultigrid<3>;

}  // namespace treacle
