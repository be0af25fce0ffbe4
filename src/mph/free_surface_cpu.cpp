#include "treacle/mph/free_surface.hpp"

#include "treacle/mph/mph_lanes.hpp"

#include <cmath>

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

template <int D>
void surfaceArea(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceLack& surface, std::span<Vec<D>> lack,
                 std::span<double> area) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const auto forEachNeighbour = [&](auto&& body) {
      for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
        for (std::uint32_t j : list.segment(c, s)) body(PairLanes<D>(pairs, j, x, floor2));
    };
    VecLanes<D> sum = {};
    forEachNeighbour([&](const PairLanes<D>& pair) {
      const Lanes g = pairs.terms.gradient(pair.r);
      for (int k = 0; k < D; ++k) sum[k] += g * pair.d[k];
    });
    storeLanes<D>(range, sum, lack);
    double size[clusterSize];
    bool covered[clusterSize] = {}, lacksSome = false;
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      size[lane] = norm(lack[range.first + lane]);
      lacksSome |= surface.area(size[lane]) > 0;
    }
    if (lacksSome)
      forEachNeighbour([&](const PairLanes<D>& pair) {
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += pair.d[k] * sum[k];
        for (std::uint32_t lane = 0; lane < range.count; ++lane) {
          const double r = pair.r.square[lane] * pair.r.inverse[lane];
          covered[lane] |= r < pairs.terms.pressureRadius && SurfaceLack::covers(along[lane], size[lane], r);
        }
      });
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      area[range.first + lane] = covered[lane] ? 0 : surface.area(size[lane]);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                           \
  template SurfaceLack SurfaceLack::make<D>(const MphPairs<D>&);                                         \
  template void surfaceArea<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceLack&, std::span<Vec<D>>, \
                               std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
