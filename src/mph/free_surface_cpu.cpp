#include "lane_sums.hpp"
#include "treacle/mph/free_surface_sums.hpp"

#include <algorithm>

namespace treacle {

/// The radius is that for which areas were measured, unless the sums of the case do not reach as far.
template <int D>
SurfaceColour<D> SurfaceColour<D>::make(const MphPairs<D>& pairs) {
  const MphTerms<D>& t = pairs.terms;
  const double l = pairs.spacing,
               h = std::min(3.5 * l, std::max({t.pressureRadius, t.densityRadius, t.viscosityRadius}));
  SurfaceColour colour{1 / (h * h)};
  // Sums over the lattice behind a plane so many rows above the particle, or all of it.
  const int reach = static_cast<int>(h / l);
  struct Sums {
    double colour = 0, slope = 0;
  };
  const auto below = [&](int rows) {
    Sums sums;
    for (int x = -reach; x <= std::min(rows, reach); ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = D == 3 ? -reach : 0; z <= (D == 3 ? reach : 0); ++z) {
          const auto part = colour.part(ExactDistance(l * l * (x * x + y * y + z * z)));
          sums.colour += weight(part);
          sums.slope -= colour.slope(part) * x * l;
        }
    return sums;
  };
  colour.scale = 1 / below(reach).colour;
  double flat = 0;
  for (int row = 0; row < reach; ++row) {
    const Sums sums = below(row);
    flat += l * colour.area(colour.scale * sums.colour, colour.scale * sums.slope);
  }
  colour.factor = 1 / flat;
  return colour;
}

template struct SurfaceColour<2>;
template struct SurfaceColour<3>;

TREACLE_FREE_SURFACE_SUMS(2, Cpu)
TREACLE_FREE_SURFACE_SUMS(3, Cpu)

}  // namespace treacle
