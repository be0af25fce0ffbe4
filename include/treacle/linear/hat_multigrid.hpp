#pragma once

#include "treacle/linear/dense_inverse.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/linear/hat_cycle.hpp"
#include "treacle/linear/spectral_estimate.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace treacle {

/// What smoothers divide by: the diagonal, with the largest eigenvalue that belongs to it, which Lanczos' method
/// estimates; or the sums of absolute values of the rows, which bound it. The second needs no estimate and does
/// not suffer from single nodes, at the edge of a splash, that a particle hardly reaches.
enum class HatSmoother { Diagonal, RowSums };

struct HatOptions {
  int degree = 1;                             // >= 1, of the Chebyshev smoothers
  int reach = hatReach;                       // of the finest matrix
  GalerkinRoute route = GalerkinRoute::Sums;  // to the coarser operators; any finest pattern will do for Spgemm
  HatSmoother smoother = HatSmoother::Diagonal;
};

/// Symmetric V-cycle on hat functions of edge h, 2h, 4h, ...: Galerkin operators, fourth-kind Chebyshev smoothing
/// on the diagonal before and after each coarse correction, the inverse on the last level. B unknowns per node
/// share its hat; vectors are flat, node after node. T is the precision of the cycle; operators are formed in
/// double. Per cycle of degree k each level but the last reads its matrix 2 k times.
///
/// On a device a cycle is a fixed series of kernels on fixed memory: it can be captured into a graph.
template <int D, class T, class Backend = Cpu, int B = 1>
class HatMultigrid {
 public:
  /// Levels of at most `denseUnknowns` unknowns, B per node, are solved by their inverse.
  explicit HatMultigrid(std::uint32_t denseUnknowns = std::is_same_v<Backend, Cpu> ? 200 : 1100)
      : denseUnknowns_(denseUnknowns) {}

  /// `finest`: symmetric positive (semi-)definite, within the pattern of hatPattern(nodes, reach). Both must stay
  /// where and what they are until the last cycle.
  void setup(Context<Backend>& context, const HatNodes<D, Backend>& nodes,
             const BlockCsr<B, double, Backend>& finest, const HatOptions& options);

  /// B numbers per finest node, in the backend's memory; a cycle leaves the right-hand side as it is.
  std::span<T> rhs() { return levels_.front().b; }
  std::span<const T> solution() const { return levels_.front().x; }

  /// solution = V-cycle of rhs
  void cycle(Context<Backend>& context);

  std::uint32_t denseUnknowns() const { return denseUnknowns_; }
  std::size_t levelCount() const { return levels_.size(); }
  std::uint32_t levelSize(std::size_t level) const { return nodes(level).count(); }  // nodes
  std::size_t bytes() const;

 private:
  static constexpr bool onDevice = !std::is_same_v<Backend, Cpu>;
  struct Nothing {};
  /// Kept from setup to setup.
  struct Products {
    GalerkinSpgemm<B> galerkin;
    Prolongation<Backend> prolongation;
  };
  struct Level {
    HatNodes<D, Backend> nodes;             // empty on the finest level, where
    BlockCsr<B, double, Backend> galerkin;  // they are the caller's
    Buffer<T, Backend> value;               // of the matrix; empty in double precision
    Buffer<T, Backend> inverseDiagonal;
    SpectralEstimate<T, Backend> lambdaMax;
    Buffer<T, Backend> b, res, x, z0, z1;
  };

  const HatNodes<D, Backend>& nodes(std::size_t l) const { return l == 0 ? *finestNodes_ : levels_[l].nodes; }
  const BlockCsr<B, double, Backend>& operatorOf(std::size_t l) const {
    return l == 0 ? *finestMatrix_ : levels_[l].galerkin;
  }
  bool isLast(std::size_t l) const { return l + 1 == levels_.size(); }
  std::size_t unknowns(std::size_t l) const { return std::size_t{B} * nodes(l).count(); }
  bool isDense(std::size_t l) const { return isLast(l) && unknowns(l) <= denseUnknowns_; }
  /// A last level too large to invert has nothing below that would help.
  int degreeOf(std::size_t l) const { return isLast(l) ? 4 * options_.degree : options_.degree; }

  HatMatrix<T, B> matrix(std::size_t l) const;
  HatVectors<T> vectors(std::size_t l);
  void addCoarserLevels(Context<Backend>& context);
  void coarsen(Context<Backend>& context, std::size_t l);
  void prepareSmoother(Context<Backend>& context, std::size_t l);
  void cycle(Context<Backend>& context, std::size_t l);

  const HatNodes<D, Backend>* finestNodes_ = nullptr;
  const BlockCsr<B, double, Backend>* finestMatrix_ = nullptr;
  std::vector<Level> levels_;
  std::conditional_t<onDevice, std::optional<Products>, Nothing> products_;  // once they are asked for
  Buffer<T, Backend> inverse_;                                               // of the last level
  std::uint32_t denseUnknowns_;
  HatOptions options_;
};

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::setup(Context<Backend>& context, const HatNodes<D, Backend>& finestNodes,
                                           const BlockCsr<B, double, Backend>& finest, const HatOptions& options) {
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
  if (n > 0) denseInverse<T>(context, operatorOf(last), inverse_);
}

/// The memory of an earlier setup's levels is used again.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::addCoarserLevels(Context<Backend>& context) {
  std::size_t count = 1;
  if (levels_.empty()) levels_.resize(1);
  for (; unknowns(count - 1) > denseUnknowns_; ++count) {
    if (levels_.size() == count) levels_.emplace_back();
    Level& coarse = levels_[count];
    const HatNodes<D, Backend>& fine = nodes(count - 1);
    coarserNodes<D>(context, fine, coarse.nodes);
    // Scattered drops have as many coarse nodes as fine ones, or more.
    if (B * coarse.nodes.count() > denseUnknowns_ && coarse.nodes.count() > 0.9 * fine.count()) break;
    coarsen(context, count - 1);
  }
  levels_.resize(count);
}

/// The operator of level l + 1, whose nodes are there.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::coarsen(Context<Backend>& context, std::size_t l) {
  Level& coarse = levels_[l + 1];
  if constexpr (onDevice)
    if (options_.route == GalerkinRoute::Spgemm) {
      if (!products_) products_.emplace();
      hatProlongation<D>(context, nodes(l), coarse.nodes, products_->prolongation);
      products_->galerkin.compute(context, operatorOf(l), products_->prolongation, coarse.galerkin);
      return;
    }
  coarsenHats<D>(context, nodes(l), operatorOf(l), coarse.nodes, coarse.galerkin, options_.reach);
}

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::prepareSmoother(Context<Backend>& context, std::size_t l) {
  Level& level = levels_[l];
  for (Buffer<T, Backend>* v : {&level.inverseDiagonal, &level.res, &level.z0, &level.z1})
    v->resize(context, unknowns(l));
  if (!std::is_same_v<T, double>) level.value.resize(context, B * B * operatorOf(l).block.size());
  hatValues<T>(context, operatorOf(l), level.value, level.inverseDiagonal);
  if (options_.smoother == HatSmoother::RowSums) {
    const auto inverse = reinterpret_cast<Vec<B, T>*>(level.inverseDiagonal.data());
    extendedJacobiInverse<B>(context, operatorOf(l), std::span<Vec<B, T>>{inverse, operatorOf(l).rows()});
    level.lambdaMax.assume(context, T(2));  // halves of the sums
    return;
  }
  level.lambdaMax.run(
      context, [&, a = matrix(l)](std::span<const T> x, std::span<T> y) { hatMultiply<T>(context, a, x, y); },
      level.inverseDiagonal);
}

template <int D, class T, class Backend, int B>
HatMatrix<T, B> HatMultigrid<D, T, Backend, B>::matrix(std::size_t l) const {
  const BlockCsr<B, double, Backend>& a = operatorOf(l);
  HatMatrix<T, B> view{a.rows(), a.block.size(), a.rowStart.data(), a.column.data(), levels_[l].value.data()};
  if constexpr (std::is_same_v<T, double>) view.value = reinterpret_cast<const double*>(a.block.data());
  return view;
}

template <int D, class T, class Backend, int B>
HatVectors<T> HatMultigrid<D, T, Backend, B>::vectors(std::size_t l) {
  Level& v = levels_[l];
  const T* lambdaMax = isDense(l) ? nullptr : v.lambdaMax.largest();
  return {v.inverseDiagonal.data(), lambdaMax, v.b.data(), v.res.data(), v.x.data(), {v.z0.data(), v.z1.data()}};
}

template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::cycle(Context<Backend>& context) {
  if (!isDense(0)) hatFirstStep<T>(context, unknowns(0), vectors(0));
  cycle(context, 0);
}

/// b, and the first smoothing step of it, are there; what comes out is x.
template <int D, class T, class Backend, int B>
void HatMultigrid<D, T, Backend, B>::cycle(Context<Backend>& context, std::size_t l) {
  const HatVectors<T> v = vectors(l);
  if (isDense(l))
    return denseMultiply<T>(context, static_cast<std::uint32_t>(unknowns(l)), inverse_.data(), v.b, v.x);

  const HatMatrix<T, B> a = matrix(l);
  const T* from = v.b;
  int last = 0;  // which z is the latest; the same at the start of each cycle
  for (int i = 2; i <= degreeOf(l); ++i, last = 1 - last, from = v.res)
    hatStep<T>(context, a, ChebyshevStep<T>::at(i), v, from, last);
  if (isLast(l)) return;

  hatResidual<T>(context, a, v, from, last);
  const HatVectors<T> coarse = vectors(l + 1);
  hatRestrict<D, B, T>(context, nodes(l), nodes(l + 1), v.res, coarse);
  cycle(context, l + 1);
  hatProlong<D, B, T>(context, nodes(l), nodes(l + 1), coarse.x, v);
  last = 0;
  for (int i = 1; i <= options_.degree; ++i, last = 1 - last)
    hatStep<T>(context, a, ChebyshevStep<T>::at(i), v, v.res, last);
}

template <int D, class T, class Backend, int B>
std::size_t HatMultigrid<D, T, Backend, B>::bytes() const {
  std::size_t sum = inverse_.bytes();
  if constexpr (onDevice)
    if (products_) sum += products_->galerkin.bytes() + products_->prolongation.bytes();
  for (const Level& l : levels_) {
    sum += l.nodes.bytes() + l.galerkin.bytes() + l.value.bytes() + l.inverseDiagonal.bytes();
    sum += l.lambdaMax.bytes() + l.b.bytes() + l.res.bytes() + l.x.bytes() + l.z0.bytes() + l.z1.bytes();
  }
  return sum;
}

}  // namespace treacle
