#include "nozzle_lattice.hpp"

#include "geometry/facet_tree.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace treacle {
namespace {

/// The places i + shift along each axis that lie in [-most, most] and are kept, in spacings.
template <int N, class Keep>
std::vector<Vec<N>> latticeOf(const Vec<N>& most, const Vec<N>& shift, Keep&& keep) {
  std::vector<Vec<N>> places;
  Vec<N> x;
  const auto along = [&](auto&& self, int k) -> void {
    if (k < 0) {
      if (keep(x)) places.push_back(x);
      return;
    }
    for (x[k] = std::ceil(-most[k] - shift[k]) + shift[k]; x[k] <= most[k]; ++x[k]) self(self, k - 1);
  };
  along(along, N - 1);
  return places;
}

/// A whole number of particles along each side, at least one, about the middle.
template <int N>
std::vector<Vec<N>> rectangleOf(const Vec<N>& sides) {
  Vec<N> most, shift;
  for (int k = 0; k < N; ++k) {
    const double count = std::max(1.0, std::round(sides[k]));
    most[k] = (count - 1) / 2 + 1e-6;
    shift[k] = std::fmod(count, 2) == 0 ? 0.5 : 0;
  }
  return latticeOf<N>(most, shift, [](const Vec<N>&) { return true; });
}

/// The lattice with or without a particle in the middle, whichever has the number nearer to `wanted`.
template <int N>
std::vector<Vec<N>> discOf(double radius, double inner, double wanted) {
  std::vector<Vec<N>> best;
  for (const double shift : {0.0, 0.5}) {
    auto places = latticeOf<N>(Vec<N>::filled(radius), Vec<N>::filled(shift), [&](const Vec<N>& x) {
      const double r = norm(x);
      return r <= radius * (1 + 1e-9) && (inner == 0 || r > inner * (1 + 1e-9));
    });
    const auto off = [&](const std::vector<Vec<N>>& p) {
      return std::abs(static_cast<double>(p.size()) - wanted);
    };
    if (best.empty() || off(places) < off(best)) best = std::move(places);
  }
  return best;
}

Vec<2> centroidOf(const std::vector<Vec<2>>& polygon) {
  Vec<2> sum{};
  double area = 0;  // six times, with its sign
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec<2>&a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double part = a[0] * b[1] - b[0] * a[1];
    sum += part * (a + b), area += 3 * part;
  }
  return (1 / area) * sum;
}

/// Tries lattices that are shifted by quarters of a spacing. Takes the one whose number of places is the nearest
/// to `wanted`, and among equal ones that whose middle is the nearest to that of the polygon.
std::vector<Vec<2>> polygonOf(const std::vector<Vec<2>>& points, double spacing, double wanted) {
  Vec<2> most{};
  for (const Vec<2>& x : points)
    for (int k = 0; k < 2; ++k) most[k] = std::max(most[k], std::abs(x[k]) / spacing);
  const Vec<2> middle = (1 / spacing) * centroidOf(points);
  Shape outline;
  outline.points = points;
  const FacetTree<2> sides(polygonFacets<2>(outline));
  const auto off = [&](const std::vector<Vec<2>>& places) {
    Vec<2> sum{};
    for (const Vec<2>& x : places) sum += x;
    const double count = static_cast<double>(places.size());
    return std::pair(std::abs(count - wanted), places.empty() ? 0 : norm((1 / count) * sum - middle));
  };
  std::vector<Vec<2>> best;
  for (int shift = 0; shift < 16; ++shift) {
    auto places = latticeOf<2>(most, {0.25 * (shift % 4), 0.25 * (shift / 4)},
                               [&](const Vec<2>& x) { return sides.winding(spacing * x) > 0.5; });
    if (shift == 0 || off(places) < off(best)) best = std::move(places);
  }
  return best;
}

}  // namespace

template <int D>
std::array<Vec<D>, D - 1> axesAcross(const Nozzle& nozzle, const Vec<D>& direction) {
  if constexpr (D == 2) {
    return {Vec<2>{direction[1], -direction[0]}};
  } else {
    Vec<3> up = nozzle.up;
    if (norm(up) == 0) {  // the axis that is the farthest from the direction
      int axis = 0;
      for (int k = 1; k < 3; ++k)
        if (std::abs(direction[k]) < std::abs(direction[axis]) - 1e-9) axis = k;
      up[axis] = 1;
    }
    up = up - dot(up, direction) * direction;
    up = up * (1 / norm(up));
    return {cross(direction, up), up};
  }
}

template <int N>
double areaOf(const Nozzle& n) {
  const double pi = std::numbers::pi;
  if (n.kind == NozzleKind::Polygon) return 0.5 * std::abs(signedArea2(n.points));
  if (n.kind == NozzleKind::Rectangle) return N == 1 ? n.width : n.width * n.height;
  const auto disc = [&](double r) { return N == 1 ? 2 * r : pi * r * r; };
  return disc(n.radius) - disc(n.innerRadius);
}

template <int N>
std::vector<Vec<N>> placesAcross(const Nozzle& n, double spacing) {
  if (n.kind == NozzleKind::Disc)
    return discOf<N>(n.radius / spacing, n.innerRadius / spacing, areaOf<N>(n) / std::pow(spacing, N));
  if constexpr (N == 2)
    if (n.kind == NozzleKind::Polygon) return polygonOf(n.points, spacing, areaOf<N>(n) / (spacing * spacing));
  Vec<N> sides;
  sides[0] = n.width / spacing;
  if constexpr (N > 1) sides[1] = n.height / spacing;
  return rectangleOf<N>(sides);
}

template std::array<Vec<2>, 1> axesAcross(const Nozzle&, const Vec<2>&);
template std::array<Vec<3>, 2> axesAcross(const Nozzle&, const Vec<3>&);
template double areaOf<1>(const Nozzle&);
template double areaOf<2>(const Nozzle&);
template std::vector<Vec<1>> placesAcross<1>(const Nozzle&, double);
template std::vector<Vec<2>> placesAcross<2>(const Nozzle&, double);

}  // namespace treacle
