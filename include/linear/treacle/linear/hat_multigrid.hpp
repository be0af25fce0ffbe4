#pragma once

#include "treacle/linear/dense_inverse.hpp"
#include "treacle/linear/hat_cycle.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace treacle {

struct HatOptions {
  int degree = 1;        // >= 1, of the Chebyshev smoothers
  int reach = hatReach;  // of the finest matrix
  std::uint64_t mostWhole =
      anyNumber;  // nodes of a grid that every process has as a whole; larger ones are divided
};

/// Symmetric V-cycle on hat functions of edge h, 2h, 4h, ...: Galerkin operators, fourth-kind Chebyshev smoothing
/// before and after each coarse correction, the inverse on the last level. Smoothers divide by the sums of
/// absolute values of the rows, which bound the eigenvalues: that needs no estimate and does not suffer from
/// single nodes, at the edge of a splash, that a particle hardly reaches. B unknowns per node share its hat;
/// vectors are flat, node after node. T is the precision of the cycle; operators are formed in double. Per cycle
/// of degree k each level but the last reads its matrix 2 k times.
///
/// Where the finest nodes are divided between processes (HatDivision) so are those of the grids below that have
/// more than `mostWhole`; each process then works on its own nodes, with what it reads of others brought before
/// each product. Smaller grids stand whole at every process, and all do the same on them.
///
/// On a device a cycle is a fixed series of kernels on fixed memory: it can be captured into a graph.
template <int D, class T, class Backend = Cpu, int B = 1>
class HatMultigrid {
 public:
  /// Levels of at most `denseUnknowns` unknowns, B per node, are solved by their inverse.
  explicit HatMultigrid(std::uint32_t denseUnknowns = std::is_same_v<Backend, Cpu> ? 200 : 1100)
      : denseUnknowns_(denseUnknowns) {}

  /// `finest`: of own nodes the rows; symmetric positive (semi-)definite, within the pattern of hatPattern(nodes,
  /// reach). Both must stay where and what they are until the last cycle. The inverse of the last level is left to
  /// `inverses`.
  void setup(Context<Backend>& context, const HatNodes<D, Backend>& nodes,
             const BlockCsr<B, double, Backend>& finest, const HatOptions& options,
             DenseInverses<T, Backend>& inverses);
  void setup(Context<Backend>& context, const HatNodes<D, Backend>& nodes,
             const BlockCsr<B, double, Backend>& finest, const HatOptions& options) {
    DenseInverses<T, Backend> inverses;
    setup(context, nodes, finest, options, inverses);
    inverses.finish(context);
  }

  /// B numbers per finest node, in the backend's memory; a cycle leaves the right-hand side as it is.
  /// Of divided nodes those of own ones count; the solution has ghosts, too.
  std::span<T> rhs() { return levels_.front().b; }
  std::span<const T> solution() const { return levels_.front().x; }

  /// solution = V-cycle of rhs
  void cycle(Context<Backend>& context);

  std::uint32_t denseUnknowns() const { return denseUnknowns_; }
  /// What is to be inverted in the end is never divided.
  std::uint64_t mostWhole(std::uint64_t asked) const { return std::max<std::uint64_t>(asked, denseUnknowns_ / B); }
  std::size_t levelCount() const { return levels_.size(); }
  std::size_t bytes() const;

 private:
  static constexpr bool onDevice = !std::is_same_v<Backend, Cpu>;
  struct Level {
    HatNodes<D, Backend> nodes;             // empty on the finest level, where
    BlockCsr<B, double, Backend> galerkin;  // they are the caller's
    Buffer<Block<B, T>, Backend> value;     // of the matrix; empty in double precision
    Buffer<T, Backend> inverseDiagonal;
    Buffer<T, Backend> b, res, x, z0, z1;
  };

  const HatNodes<D, Backend>& nodes(std::size_t l) const { return l == 0 ? *finestNodes_ : levels_[l].nodes; }
  const BlockCsr<B, double, Backend>& operatorOf(std::size_t l) const {
    return l == 0 ? *finestMatrix_ : levels_[l].galerkin;
  }
  bool isLast(std::size_t l) const { return l + 1 == levels_.size(); }
  std::size_t unknowns(std::size_t l) const { return std::size_t{B} * nodes(l).count(); }  // ghosts included
  std::size_t ownUnknowns(std::size_t l) const { return std::size_t{B} * nodes(l).own(); }
  std::uint64_t unknownsOfAll(std::size_t l) const { return B * nodes(l).ofAll(); }
  bool isDense(std::size_t l) const { return isLast(l) && unknownsOfAll(l) <= denseUnknowns_; }
  /// A last level too large to invert has nothing below that would help.
  int degreeOf(std::size_t l) const { return isLast(l) ? 4 * options_.degree : options_.degree; }

  BlockCsrView<B, T> matrix(std::size_t l) const;
  HatVectors<T> vectors(std::size_t l);
  void addCoarserLevels(Context<Backend>& context);
  void prepareSmoother(Context<Backend>& context, std::size_t l);
  void cycle(Context<Backend>& context, std::size_t l);
  void restrictResidual(Context<Backend>& context, std::size_t l);

  const HatNodes<D, Backend>* finestNodes_ = nullptr;
  const BlockCsr<B, double, Backend>* finestMatrix_ = nullptr;
  std::vector<Level> levels_;
  Buffer<T, Backend> inverse_;  // of the last level
  std::uint32_t denseUnknowns_;
  HatOptions options_;
};

}  // namespace treacle
