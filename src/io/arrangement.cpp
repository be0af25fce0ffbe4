#include "treacle/io/arrangement.hpp"

#include "particle_cells.hpp"
#include "treacle/core/parallel.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

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
template <int D>
std::optional<double> densityInside(const ParticleCells& cells, double spacing) {
  const auto density = PlaceDensity<D>::make(cells, spacing);
  const std::size_t stride = cells.size() / mostPlaces + 1;
  std::vector<double> found((cells.size() + stride - 1) / stride);
  parallelFor(found.size(), parallelGrain, [&](std::size_t k) { found[k] = density(k * stride); });
  double sum = 0;
  std::size_t places = 0;
  for (const double d : found) sum += d, places += d > 0;
  if (places == 0) return std::nullopt;
  return sum / static_cast<double>(places);
}

}  // namespace

Arrangement measureArrangement(Frame& fluid, const Frame& walls, const Domain& domain, double spacing) {
  Arrangement result;
  fluid.nearestDistance.clear();
  if (fluid.position.empty()) return result;
  const ParticleCells cells(fluid, walls, domain, nearestReach * spacing);
  fluid.nearestDistance = nearestDistances(cells, fluid.position.size(), spacing);
  result.density = fluid.dimensions == 2 ? densityInside<2>(cells, spacing) : densityInside<3>(cells, spacing);
  std::vector<double> sorted = fluid.nearestDistance;
  const auto low = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 100);
  std::nth_element(sorted.begin(), low, sorted.end());
  const auto close = std::count_if(sorted.begin(), sorted.end(), [](double d) { return d < closeDistance; });
  result.close = static_cast<double>(close) / static_cast<double>(sorted.size());
  result.low = *low, result.least = *std::min_element(sorted.begin(), low + 1);
  return result;
}

}  // namespace treacle
