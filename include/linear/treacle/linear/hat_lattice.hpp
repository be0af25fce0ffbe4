#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <cstddef>
#include <cstdint>

namespace treacle {

/// The points that multilinear hat functions stand on, and how the hats of the lattice of twice the edge are made
/// of them. Index arithmetic alone; fewer than 2^32 - 1 points.
template <int D>
struct HatLattice {
  Vec<D, int> count{};  // points per axis
  Vec<D, bool> periodic{};

  TREACLE_HD std::size_t points() const {
    std::size_t n = 1;
    for (int k = 0; k < D; ++k) n *= static_cast<std::size_t>(count[k]);
    return n;
  }

  /// Axis 0 is the fastest.
  TREACLE_HD std::size_t linear(const Vec<D, int>& p) const {
    std::size_t index = 0;
    for (int k = D - 1; k >= 0; --k) index = index * count[k] + p[k];
    return index;
  }

  /// The inverse of linear(). In 32 bits, because devices divide slowly in 64.
  TREACLE_HD Vec<D, int> at(std::size_t index) const {
    Vec<D, int> p{};
    auto rest = static_cast<std::uint32_t>(index);
    for (int k = 0; k < D; ++k) {
      const auto n = static_cast<std::uint32_t>(count[k]);
      p[k] = static_cast<int>(rest % n);
      rest /= n;
    }
    return p;
  }

  /// Coarse point I stands on point 2 I. An open axis of even length has its last coarse point one step beyond its
  /// end; on a periodic axis of odd length the last coarse interval is one step long.
  TREACLE_HD HatLattice coarser() const {
    HatLattice coarse = *this;
    for (int k = 0; k < D; ++k) coarse.count[k] = coarserCount(k);
    return coarse;
  }
  TREACLE_HD int coarserCount(int axis) const {
    const int n = count[axis];
    return n == 1 ? 1 : periodic[axis] ? (n + 1) / 2 : n / 2 + 1;
  }
};

/// The points at most `reach` steps per axis from a centre, across periodic ends too and each exactly once, in the
/// order of the lattice of steps. The centre may lie one step beyond an open end.
template <int D>
struct HatBox {
  HatLattice<D> lattice;
  Vec<D, int> first{}, number{};

  TREACLE_HD static HatBox around(const HatLattice<D>& lattice, const Vec<D, int>& centre, int reach) {
    HatBox box{lattice, {}, {}};
    for (int k = 0; k < D; ++k) {
      const int n = lattice.count[k], wide = 2 * reach + 1;
      if (lattice.periodic[k]) {
        box.number[k] = wide < n ? wide : n;
        box.first[k] = centre[k] - box.number[k] / 2;
        if (box.first[k] < 0) box.first[k] += n;
      } else {
        const int low = centre[k] - reach, high = centre[k] + reach;
        box.first[k] = low < 0 ? 0 : low;
        box.number[k] = (high < n ? high : n - 1) - box.first[k] + 1;
      }
    }
    return box;
  }

  TREACLE_HD int size() const {
    int n = 1;
    for (int k = 0; k < D; ++k) n *= number[k];
    return n;
  }

  TREACLE_HD Vec<D, int> at(int place) const {
    Vec<D, int> p{};
    for (int k = 0; k < D; ++k) {
      p[k] = first[k] + place % number[k];
      if (p[k] >= lattice.count[k]) p[k] -= lattice.count[k];
      place /= number[k];
    }
    return p;
  }

  /// The inverse of at(); -1 for a point outside.
  TREACLE_HD int placeOf(const Vec<D, int>& point) const {
    int place = 0;
    for (int k = D - 1; k >= 0; --k) {
      int step = point[k] - first[k];
      if (lattice.periodic[k] && step < 0) step += lattice.count[k];
      if (step < 0 || step >= number[k]) return -1;
      place = place * number[k] + step;
    }
    return place;
  }
};

/// Steps per axis to the farthest points whose hats a matrix row couples to, at most. Galerkin products keep a
/// reach, be it 1 or 2, on all coarser lattices.
inline constexpr int hatReach = 2;

/// f(other) for every point within `reach` of `point`, in the order of HatBox.
template <int D, class F>
TREACLE_HD void forEachNear(const HatLattice<D>& lattice, const Vec<D, int>& point, int reach, F&& f) {
  const HatBox<D> box = HatBox<D>::around(lattice, point, reach);
  for (int n = 0, end = box.size(); n < end; ++n) f(box.at(n));
}

/// f(coarsePoint, weight) for the hats of fine.coarser() that do not vanish at `point`. On short periodic axes the
/// same one may come twice; the weights always add up to 1.
template <int D, class F>
TREACLE_HD void forEachCoarse(const HatLattice<D>& fine, const Vec<D, int>& point, F&& f) {
  for (int corner = 0; corner < 1 << D; ++corner) {
    Vec<D, int> coarse{};
    double weight = 1;
    bool once = true;  // on even axes both corners are the same
    for (int k = 0; k < D; ++k) {
      const int upper = corner >> k & 1, odd = point[k] & 1;
      once = once && (odd || !upper);
      coarse[k] = point[k] / 2 + upper;
      if (odd) weight /= 2;
      if (fine.periodic[k] && coarse[k] == fine.coarserCount(k)) coarse[k] = 0;
    }
    if (once) f(coarse, weight);
  }
}

/// The transpose has 3^D steps: the fine point of one of them, and the weight of the hat of `coarsePoint` there;
/// false where there is no such point. On short periodic axes two steps may lead to the same point.
template <int D>
TREACLE_HD bool finePoint(const HatLattice<D>& fine, const Vec<D, int>& coarsePoint, int step, Vec<D, int>& p,
                          double& weight) {
  weight = 1;
  bool exists = true;
  for (int k = 0; k < D; ++k, step /= 3) {
    const int offset = step % 3 - 1, n = fine.count[k];
    p[k] = 2 * coarsePoint[k] + offset;
    if (offset != 0) weight /= 2;
    if (fine.periodic[k] && n % 2 == 0) p[k] = p[k] < 0 ? p[k] + n : p[k] >= n ? p[k] - n : p[k];
    exists = exists && p[k] >= 0 && p[k] < n;
  }
  return exists;
}
template <int D>
inline constexpr int fineSteps = D == 1   ? 3
                                 : D == 2 ? 9
                                          : 27;

/// f(finePoint, weight) for all of them.
template <int D, class F>
TREACLE_HD void forEachFine(const HatLattice<D>& fine, const Vec<D, int>& coarsePoint, F&& f) {
  for (int s = 0; s < fineSteps<D>; ++s) {
    Vec<D, int> p{};
    double weight;
    if (finePoint(fine, coarsePoint, s, p, weight)) f(p, weight);
  }
}
template <int D, class F>
TREACLE_HD void forEachFine(const HatLattice<D>& fine, const HatLattice<D>&, const Vec<D, int>& coarsePoint,
                            F&& f) {
  forEachFine(fine, coarsePoint, f);
}

}  // namespace treacle
