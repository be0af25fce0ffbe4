#include "box.hpp"

#include <algorithm>
#include <limits>

namespace treacle {

Vec<3> Box::corner(int bits) const {
  Vec<3> x = min;
  for (int k = 0; k < 3; ++k)
    if (bits >> k & 1) x[k] = max[k];
  return x;
}

Box Box::joined(const Box& other) const {
  Box box = *this;
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(min[k], other.min[k]);
    box.max[k] = std::max(max[k], other.max[k]);
  }
  return box;
}

double Box::longestSide() const {
  const Vec<3> side = max - min;
  return std::max({side[0], side[1], side[2]});
}

Box boundsOf(const std::vector<Vec<3>>& position, double margin) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vec<3> half = Vec<3>::filled(margin);
  Box box{Vec<3>::filled(infinity), Vec<3>::filled(-infinity)};
  for (const Vec<3>& x : position) box = box.joined({x - half, x + half});
  return box;
}

}  // namespace treacle
