#include "treacle/mph/conduction.hpp"

#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/viscosity_scale.hpp"

namespace treacle {

std::vector<WallHeat> wallHeat(const Case& c) {
  std::vector<WallHeat> walls;
  for (const Body& body : c.bodies)
    walls.push_back({body.kind == BodyKind::Fluid ? 0 : body.temperature,
                     body.wallConductance > 0 ? 1 / body.wallConductance : 0});
  return walls;
}

HeatTable HeatTable::make(const Case& c) {
  HeatTable t{};
  for (std::size_t a = 0; a < c.materials.size(); ++a) {
    const Material& m = c.materials[a];
    t.conductivity[a] = m.conductivity;
    t.capacity[a] = m.density * m.specificHeat;
    t.emissivity[a] = m.emissivity;
    for (std::size_t b = 0; b < c.materials.size(); ++b) {
      const double other = c.materials[b].conductivity, sum = m.conductivity + other;
      t.pairConductivity[a][b] = sum > 0 ? 2 * m.conductivity * other / sum : 0;
    }
  }
  return t;
}

namespace {

/// kappa_ij of the fluid particles of a cluster with another one, over what the terms have for the pair.
template <int D>
class ConductivityLanes {
 public:
  ConductivityLanes(const MphPairs<D>& pairs, const Conduction& terms, const ClusterRange& range)
      : pairs_(pairs), terms_(terms) {
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) {
      const std::uint32_t i = range.particle(lane);
      substance_[lane] = pairs.substance(i);
      scale_[lane] = terms.scale[i];
    }
  }
  Lanes with(std::uint32_t j) const {
    Lanes k;
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      k[lane] = terms_.ofFluid(substance_[lane], pairs_.substance(j), scale_[lane], terms_.scale[j]);
    return k;
  }

 private:
  const MphPairs<D>& pairs_;
  const Conduction& terms_;
  Substance substance_[clusterSize];
  Lanes scale_;
};

template <int D>
double laplacianFactor(const MphPairs<D>& pairs) {
  return pairs.terms.viscousFactor / (D + 2);
}

}  // namespace

template <int D>
void conductionScale(Context<Cpu>&, const MphPairs<D>& pairs, const Conduction& terms, std::span<double> scale) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    Lanes sum = {};
    const auto add = [&](std::uint32_t j) {
      const PairLanes<D> pair(pairs, j, x, floor2);
      Lanes r2 = {};
      for (int k = 0; k < D; ++k) r2 += pair.d[k] * pair.d[k];
      sum += pairs.terms.resistanceShape(pair.r) * r2;
    };
    for (ListSegment s : fluidSegments)
      for (std::uint32_t j : list.segment(c, s)) add(j);
    for (ListSegment s : wallSegments)
      for (std::uint32_t j : list.segment(c, s))
        if (terms.conducts(j)) add(j);
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      scale[range.first + lane] = viscosityScaleOf<D>(pairs.terms.viscousFactor * sum[lane], 1);
  });
}

template <int D>
void conductionDiagonal(Context<Cpu>&, const MphPairs<D>& pairs, const Conduction& terms,
                        std::span<double> ofFluid, std::span<HeatExchange> ofWalls) {
  const double floor2 = distanceFloor2(pairs), factor = laplacianFactor(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ConductivityLanes<D> conductivity(pairs, terms, range);
    Lanes sum = {}, coefficient = {}, gain = {};
    for (ListSegment s : fluidSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes kappa = conductivity.with(j) * pairs.terms.resistanceShape(pair.r);
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          if (range.particle(lane) == j) kappa[lane] = 0;  // itself
        sum += kappa;
      }
    for (ListSegment s : wallSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        if (!terms.conducts(j)) continue;
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes shape = pairs.terms.resistanceShape(pair.r);
        for (std::uint32_t lane = 0; lane < range.count; ++lane) {
          Vec<D> d;
          for (int k = 0; k < D; ++k) d[k] = pair.d[k][lane];
          const double kappa = terms.ofWall(pairs, range.particle(lane), j, d) * shape[lane];
          coefficient[lane] += kappa;
          gain[lane] += kappa * terms.walls[terms.body[j]].temperature;
        }
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      ofFluid[range.first + lane] = factor * sum[lane];
      ofWalls[range.first + lane] = {factor * coefficient[lane], factor * gain[lane]};
    }
  });
}

template <int D>
void conduct(Context<Cpu>&, const MphPairs<D>& pairs, const Conduction& terms, std::span<const double> extra,
             std::span<const double> T, std::span<double> y) {
  const double floor2 = distanceFloor2(pairs), factor = laplacianFactor(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ConductivityLanes<D> conductivity(pairs, terms, range);
    const Lanes own = loadLanes(range, T);
    Lanes sum = {};
    for (ListSegment s : fluidSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        sum += conductivity.with(j) * pairs.terms.resistanceShape(pair.r) * (own - T[j]);
      }
    storeLanes(range, loadLanes(range, extra) * own + factor * sum, y);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void conductionScale<D>(Context<Cpu>&, const MphPairs<D>&, const Conduction&, std::span<double>);   \
  template void conductionDiagonal<D>(Context<Cpu>&, const MphPairs<D>&, const Conduction&, std::span<double>, \
                                      std::span<HeatExchange>);                                                \
  template void conduct<D>(Context<Cpu>&, const MphPairs<D>&, const Conduction&, std::span<const double>,      \
                           std::span<const double>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
