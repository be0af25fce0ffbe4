#pragma once

#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/case.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// Fluid particles and what is near them, sorted by cubic cells. Only cells that hold something are stored, so
/// that drops far apart in a large domain cost no more than one body. Near periodic ends images stand beside the
/// particles: nobody who looks around needs to know what is periodic.
class ParticleCells {
 public:
  static constexpr std::uint32_t image = ~0u, wall = ~0u - 1;
  struct Point {
    std::int64_t key;     // of its cell
    Vec<3> position;      // [m]
    std::uint32_t index;  // into the fluid; or the image of a fluid particle, or a wall particle or its image

    bool isParticle() const { return index < wall; }
  };

  /// `edge` of a cell [m]. Periodic axes: at least three edges long. `others`: what else is near, be it on
  /// the other side of periodic ends; it counts as walls do.
  ParticleCells(const Frame& fluid, const Frame& walls, std::span<const Vec<3>> others, const Domain& domain,
                double edge);

  std::size_t size() const { return keys_.size(); }
  std::size_t begin(std::size_t cell) const { return begin_[cell]; }  // its points are [begin(c), begin(c + 1))
  const Point& point(std::size_t i) const { return points_[i]; }
  Vec<3> middle(std::size_t cell) const;  // [m]

  /// f(first, last): cells [first, last), those stored of each row along x of the (2 reach + 1)^D cells around
  /// one; reach is at most 2.
  template <class F>
  void forEachRow(std::size_t cell, int reach, F f) const {
    const int reachZ = dimensions_ == 3 ? reach : 0;
    for (int z = -reachZ; z <= reachZ; ++z)
      for (int y = -reach; y <= reach; ++y) {
        const std::int64_t key = keys_[cell] + z * layer + y * row;
        const auto first = std::lower_bound(keys_.begin(), keys_.end(), key - reach);
        auto last = first;
        while (last != keys_.end() && *last <= key + reach) ++last;
        f(static_cast<std::size_t>(first - keys_.begin()), static_cast<std::size_t>(last - keys_.begin()));
      }
  }

 private:
  // Steps of keys along y and z: 21 bits for each axis.
  static constexpr std::int64_t row = std::int64_t{1} << 21, layer = row << 21;

  void add(const Vec<3>& position, std::uint32_t index);
  void addImages(const Domain& domain);
  /// The position and all its images.
  void addWithImages(Vec<3> position, const Domain& domain, int axis = 0);
  std::int64_t keyOf(const Vec<3>& x) const;

  int dimensions_;
  double edge_;
  Vec<3> min_{}, max_{};  // of what is near the fluid; cells are counted from min_ [m]
  std::vector<Point> points_;
  std::vector<std::int64_t> keys_;    // of the cells that hold points, ascending
  std::vector<std::uint32_t> begin_;  // one more
};

}  // namespace treacle
