#pragma once

#include <cmath>

namespace treacle {

/// Sum of f(r) over the other points of a full cubic lattice in a cube around `radius`, r their distance [m]. Its
/// corners are further away: f is to be zero there.
template <int D, class F>
double latticeSum(double radius, double spacing, F&& f) {
  const int reach = static_cast<int>(std::ceil(radius / spacing));
  double sum = 0;
  for (int z = D == 3 ? -reach : 0; z <= (D == 3 ? reach : 0); ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x != 0 || y != 0 || z != 0) sum += f(spacing * std::sqrt(double(x * x + y * y + z * z)));
  return sum;
}

}  // namespace treacle
