#include "surface.hpp"

#include "picture/box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace treacle {

namespace {

/// Particles counted on a grid with linear weights; between the nodes the count is interpolated linearly.
class Occupancy {
 public:
  Occupancy(const std::vector<Vec<3>>& position, double spacing) {
    const Box box = boundsOf(position, spacing);
    cell_ = 2 * spacing;
    const Vec<3> size = box.max - box.min;
    // Fine cells where the fluid is all over the place would cost more memory than the particles.
    const double most = 8.0 * static_cast<double>(position.size()) + 1e5;
    const auto count = [&](int k) { return std::ceil(size[k] / cell_) + 5; };
    while (count(0) * count(1) * count(2) > most) cell_ *= 1.25;
    for (int k = 0; k < 3; ++k) {
      origin_[k] = box.min[k] - 2 * cell_;
      nodes_[k] = static_cast<std::int64_t>(count(k));
    }
    full_ = std::pow(cell_ / spacing, 3);
    value_.resize(static_cast<std::size_t>(nodes_[0] * nodes_[1] * nodes_[2]));
    for (const Vec<3>& x : position)
      forEachNode(x, [this](std::size_t node, double weight) { value_[node] += float(weight); });
  }

  /// Share of the space around x that is filled; 1 inside a body.
  double at(const Vec<3>& x) const {
    double sum = 0;
    forEachNode(x, [&](std::size_t node, double weight) { sum += weight * value_[node]; });
    return sum / full_;
  }

  /// How much less is filled one cell ahead than one cell behind, along each axis.
  Vec<3> decrease(const Vec<3>& x) const {
    Vec<3> result{};
    for (int k = 0; k < 3; ++k) {
      Vec<3> step{};
      step[k] = cell_;
      result[k] = at(x - step) - at(x + step);
    }
    return result;
  }

 private:
  template <class F>
  void forEachNode(const Vec<3>& x, F f) const {
    std::array<std::int64_t, 3> low;
    Vec<3> share;
    for (int k = 0; k < 3; ++k) {
      const double place = (x[k] - origin_[k]) / cell_;
      low[k] = std::clamp<std::int64_t>(static_cast<std::int64_t>(place), 0, nodes_[k] - 2);
      share[k] = place - static_cast<double>(low[k]);
    }
    for (int bits = 0; bits < 8; ++bits) {
      double weight = 1;
      std::array<std::int64_t, 3> node;
      for (int k = 0; k < 3; ++k) {
        const bool upper = bits >> k & 1;
        weight *= upper ? share[k] : 1 - share[k];
        node[k] = low[k] + upper;
      }
      f(static_cast<std::size_t>((node[2] * nodes_[1] + node[1]) * nodes_[0] + node[0]), weight);
    }
  }

  double cell_ = 0;  // [m]
  double full_ = 0;  // particles per cell inside a body
  Vec<3> origin_{};
  std::array<std::int64_t, 3> nodes_{};
  std::vector<float> value_;
};

}  // namespace

std::vector<SurfacePoint> surfacePoints(const std::vector<Vec<3>>& position, double spacing) {
  constexpr double least = 0.25;  // less than that is the grid's own unevenness
  // One spacing along the normal the first layer sees about 1/3, in a hollow edge 0.55; the second layer 2/3.
  constexpr double lessThanSecondLayer = 0.6;
  std::vector<SurfacePoint> points(position.size());
  if (position.empty()) return points;
  const Occupancy occupancy(position, spacing);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec<3> decrease = occupancy.decrease(position[i]);
    const double size = norm(decrease);
    if (size < least) continue;
    points[i].normal = decrease * (1 / size);
    points[i].outermost = occupancy.at(position[i] + points[i].normal * spacing) < lessThanSecondLayer;
  }
  return points;
}

}  // namespace treacle
