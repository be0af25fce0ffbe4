#pragma once

#include "wall_part.hpp"

#include <array>
#include <vector>

namespace treacle {

/// A point where faces of different walls meet: a corner that fluid reaches into.
template <int D>
struct FaceCorner {
  Vec<D> way;        // from the particle to it [m]
  Vec<D> out;        // unit vector away from all the faces
  Vec<D> normal[D];  // of the faces there, in their order
};

/// Appends the points of N faces within reach that are nearer to x than the points around them where none of the
/// faces has a wall above. Planes have one at most; where round faces meet in several places, the search begins at
/// several points, and the same corner may come more than once.
template <int D, int N>
void findCorners(const Vec<D>& x, const std::array<const Face<D>*, N>& faces, double reach, double spacing,
                 std::vector<FaceCorner<D>>& corners);

extern template void findCorners<2, 2>(const Vec<2>&, const std::array<const Face<2>*, 2>&, double, double,
                                       std::vector<FaceCorner<2>>&);
extern template void findCorners<3, 2>(const Vec<3>&, const std::array<const Face<3>*, 2>&, double, double,
                                       std::vector<FaceCorner<3>>&);
extern template void findCorners<3, 3>(const Vec<3>&, const std::array<const Face<3>*, 3>&, double, double,
                                       std::vector<FaceCorner<3>>&);

}  // namespace treacle
