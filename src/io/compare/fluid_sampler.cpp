#include "fluid_sampler.hpp"

#include "treacle/core/block.hpp"
#include "treacle/model/case/probe.hpp"
#include "treacle/model/particles/smoothing_kernel.hpp"

#include <cmath>
#include <limits>

namespace treacle {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Particles are cubes: at the corner of one its centre is 0.87 spacings away.
constexpr double nearestInFluid = 1;

/// Over probeReach; its integral over the space is 1, lengths being in spacings.
double weightAt(double distance, int dimensions) {
  const auto kernel = [&]<int D>() { return SmoothingKernel<D>::make(KernelKind::WendlandC2, probeReach / 2); };
  return dimensions == 2 ? kernel.operator()<2>().value(distance) : kernel.operator()<3>().value(distance);
}

}  // namespace

FluidSampler::FluidSampler(const Frame& fluid, const Frame& walls, const Domain& domain, double spacing)
    : fluid_(fluid),
      dimensions_(fluid.dimensions),
      spacing_(spacing),
      shifts_(imageShifts(domain)),
      fluidPoints_(fluid.position),
      wallPoints_(walls.position) {}

std::vector<FluidSampler::Neighbour> FluidSampler::neighbours(const Points& points, const Vec<3>& x) const {
  std::vector<Neighbour> found;
  std::vector<std::pair<std::size_t, double>> matches;
  const double reach = probeReach * spacing_;
  if (points.set.points.empty()) return found;
  for (const Vec<3>& shift : shifts_) {
    const Vec<3> image = x + shift;
    points.tree.radiusSearch(image.v, reach * reach, matches, {});
    for (const auto& [index, distance2] : matches)
      if (const double weight = weightAt(std::sqrt(distance2) / spacing_, dimensions_); weight > 0)
        found.push_back({index, (1 / spacing_) * (points.set.points[index] - image), weight});
  }
  return found;
}

/// The fit is about the mean place of the neighbours. Where they lie in a plane nothing is known of what is across
/// it: a small variance that is added lets the fit be constant there.
FluidSample FluidSampler::at(const Vec<3>& x) const {
  constexpr double leastVariance = 1e-3;  // [spacings2]
  const std::vector<Neighbour> near = neighbours(fluidPoints_, x);
  double sum = 0;
  bool inside = false;
  Vec<3> mean{};
  for (const Neighbour& n : near) {
    sum += n.weight, mean += n.weight * n.way;
    inside = inside || norm(n.way) <= nearestInFluid;
  }
  if (!inside) return {{none, none, none}, none, none, none, none};
  mean *= 1 / sum;
  Block<3> variance = Block<3>::diagonal(leastVariance);  // in the plane all there is along z
  for (const Neighbour& n : near) variance.addOuter(n.weight / sum, n.way - mean, n.way - mean);
  // What is fitted is a sum of values: each counts by its weight and by where it is.
  const Vec<3> slope = inverse(variance) * -mean;
  const auto fitted = [&](auto&& value, auto zero) {
    for (const Neighbour& n : near) zero += n.weight / sum * (1 + dot(slope, n.way - mean)) * value(n.index);
    return zero;
  };
  const auto field = [&](const std::vector<double>& values) {
    return values.empty() ? none : fitted([&](std::size_t k) { return values[k]; }, 0.0);
  };
  return {fitted([&](std::size_t k) { return fluid_.velocity[k]; }, Vec<3>{}), field(fluid_.pressure),
          field(fluid_.dynamicViscosity), field(fluid_.shearRate), field(fluid_.temperature)};
}

double FluidSampler::filled(const Points& points, const Vec<3>& x) const {
  double sum = 0;
  for (const Neighbour& n : neighbours(points, x)) sum += n.weight;
  return sum;
}

double FluidSampler::fraction(const Vec<3>& x) const {
  constexpr double leastSpace = 0.05;  // beyond which a place is in the wall
  const double space = 1 - filled(wallPoints_, x);
  return space < leastSpace ? 0 : std::fmin(filled(fluidPoints_, x) / space, 1);
}

double FluidSampler::extent(const Vec<3>& from, const Vec<3>& to) const {
  const double length = norm(to - from);
  const int parts = static_cast<int>(std::ceil(4 * length / spacing_));
  const auto isFluid = [&](double share) { return fraction(from + share * (to - from)) >= 0.5; };
  for (int k = parts; k >= 0; --k) {
    double low = static_cast<double>(k) / parts, high = static_cast<double>(k + 1) / parts;
    if (!isFluid(low)) continue;
    if (k == parts) return length;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = 0.5 * (low + high);
      (isFluid(middle) ? low : high) = middle;
    }
    return low * length;
  }
  return 0;
}

}  // namespace treacle
