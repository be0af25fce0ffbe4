#include "point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {

namespace {
constexpr std::size_t leafSize = 8;  // points that are looked at one by one
}

PointTree::PointTree(const std::vector<Vec<3>>& points, int dimensions, const Domain& domain)
    : dimensions_(dimensions), domain_(domain), bounds_(boundsOf({}, 0)) {
  points_.reserve(points.size());
  for (const Vec<3>& x : points) {
    points_.push_back({wrapped(x), static_cast<std::uint32_t>(points_.size())});
    bounds_ = bounds_.joined({points_.back().x, points_.back().x});
  }
  build({0, points_.size(), 0});
}

PointTree::Nearest PointTree::nearest(const Vec<3>& x) const {
  Nearest best{0, std::numeric_limits<double>::infinity()};
  searchImages(wrapped(x), 0, best);
  return best;
}

/// Into the domain on periodic axes.
Vec<3> PointTree::wrapped(Vec<3> x) const {
  for (int k = 0; k < dimensions_; ++k) {
    if (!domain_.periodic[k]) continue;
    const double length = domain_.max[k] - domain_.min[k];
    x[k] -= length * std::floor((x[k] - domain_.min[k]) / length);
  }
  return x;
}

void PointTree::build(const Range& range) {
  if (range.end - range.begin <= leafSize) return;
  const std::size_t middle = range.begin + (range.end - range.begin) / 2;
  const auto at = [this](std::size_t k) { return points_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(range.begin), at(middle), at(range.end),
                   [k = range.axis](const Point& p, const Point& q) { return p.x[k] < q.x[k]; });
  const int axis = (range.axis + 1) % dimensions_;
  build({range.begin, middle, axis});
  build({middle + 1, range.end, axis});
}

/// At x and at its images one period away, axis by axis.
void PointTree::searchImages(const Vec<3>& x, int axis, Nearest& best) const {
  if (axis < dimensions_) {
    searchImages(x, axis + 1, best);
    if (!domain_.periodic[axis]) return;
    Vec<3> period{};
    period[axis] = domain_.max[axis] - domain_.min[axis];
    searchImages(x + period, axis + 1, best);
    searchImages(x - period, axis + 1, best);
    return;
  }
  Vec<3> toBounds{};
  for (int k = 0; k < dimensions_; ++k) toBounds[k] = x[k] - std::clamp(x[k], bounds_.min[k], bounds_.max[k]);
  search({0, points_.size(), 0}, x, toBounds, best);
}

/// `toRange`: from the nearest place of the box that holds the range to x.
void PointTree::search(const Range& range, const Vec<3>& x, const Vec<3>& toRange, Nearest& best) const {
  if (norm2(toRange) >= best.distance2) return;
  const auto look = [&](std::size_t k) {
    if (const double d = norm2(x - points_[k].x); d < best.distance2) best = {points_[k].index, d};
  };
  if (range.end - range.begin <= leafSize) {
    for (std::size_t k = range.begin; k < range.end; ++k) look(k);
    return;
  }
  const std::size_t middle = range.begin + (range.end - range.begin) / 2;
  const int axis = (range.axis + 1) % dimensions_;
  const Range low{range.begin, middle, axis}, high{middle + 1, range.end, axis};
  const double beyond = x[range.axis] - points_[middle].x[range.axis];
  Vec<3> toFar = toRange;
  toFar[range.axis] = beyond;
  look(middle);
  search(beyond < 0 ? low : high, x, toRange, best);
  search(beyond < 0 ? high : low, x, toFar, best);
}

}  // namespace treacle
