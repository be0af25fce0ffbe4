#pragma once

#include "wall_part.hpp"

#include <vector>

namespace treacle {

/// The walls around a particle that move alike.
template <int D>
struct NearWalls {
  std::vector<const WallPart<D>*> parts;

  bool contain(const Vec<D>& x) const {
    for (const WallPart<D>* part : parts)
      if (part->contains(x)) return true;
    return false;
  }
  /// Whether a place is empty because of the condition of a wall.
  bool cutAt(const Vec<D>& x) const {
    for (const WallPart<D>* part : parts)
      if (part->cutAt(x)) return true;
    return false;
  }
  bool cutIn(const Vec<D>& min, const Vec<D>& max) const {
    for (const WallPart<D>* part : parts)
      if (part->cutIn(min, max)) return true;
    return false;
  }
};

/// Finds the surfaces that conditions leave, for which there is no formula: the nearest points of a surface are
/// those where straight lines from the particle leave the walls soonest.
template <int D>
class CutSearch {
 public:
  /// `margin` [m]: what is thinner does not count.
  CutSearch(double spacing, double reach, double margin);

  /// Whether a condition may leave a surface near x. To ask a polygon or mesh whether it contains a point takes
  /// far longer than to ask its condition.
  bool mayFind(const Vec<D>& x, const NearWalls<D>& walls) const;

  struct Exit {
    Vec<D> way;       // unit vector; outward where the surface is smooth
    double distance;  // [m]
  };
  /// The exits from x that are nearer than those around them.
  void find(const Vec<D>& x, const NearWalls<D>& walls, std::vector<Exit>& found) const;

 private:
  /// The same for the straight line in one direction.
  bool mayLeave(const Vec<D>& x, const Vec<D>& d, const NearWalls<D>& walls) const;

  class Ray;
  struct Start {
    int direction;
    double distance;
  };
  std::vector<Start> starts(const Vec<D>& x, const NearWalls<D>& walls) const;

  double spacing_, reach_, margin_;
  std::vector<Vec<D>> directions_;
  std::vector<std::vector<int>> around_;  // of each direction
};

extern template class CutSearch<2>;
extern template class CutSearch<3>;

}  // namespace treacle
