#include "treacle/io/frames/arrangement.hpp"

#include "compare/nearest_points.hpp"
#include "particle_cells.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace treacle {
namespace {

/// Places that a density is the mean of: the scatter of their mean is far below 0.1 %.
constexpr std::size_t mostPlaces = 20'000;
constexpr int blockReach = 2;  // cells on either side of the one around whose middle particles are counted

std::vector<double> nearestDistances(const ParticleCells& cells, std::size_t fluidCount, double spacing) {
  std::vector<double> distances(fluidCount);
  parallelFor(cells.size(), parallelGrain, [&](std::size_t cell) {
    std::array<std::array<std::size_t, 2>, 9> rows;  // of points
    std::size_t rowCount = 0;
    const auto addRow = [&](std::size_t first, std::size_t last) {
      rows[rowCount++] = {cells.begin(first), cells.begin(last)};
    };
    cells.forEachRow(cell, 1, addRow);
    for (std::size_t i = cells.begin(cell); i < cells.begin(cell + 1); ++i) {
      const ParticleCells::Point& p = cells.point(i);
      if (!p.isParticle()) continue;
      double least2 = std::numeric_limits<double>::infinity();
      for (std::size_t r = 0; r < rowCount; ++r)
        for (std::size_t j = rows[r][0]; j < rows[r][1]; ++j)
          if (j != i) least2 = std::min(least2, norm2(cells.point(j).position - p.position));
      distances[p.index] = std::min(std::sqrt(least2) / spacing, nearestReach);
    }
  });
  return distances;
}

bool touchesWalls(const ParticleCells& cells, double reach) {
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    bool touches = false;
    for (std::size_t i = cells.begin(cell); i < cells.begin(cell + 1) && !touches; ++i) {
      if (cells.point(i).index != ParticleCells::wall) continue;
      cells.forEachRow(cell, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t j = cells.begin(first); j < cells.begin(last); ++j)
          touches = touches || (cells.point(j).isParticle() &&
                                norm2(cells.point(j).position - cells.point(i).position) < reach * reach);
      });
    }
    if (touches) return true;
  }
  return false;
}

/// Particles around a place, weighted by distance and over their number in a lattice. The weight is Wendland's C2,
/// (1-q)^4 (1+4q), whose sum over a lattice hardly depends on where in it the place lies.
template <int D>
struct PlaceDensity {
  const ParticleCells& cells;
  double radius, scale;  // [m], [-]

  static PlaceDensity make(const ParticleCells& cells, double spacing) {
    constexpr double pi = std::numbers::pi, integral = D == 2 ? pi / 7 : 2 * pi / 21;  // in units of the radius
    const double inSpacings = (blockReach + 0.5) * nearestReach;
    return {cells, inSpacings * spacing, 1 / (integral * std::pow(inSpacings, D))};
  }

  /// In the middle of a cell; 0 where not all cells of the block around it hold fluid, or one holds a wall.
  double operator()(std::size_t cell) const {
    const Vec<3> middle = cells.middle(cell);
    bool inside = true;
    double sum = 0;
    cells.forEachRow(cell, blockReach, [&](std::size_t first, std::size_t last) {
      inside = inside && last - first == 2 * blockReach + 1;
      for (std::size_t i = cells.begin(first); inside && i < cells.begin(last); ++i) {
        const ParticleCells::Point& p = cells.point(i);
        inside = p.index != ParticleCells::wall;
        const double q = norm(p.position - middle) / radius, s = 1 - q;
        if (s > 0) sum += s * s * s * s * (1 + 4 * q);
      }
    });
    return inside ? scale * sum : 0;
  }
};

/// At places and not at particles: the mean over particles that clump would be too large.
struct DensitySum {
  double sum = 0;
  std::size_t places = 0, stride = 1;  // one of so many places was looked at

  std::optional<double> mean() const {
    if (places == 0) return std::nullopt;
    return sum / static_cast<double>(places);
  }
};

template <int D>
DensitySum densityInside(const ParticleCells& cells, double spacing) {
  const auto density = PlaceDensity<D>::make(cells, spacing);
  DensitySum result;
  result.stride = cells.size() / mostPlaces + 1;
  std::vector<double> found((cells.size() + result.stride - 1) / result.stride);
  parallelFor(found.size(), parallelGrain, [&](std::size_t k) { found[k] = density(k * result.stride); });
  for (const double d : found) result.sum += d, result.places += d > 0;
  return result;
}

DensitySum densityInside(const ParticleCells& cells, int dimensions, double spacing) {
  return dimensions == 2 ? densityInside<2>(cells, spacing) : densityInside<3>(cells, spacing);
}

std::uint64_t closeOnes(std::span<const double> distances) {
  return static_cast<std::uint64_t>(std::ranges::count_if(distances, [](double d) { return d < closeDistance; }));
}

/// The index of the 1 % quantile among so many sorted values.
std::size_t lowPlace(std::size_t count) { return (count - 1) / 100; }

}  // namespace

Arrangement measureArrangement(Frame& fluid, const Frame& walls, const Domain& domain, double spacing) {
  Arrangement result;
  fluid.nearestDistance.clear();
  if (fluid.position.empty()) return result;
  const ParticleCells cells(fluid, walls, {}, domain, nearestReach * spacing);
  fluid.nearestDistance = nearestDistances(cells, fluid.position.size(), spacing);
  result.touchesWalls = touchesWalls(cells, nearestReach * spacing);
  result.density = densityInside(cells, fluid.dimensions, spacing).mean();
  std::vector<double> sorted = fluid.nearestDistance;
  const auto low = sorted.begin() + static_cast<std::ptrdiff_t>(lowPlace(sorted.size()));
  std::nth_element(sorted.begin(), low, sorted.end());
  result.close = static_cast<double>(closeOnes(sorted)) / static_cast<double>(sorted.size());
  result.low = *low, result.least = *std::min_element(sorted.begin(), low + 1);
  return result;
}

double distanceToWalls(const Frame& fluid, const Frame& walls, const Domain& domain) {
  double least2 = std::numeric_limits<double>::infinity();
  if (fluid.position.empty() || walls.position.empty()) return least2;
  for (const NearestPoint& p : nearestPoints(fluid.position, walls.position, domain))
    least2 = std::min(least2, p.distance2);
  return std::sqrt(least2);
}

ArrangementPart measureArrangementPart(Frame& fluid, std::span<const Vec<3>> others, const Domain& domain,
                                       double spacing) {
  ArrangementPart part;
  part.distances.resize(static_cast<std::size_t>(std::lround(nearestReach / ArrangementPart::bin)) + 1);
  fluid.nearestDistance.clear();
  if (fluid.position.empty()) return part;
  const ParticleCells cells(fluid, {}, others, domain, nearestReach * spacing);
  fluid.nearestDistance = nearestDistances(cells, fluid.position.size(), spacing);
  const DensitySum density = densityInside(cells, fluid.dimensions, spacing);
  part.density = density.sum * static_cast<double>(density.stride);
  part.places = density.places * density.stride;
  part.close = closeOnes(fluid.nearestDistance);
  for (const double d : fluid.nearestDistance) {
    part.least = std::min(part.least, d);
    ++part.distances[std::min(static_cast<std::size_t>(d / ArrangementPart::bin), part.distances.size() - 1)];
  }
  return part;
}

Arrangement arrangementOf(const ArrangementPart& all) {
  Arrangement result;
  const std::uint64_t count = std::accumulate(all.distances.begin(), all.distances.end(), std::uint64_t{0});
  if (count == 0) return result;
  std::size_t bin = 0;
  for (std::uint64_t upTo = all.distances[0]; upTo <= lowPlace(count); upTo += all.distances[bin]) ++bin;
  result.least = all.least;
  result.low = std::clamp((static_cast<double>(bin) + 0.5) * ArrangementPart::bin, all.least, nearestReach);
  result.close = static_cast<double>(all.close) / static_cast<double>(count);
  if (all.places > 0) result.density = all.density / static_cast<double>(all.places);
  return result;
}

}  // namespace treacle
