#include "lane_sums.hpp"
#include "treacle/mph/free_surface_sums.hpp"

namespace treacle {

/// The lattice points behind a plane through its first layer.
template <int D>
SurfaceLack SurfaceLack::make(const MphPairs<D>& pairs) {
  const double l = pairs.spacing;
  const int reach = static_cast<int>(pairs.terms.pressureRadius / l) + 1;
  double lack = 0;
  for (int depth = 1; depth <= reach; ++depth)
    for (int a = -reach; a <= reach; ++a)
      for (int b = D == 3 ? -reach : 0; b <= (D == 3 ? reach : 0); ++b)
        lack += pairs.terms.gradient(ExactDistance(l * l * (depth * depth + a * a + b * b))) * depth * l;
  return {lack, l};
}

template SurfaceLack SurfaceLack::make(const MphPairs<2>&);
template SurfaceLack SurfaceLack::make(const MphPairs<3>&);

TREACLE_FREE_SURFACE_SUMS(2, Cpu)
TREACLE_FREE_SURFACE_SUMS(3, Cpu)

}  // namespace treacle
