#include "polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace treacle {
namespace {

using Points = std::vector<Vec<2>>;

/// Positive where c is on the left of the way from a to b.
double leftOf(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
  const Vec<2> u = b - a, v = c - a;
  return u[0] * v[1] - u[1] * v[0];
}

/// Whether a point in line with a and b is between them.
bool between(const Vec<2>& a, const Vec<2>& b, const Vec<2>& x) { return dot(a - x, b - x) <= 0; }

bool meet(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const double abc = leftOf(a, b, c), abd = leftOf(a, b, d), cda = leftOf(c, d, a), cdb = leftOf(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

Points counterClockwise(Points points) {
  if (signedArea2(points) < 0) std::ranges::reverse(points);
  return points;
}

/// Triangles that a polygon consists of, by cutting off one corner after the other; of their corners the indices.
std::vector<std::array<std::size_t, 3>> triangulated(const Points& points) {
  std::vector<std::size_t> left(points.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<std::array<std::size_t, 3>> triangles;
  std::size_t k = 0;
  for (std::size_t tried = 0; left.size() > 3;) {
    const std::size_t n = left.size();
    const std::size_t before = left[(k + n - 1) % n], at = left[k % n], after = left[(k + 1) % n];
    const Vec<2>&a = points[before], &b = points[at], &c = points[after];
    const auto inTheWay = [&](std::size_t i) {
      if (i == before || i == at || i == after) return false;
      const Vec<2>& x = points[i];
      return leftOf(a, b, x) >= 0 && leftOf(b, c, x) >= 0 && leftOf(c, a, x) >= 0;
    };
    const double area = leftOf(a, b, c);
    // Rounding may leave none that can be cut off cleanly: then any one is.
    const bool any = tried > n;
    if (any || area == 0 || (area > 0 && std::ranges::none_of(left, inTheWay))) {
      if (area != 0) triangles.push_back({before, at, after});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k % n));
      tried = 0, k = k % n == 0 ? 0 : k % n - 1;
    } else {
      ++tried, k = (k + 1) % n;
    }
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace

double signedArea2(const Points& points) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) sum += leftOf(points[0], points[k], points[k + 1]);
  return sum;
}

std::optional<std::pair<std::size_t, std::size_t>> crossingSides(const Points& points, bool closed) {
  const std::size_t n = points.size(), sides = closed ? n : n - 1;
  const auto point = [&](std::size_t k) -> const Vec<2>& { return points[k % n]; };
  for (std::size_t i = 0; i < sides; ++i)
    if (point(i) == point(i + 1)) return std::pair(i, i);
  for (std::size_t i = 0; i < sides; ++i) {
    // The next side begins where this one ends; it may only not lead back.
    if ((closed || i + 1 < sides) && leftOf(point(i), point(i + 1), point(i + 2)) == 0 &&
        dot(point(i + 1) - point(i), point(i + 2) - point(i + 1)) < 0)
      return std::pair(i, (i + 1) % n);
    for (std::size_t j = i + 2; j < sides; ++j)
      if ((!closed || (j + 1) % n != i) && meet(point(i), point(i + 1), point(j), point(j + 1)))
        return std::pair(i, j);
  }
  return std::nullopt;
}

template <>
std::vector<Facet<2>> polygonFacets<2>(const Shape& s) {
  const Points points = counterClockwise(s.points);
  std::vector<Facet<2>> facets;
  for (std::size_t k = 0; k < points.size(); ++k) facets.push_back({points[k], points[(k + 1) % points.size()]});
  return facets;
}

template <>
std::vector<Facet<3>> polygonFacets<3>(const Shape& s) {
  const Points points = counterClockwise(s.points);
  const auto at = [&](std::size_t k, double z) { return Vec<3>{points[k][0], points[k][1], z}; };
  std::vector<Facet<3>> facets;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t next = (k + 1) % points.size();
    facets.push_back({at(k, s.bottom), at(next, s.bottom), at(next, s.top)});
    facets.push_back({at(k, s.bottom), at(next, s.top), at(k, s.top)});
  }
  for (const auto& [a, b, c] : triangulated(points)) {
    facets.push_back({at(a, s.top), at(b, s.top), at(c, s.top)});
    facets.push_back({at(c, s.bottom), at(b, s.bottom), at(a, s.bottom)});
  }
  return facets;
}

template <>
std::vector<Facet<2>> polylineFacets<2>(const Shape& s) {
  std::vector<Facet<2>> facets;
  for (std::size_t k = 0; k + 1 < s.points.size(); ++k) facets.push_back({s.points[k], s.points[k + 1]});
  return facets;
}

template <>
std::vector<Facet<3>> polylineFacets<3>(const Shape& s) {
  const auto at = [&](std::size_t k, double z) { return Vec<3>{s.points[k][0], s.points[k][1], z}; };
  std::vector<Facet<3>> facets;
  for (std::size_t k = 0; k + 1 < s.points.size(); ++k) {
    facets.push_back({at(k, s.bottom), at(k + 1, s.bottom), at(k + 1, s.top)});
    facets.push_back({at(k, s.bottom), at(k + 1, s.top), at(k, s.top)});
  }
  return facets;
}

}  // namespace treacle
