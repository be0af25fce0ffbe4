#include "treacle/mph/mph_balance.hpp"

#include "treacle/mph/mph_lanes.hpp"

#include <cmath>

namespace treacle {

namespace {

/// store(cluster's range, sum of c_ij (u_ij.e_ij)^2 over its particles' pairs, those of fluid by halves), with the
/// coefficient coefficientOf(range)(j, what the terms have for the pair).
template <int D, class CoefficientOf, class Store>
void sumShear(const MphPairs<D>& pairs, std::span<const Vec<D>> u, CoefficientOf&& coefficientOf, Store&& store) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const auto coefficient = coefficientOf(range);
    const VecLanes<D> ui = loadLanes<D>(range, u);
    const auto sum = [&](ListSegment segment, bool wall) {
      Lanes total = {};
      for (std::uint32_t j : list.segment(c, segment)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += (u[j][k] - ui[k]) * pair.d[k];
        along *= pair.r.inverse;
        Lanes resistance = coefficient(j, pairs.terms.resistanceShape(pair.r));
        if (wall) resistance *= wallFactors(pairs, range, j, pair.d);
        total += resistance * along * along;
      }
      return total;
    };
    const Lanes ofFluid = sum(ListSegment::NearFluid, false) + sum(ListSegment::FarFluid, false);
    store(range, 0.5 * ofFluid + sum(ListSegment::NearWall, true) + sum(ListSegment::FarWall, true));
  });
}

}  // namespace

template <int D>
void shearDissipation(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                      std::span<double> dissipation) {
  sumShear<D>(
      pairs, u,
      [&](const ClusterRange& range) {
        return [viscosity = ViscosityLanes<D>(pairs, range)](std::uint32_t j, const Lanes& shape) -> Lanes {
          return viscosity.with(j) * shape;
        };
      },
      [&](const ClusterRange& range, const Lanes& sum) { storeLanes(range, sum, dissipation); });
}

template <int D>
void shearRate(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u, std::span<const double> share,
               std::span<double> rate) {
  sumShear<D>(
      pairs, u,
      [](const ClusterRange&) { return [](std::uint32_t, const Lanes& shape) -> Lanes { return shape; }; },
      [&](const ClusterRange& range, const Lanes& sum) {
        for (std::uint32_t lane = 0; lane < range.count; ++lane) {
          const std::size_t i = range.first + lane;
          rate[i] = std::sqrt(pairs.terms.viscousFactor * sum[lane] * share[i]);
        }
      });
}

namespace {

template <bool Renormalised, int D>
void sumFluidAtWalls(const MphPairs<D>& pairs, const ClusterListView& walls, std::span<const Vec<D>> u,
                     std::span<const double> pressure, const FluidAtWalls<D>& out) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, walls, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    const VecLanes<D> ui = loadLanes<D>(range, u);
    const Lanes qi = loadLanes(range, pressure);
    VecLanes<D> force = {};
    Lanes divergence = {}, density = {};
    for (std::uint32_t j : walls.segment(c, ListSegment::NearFluid)) {
      const PairLanes<D> pair(pairs, j, x, floor2);
      Lanes along = {};
      for (int k = 0; k < D; ++k) along += (u[j][k] - ui[k]) * pair.d[k];
      const Lanes g = pairs.terms.gradient(pair.r);
      const Lanes viscous = pairs.terms.viscous(viscosity.with(j), pair.r) * wallFactors(pairs, range, j, pair.d);
      if constexpr (Renormalised) {
        const VecLanes<D> ofFluid = corrected(pairs, j, pair.d);
        const Lanes f = viscous * along - g * qi;
        for (int k = 0; k < D; ++k) force[k] += f * pair.d[k] - g * pressure[j] * ofFluid[k];
      } else {
        const Lanes f = viscous * along - g * (qi + pressure[j]);
        for (int k = 0; k < D; ++k) force[k] += f * pair.d[k];
      }
      divergence -= g * along;
      density += pairs.terms.density(pairs.terms.densityFactor, pair.r);
    }
    const ClusterRange wall(range.first - walls.first, range.first - walls.first + range.count);
    storeLanes<D>(wall, force, out.force);
    storeLanes(wall, divergence, out.divergence);
    storeLanes(wall, density, out.density);
  });
}

}  // namespace

template <int D>
void fluidAtWalls(Context<Cpu>&, const MphPairs<D>& pairs, const ClusterListView& walls, std::span<const Vec<D>> u,
                  std::span<const double> pressure, const FluidAtWalls<D>& out) {
  withRenormalisation(pairs,
                      [&]<bool Renormalised>() { sumFluidAtWalls<Renormalised>(pairs, walls, u, pressure, out); });
}

#define TREACLE_INSTANTIATE(D)                                                                                    \
  template void shearDissipation<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>,                   \
                                    std::span<double>);                                                           \
  template void shearRate<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<const double>, \
                             std::span<double>);                                                                  \
  template void fluidAtWalls<D>(Context<Cpu>&, const MphPairs<D>&, const ClusterListView&,                        \
                                std::span<const Vec<D>>, std::span<const double>, const FluidAtWalls<D>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
