#pragma once

#include "treacle/model/case/case.hpp"

#include <bit>
#include <cstdint>
#include <vector>

namespace treacle {

/// A growing set of points with the question "is one closer than `radius`?", answered in O(1): a hash table of
/// cells of edge `2 radius`, so that the ball around a point touches at most 2^D cells. Periodic images count.
template <int D>
class PointGrid {
 public:
  static constexpr std::uint32_t none = ~0u;

  /// `capacity`: how many points will be added at most.
  PointGrid(const Domain& domain, double radius, std::size_t capacity)
      : domain_(domain), radius_(radius), first_(std::bit_ceil(capacity + capacity / 2 + 1), none) {}

  void add(const Vec<D>& x, std::uint32_t tag) {
    std::uint32_t& head = first_[slot(cellOf(x))];
    points_.push_back({x, tag, head});
    head = static_cast<std::uint32_t>(points_.size() - 1);
  }

  /// The tag of a point closer to x than the radius, or `none`.
  std::uint32_t find(const Vec<D>& x) const {
    return find(x, [](std::uint32_t, const Vec<D>&, const Vec<D>&) { return true; });
  }
  /// Likewise, only of points for which accept(tag, point, x) holds, where x is that of its images which is near.
  template <class Accept>
  std::uint32_t find(const Vec<D>& x, Accept&& accept) const {
    return points_.empty() ? none : findImages(x, 0, accept);
  }

 private:
  using Cell = Vec<D, std::int64_t>;
  struct Point {
    Vec<D> x;
    std::uint32_t tag;
    std::uint32_t next;  // in the same slot
  };

  Cell cellOf(const Vec<D>& x) const {
    Cell c{};
    for (int k = 0; k < D; ++k) c[k] = static_cast<std::int64_t>(std::floor(x[k] / (2 * radius_)));
    return c;
  }

  std::size_t slot(const Cell& c) const {
    std::uint64_t h = 0;
    for (int k = 0; k < D; ++k) {
      h = (h ^ static_cast<std::uint64_t>(c[k])) * 0x9E3779B97F4A7C15u;
      h ^= h >> 29;
    }
    return h & (first_.size() - 1);
  }

  /// Looks at x and at its images across periodic boundaries nearer than the radius, axis by axis.
  template <class Accept>
  std::uint32_t findImages(Vec<D> x, int axis, Accept& accept) const {
    if (axis == D) return findNear(x, accept);
    if (const std::uint32_t tag = findImages(x, axis + 1, accept); tag != none) return tag;
    if (!domain_.periodic[axis]) return none;
    const double low = domain_.min[axis], high = domain_.max[axis];
    const double at = x[axis];
    if (at - low < radius_) {
      x[axis] = at + (high - low);
      if (const std::uint32_t tag = findImages(x, axis + 1, accept); tag != none) return tag;
    }
    if (high - at < radius_) {
      x[axis] = at - (high - low);
      return findImages(x, axis + 1, accept);
    }
    return none;
  }

  template <class Accept>
  std::uint32_t findNear(const Vec<D>& x, Accept& accept) const {
    const Cell low = cellOf(x - Vec<D>::filled(radius_)), high = cellOf(x + Vec<D>::filled(radius_));
    Cell c = low;
    while (true) {
      for (std::uint32_t i = first_[slot(c)]; i != none; i = points_[i].next)
        if (norm2(points_[i].x - x) < radius_ * radius_ && accept(points_[i].tag, points_[i].x, x))
          return points_[i].tag;
      int k = 0;
      while (k < D && c[k] == high[k]) c[k] = low[k], ++k;
      if (k == D) return none;
      ++c[k];
    }
  }

  Domain domain_;
  double radius_;                     // [m]
  std::vector<std::uint32_t> first_;  // per slot: the point added last
  std::vector<Point> points_;
};

}  // namespace treacle
