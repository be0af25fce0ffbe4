#include "treacle/method/mph_operator.hpp"

#include "pair_lanes.hpp"

namespace treacle {
namespace {

/// Entries ahead that are asked for: the neighbours' scattered reads keep the hardware from seeing the stream.
constexpr std::uint64_t prefetchDistance = 32;

Lanes loadCoefficient(const Buffer<double>& values, std::uint64_t entry) {
  Lanes lanes;
  __builtin_prefetch(values.data() + (entry + prefetchDistance) * clusterSize);
  std::memcpy(&lanes, values.data() + entry * clusterSize, sizeof(lanes));
  return lanes;
}

void storeCoefficient(Buffer<double>& values, std::uint64_t entry, Lanes lanes) {
  std::memcpy(values.data() + entry * clusterSize, &lanes, sizeof(lanes));
}

/// Calls body.operator()<Wraps>(): a list that means no periodic image needs neither codes nor shifts.
template <class F>
void withImages(bool wraps, F&& body) {
  wraps ? body.template operator()<true>() : body.template operator()<false>();
}

template <bool Wraps>
std::uint32_t indexOf(ListEntry e) {
  return Wraps ? e.index() : e.bits;
}

/// x_j - x_i for the lanes of a cluster.
template <bool Wraps, int D>
VecLanes<D> difference(const MphPairs<D>& pairs, ListEntry e, const VecLanes<D>& x) {
  VecLanes<D> d;
  if constexpr (Wraps) {
    const Vec<D> xj = pairs.positionOf(e);
    for (int k = 0; k < D; ++k) d[k] = xj[k] - x[k];
  } else {
    const Vec<D>& xj = pairs.position[e.bits];  // broadcast from memory
    for (int k = 0; k < D; ++k) d[k] = xj[k] - x[k];
  }
  return d;
}

/// (1/r - 1/h_v) / r^2, without viscosity and factor.
template <int D>
Lanes viscousCoefficient(const MphPairs<D>& pairs, Lanes inverseR) {
  return reach(inverseR, pairs.viscosity) * (inverseR * inverseR);
}

}  // namespace

template <int D>
void MphOperator<D>::countEntries() {
  const ClusterList<>& list = *pairs_->fluidList;
  const std::uint32_t clusters = list.clusterCount();
  nearStart_.resize(clusters + 1);
  farStart_.resize(clusters + 1);
  nearStart_[0] = farStart_[0] = 0;
  for (std::uint32_t c = 0; c < clusters; ++c) {
    const auto size = [&](ListSegment s) { return list.segment(c, s).size(); };
    nearStart_[c + 1] = nearStart_[c] + size(ListSegment::NearFluid) + size(ListSegment::NearWall);
    farStart_[c + 1] = farStart_[c] + size(ListSegment::FarFluid);
  }
  near_.resize(nearStart_[clusters] * clusterSize);
  far_.resize(farStart_[clusters] * clusterSize);
}

template <int D>
void MphOperator<D>::prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  terms_ = terms;
  q_.resize(pairs.activeCount);
  countEntries();
  const double floor2 = distanceFloor2(pairs);
  const ClusterList<>& list = *pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const VecLanes<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    std::uint64_t next = nearStart_[c];
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
      for (ListEntry e : list.segment(c, s))
        storeCoefficient(near_, next++, PairLanes<D>(pairs.positionOf(e), x, floor2).inverseR);
    next = farStart_[c];
    for (ListEntry e : list.segment(c, ListSegment::FarFluid)) {
      const PairLanes<D> pair(pairs.positionOf(e), x, floor2);
      storeCoefficient(far_, next++,
                       viscosity.ofMaterial[pairs.material[e.index()]] * viscousCoefficient(pairs, pair.inverseR));
    }
  });
}

template <int D>
void MphOperator<D>::multiply(Context<Cpu>&, std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  viscosityAndDivergence(u, y);
  wallDivergence(u);
  addGradient(y);
}

/// y = (rho/dt I + V) u, and q = lambda C^T u on the fluid.
template <int D>
void MphOperator<D>::viscosityAndDivergence(std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterList<>& list = *pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const VecLanes<D>& x, std::uint32_t c) {
    const VecLanes<D> ui = loadLanes<D>(range, u);
    VecLanes<D> force = {};  // minus the viscous part of A u
    Lanes divergence = {};
    const ViscosityLanes<D> viscosity(pairs, range);
    withImages(list.wraps[c], [&]<bool Wraps>() {
      const auto along = [&](std::uint32_t j, const VecLanes<D>& d) {
        Lanes sum = (u[j][0] - ui[0]) * d[0];
        for (int k = 1; k < D; ++k) sum += (u[j][k] - ui[k]) * d[k];
        return sum;
      };
      std::uint64_t next = nearStart_[c];
      for (ListEntry e : list.segment(c, ListSegment::NearFluid)) {
        const std::uint32_t j = indexOf<Wraps>(e);
        const VecLanes<D> d = difference<Wraps, D>(pairs, e, x);
        const Lanes s = along(j, d), inverseR = loadCoefficient(near_, next++);
        divergence -= reach(inverseR, pairs.pressure) * s;
        const Lanes f = viscosity.ofMaterial[pairs.material[j]] * viscousCoefficient(pairs, inverseR) * s;
        for (int k = 0; k < D; ++k) force[k] += f * d[k];
      }
      next = farStart_[c];
      for (ListEntry e : list.segment(c, ListSegment::FarFluid)) {
        const VecLanes<D> d = difference<Wraps, D>(pairs, e, x);
        const Lanes f = loadCoefficient(far_, next++) * along(indexOf<Wraps>(e), d);
        for (int k = 0; k < D; ++k) force[k] += f * d[k];
      }
    });
    divergence *= pairs.pressure.factor;
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      Vec<D> yi = terms_.block[i] * u[i];
      for (int k = 0; k < D; ++k) yi[k] -= force[k][lane];
      y[i] = yi;
      // Walls at rest: (0 - u_i).e w' summed over walls = u_i.(sum of -e w').
      q_[i] =
          pairs.materials.bulkViscosity[pairs.material[i]] * (divergence[lane] + dot(u[i], terms_.gradient[i]));
    }
  });
}

/// q = lambda C^T u on the walls; they are few, so their coefficients are not kept.
template <int D>
void MphOperator<D>::wallDivergence(std::span<const Vec<D>> u) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterList<>& list = *pairs.wallList;
  const double floor2 = distanceFloor2(pairs);
  parallelFor(list.clusterCount(), parallelGrain / clusterSize, [&](std::size_t c) {
    const ClusterRange range(list, static_cast<std::uint32_t>(c));
    const auto entries = list.segment(static_cast<std::uint32_t>(c), ListSegment::NearFluid);
    Lanes sum = {};
    if (!entries.empty()) {
      const VecLanes<D> x = loadPositions<D>(range, pairs.position, pairs.grid);
      for (ListEntry e : entries) {
        const PairLanes<D> pair(pairs.positionOf(e), x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += u[e.index()][k] * pair.d[k];
        sum -= pairs.pressure.factor * pair.reach(pairs.pressure) * along;
      }
      for (std::uint32_t lane = 0; lane < range.count; ++lane)
        sum[lane] *= pairs.materials.bulkViscosity[pairs.material[range.first + lane]];
    }
    storeLanes(range, sum, q_);
  });
}

/// y += C q
template <int D>
void MphOperator<D>::addGradient(std::span<Vec<D>> y) {
  const MphPairs<D>& pairs = *pairs_;
  const ClusterList<>& list = *pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const VecLanes<D>& x, std::uint32_t c) {
    const Lanes qi = loadLanes(range, q_.span());
    VecLanes<D> sum = {};
    withImages(list.wraps[c], [&]<bool Wraps>() {
      std::uint64_t next = nearStart_[c];
      for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
        for (ListEntry e : list.segment(c, s)) {
          const Lanes inverseR = loadCoefficient(near_, next++);
          const Lanes f = reach(inverseR, pairs.pressure) * (qi + q_[indexOf<Wraps>(e)]);
          const VecLanes<D> d = difference<Wraps, D>(pairs, e, x);
          for (int k = 0; k < D; ++k) sum[k] += f * d[k];
        }
    });
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      for (int k = 0; k < D; ++k) y[range.first + lane][k] += pairs.pressure.factor * sum[k][lane];
  });
}

template class MphOperator<2>;
template class MphOperator<3>;

}  // namespace treacle
