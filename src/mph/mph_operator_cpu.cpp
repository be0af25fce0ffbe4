#include "treacle/mph/mph_operator.hpp"

#include "treacle/core/halo.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/mph_sums.hpp"

namespace treacle {
namespace {

/// Entries ahead that are asked for: the neighbours' scattered reads keep the hardware from seeing the stream.
constexpr std::uint64_t prefetchDistance = 32;

Lanes loadCoefficient(const Buffer<double>& values, std::uint64_t entry) {
  __builtin_prefetch(values.data() + (entry + prefetchDistance) * clusterSize);
  return load<Lanes>(values.data() + entry * clusterSize);
}

void storeCoefficient(Buffer<double>& values, std::uint64_t entry, const Lanes& lanes) {
  store(lanes, values.data() + entry * clusterSize);
}

/// Calls body.operator()<Wraps>(): within the domain no pair has to look for its nearest images.
template <class F>
void withImages(bool wraps, F&& body) {
  wraps ? body.template operator()<true>() : body.template operator()<false>();
}

/// x_j - x_i for the lanes of a cluster.
template <bool Wraps, int D>
VecLanes<D> difference(const MphPairs<D>& pairs, std::uint32_t j, const VecLanes<D>& x) {
  VecLanes<D> d;
  const Vec<D>& xj = pairs.position[j];  // broadcast from memory
  for (int k = 0; k < D; ++k) d[k] = xj[k] - x[k];
  if constexpr (Wraps) moveToNearest(pairs.grid, d.v);
  return d;
}

}  // namespace

template <int D>
void MphOperator<D, Cpu>::countEntries() {
  const ClusterListView& list = pairs_->fluidList;
  const std::uint32_t clusters = list.clusterCount();
  viscousStart_.resize(clusters + 1);
  pressureStart_.resize(clusters + 1);
  viscousStart_[0] = pressureStart_[0] = 0;
  for (std::uint32_t c = 0; c < clusters; ++c) {
    const auto size = [&](ListSegment s) { return list.segment(c, s).size(); };
    viscousStart_[c + 1] = viscousStart_[c] + size(ListSegment::NearFluid) + size(ListSegment::FarFluid);
    pressureStart_[c + 1] = pressureStart_[c] + size(ListSegment::NearFluid) + size(ListSegment::NearWall);
  }
  viscous_.resize(viscousStart_[clusters] * clusterSize);
  pressure_.resize(pressureStart_[clusters] * clusterSize);
}

template <int D>
void MphOperator<D, Cpu>::prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  terms_ = terms;
  q_.resize(pairs.activeCount);
  countEntries();
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    std::uint64_t nextViscous = viscousStart_[c], nextPressure = pressureStart_[c];
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid, ListSegment::NearWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        if (s != ListSegment::NearWall)
          storeCoefficient(viscous_, nextViscous++, pairs.terms.viscous(viscosity.with(j), pair.r));
        if (s != ListSegment::FarFluid) storeCoefficient(pressure_, nextPressure++, pairs.terms.gradient(pair.r));
      }
  });
}

template <int D>
void MphOperator<D, Cpu>::multiply(Context<Cpu>& context, std::span<const Vec<D>> own, std::span<Vec<D>> y) {
  const std::span<const Vec<D>> u = withGhosts(context, own, withGhosts_);
  withRenormalisation(*pairs_, [&]<bool Renormalised>() {
    viscosityAndDivergence<Renormalised>(u, y);
    wallDivergence(u);
    subtractBulkStressAlongWalls<D>(context, *pairs_, u, q_);
    fillGhosts(context, Held::Active, q_.data());
    addGradient<Renormalised>(y);
    subtractGradientAlongWalls<D>(context, *pairs_, q_, 1.0, y);
  });
}

/// y = (rho/dt I + V) u, and q = lambda C^T u on the fluid.
template <int D>
template <bool Renormalised>
void MphOperator<D, Cpu>::viscosityAndDivergence(std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> ui = loadLanes<D>(range, u);
    SymmetricBlock<D, Lanes> b;
    if constexpr (Renormalised) b = loadBlocks<Lanes>(range, pairs.renormalisation);
    VecLanes<D> force = {};  // minus the viscous part of A u
    Lanes divergence = {};
    withImages(list.special[c], [&]<bool Wraps>() {
      std::uint64_t nextViscous = viscousStart_[c], nextPressure = pressureStart_[c];
      const auto add = [&](std::uint32_t j, bool near) {
        const VecLanes<D> d = difference<Wraps, D>(pairs, j, x.x);
        const Vec<D>& uj = u[j];
        Lanes along = (uj[0] - ui[0]) * d[0];
        for (int k = 1; k < D; ++k) along += (uj[k] - ui[k]) * d[k];
        if (near) {
          const Lanes g = loadCoefficient(pressure_, nextPressure++);
          if constexpr (Renormalised) {
            Lanes alongB = (uj[0] - ui[0]) * b.row(0, d);
            for (int k = 1; k < D; ++k) alongB += (uj[k] - ui[k]) * b.row(k, d);
            divergence -= g * alongB;
          } else {
            divergence -= g * along;
          }
        }
        const Lanes f = loadCoefficient(viscous_, nextViscous++) * along;
        for (int k = 0; k < D; ++k) force[k] += f * d[k];
      };
      for (std::uint32_t j : list.segment(c, ListSegment::NearFluid)) add(j, true);
      for (std::uint32_t j : list.segment(c, ListSegment::FarFluid)) add(j, false);
    });
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      Vec<D> yi = terms_.block[i] * u[i];
      for (int k = 0; k < D; ++k) yi[k] -= force[k][lane];
      y[i] = yi;
      // Walls at rest: (0 - u_i).e w' B_i summed over walls = u_i.B_i (sum of -e w').
      q_[i] = pairs.bulkViscosity(i) * (divergence[lane] + dot(u[i], terms_.gradient[i]));
    }
  });
}

/// q = lambda C^T u on the walls; they are few, so their coefficients are not kept.
template <int D>
void MphOperator<D, Cpu>::wallDivergence(std::span<const Vec<D>> u) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterListView& list = pairs.wallList;
  const double floor2 = distanceFloor2(pairs);
  parallelFor(list.clusterCount(), parallelGrain / clusterSize, [&](std::size_t c) {
    const ClusterRange range(list, static_cast<std::uint32_t>(c));
    const auto entries = list.segment(static_cast<std::uint32_t>(c), ListSegment::NearFluid);
    Lanes sum = {};
    if (!entries.empty()) {
      const ClusterPlaces<D> x(pairs, list, range, static_cast<std::uint32_t>(c));
      for (std::uint32_t j : entries) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += u[j][k] * pair.d[k];
        sum -= pairs.terms.gradient(pair.r) * along;
      }
      for (std::uint32_t lane = 0; lane < range.count; ++lane)
        sum[lane] *= pairs.bulkViscosity(range.first + lane);
    }
    storeLanes(range, sum, q_);
  });
}

/// y += C q
template <int D>
template <bool Renormalised>
void MphOperator<D, Cpu>::addGradient(std::span<Vec<D>> y) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const Lanes qi = loadLanes(range, q_.span());
    VecLanes<D> sum = {};
    withImages(list.special[c], [&]<bool Wraps>() {
      std::uint64_t next = pressureStart_[c];
      if constexpr (Renormalised) {
        VecLanes<D> own = {};  // of g d, which meets the particle's own q_i B_i
        const auto add = [&](std::uint32_t j, bool wall) {
          const Lanes g = loadCoefficient(pressure_, next++);
          VecLanes<D> gd = difference<Wraps, D>(pairs, j, x.x), gqd;
          for (int k = 0; k < D; ++k) {
            gd[k] *= g;
            own[k] += gd[k];
            gqd[k] = q_[j] * gd[k];
          }
          for (int k = 0; k < D; ++k) sum[k] += wall ? gqd[k] : pairs.renormalisation[j].row(k, gqd);
        };
        for (std::uint32_t j : list.segment(c, ListSegment::NearFluid)) add(j, false);
        for (std::uint32_t j : list.segment(c, ListSegment::NearWall)) add(j, true);
        const SymmetricBlock<D, Lanes> b = loadBlocks<Lanes>(range, pairs.renormalisation);
        for (int k = 0; k < D; ++k) sum[k] += qi * b.row(k, own);
        return;
      }
      for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
        for (std::uint32_t j : list.segment(c, s)) {
          const Lanes f = loadCoefficient(pressure_, next++) * (qi + q_[j]);
          const VecLanes<D> d = difference<Wraps, D>(pairs, j, x.x);
          for (int k = 0; k < D; ++k) sum[k] += f * d[k];
        }
    });
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      for (int k = 0; k < D; ++k) y[range.first + lane][k] += sum[k][lane];
  });
}

template class MphOperator<2, Cpu>;
template class MphOperator<3, Cpu>;

}  // namespace treacle
