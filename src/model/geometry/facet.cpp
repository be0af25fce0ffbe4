#include "facet_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace treacle {

template <>
Vec<2> facetNormal<2>(const Facet<2>& f) {
  const Vec<2> along = f[1] - f[0];
  return {along[1], -along[0]};
}

template <>
Vec<3> facetNormal<3>(const Facet<3>& f) {
  return 0.5 * cross(f[1] - f[0], f[2] - f[0]);
}

template <>
Vec<2> nearestOn<2>(const Facet<2>& f, const Vec<2>& x) {
  const Vec<2> along = f[1] - f[0];
  return f[0] + along * std::clamp(dot(x - f[0], along) / norm2(along), 0.0, 1.0);
}

/// By the regions around a triangle in its plane: before its corners, beside its edges, above itself [Ericson:
/// Real-Time Collision Detection, 2005, 5.1.5].
template <>
Vec<3> nearestOn<3>(const Facet<3>& f, const Vec<3>& x) {
  const Vec<3> ab = f[1] - f[0], ac = f[2] - f[0];
  const Vec<3> a = x - f[0], b = x - f[1], c = x - f[2];
  const double bA = dot(ab, a), cA = dot(ac, a);
  if (bA <= 0 && cA <= 0) return f[0];
  const double bB = dot(ab, b), cB = dot(ac, b);
  if (bB >= 0 && cB <= bB) return f[1];
  const double areaC = bA * cB - bB * cA;
  if (areaC <= 0 && bA >= 0 && bB <= 0) return f[0] + ab * (bA / (bA - bB));
  const double bC = dot(ab, c), cC = dot(ac, c);
  if (cC >= 0 && bC <= cC) return f[2];
  const double areaB = bC * cA - bA * cC;
  if (areaB <= 0 && cA >= 0 && cC <= 0) return f[0] + ac * (cA / (cA - cC));
  const double areaA = bB * cC - bC * cB;
  if (areaA <= 0 && cB >= bB && bC >= cC) return f[1] + (f[2] - f[1]) * ((cB - bB) / ((cB - bB) + (bC - cC)));
  const double all = areaA + areaB + areaC;
  return f[0] + ab * (areaB / all) + ac * (areaC / all);
}

template <>
Vec<2> coveredAngle<2>(const Facet<2>& f, const Vec<2>& x) {
  const Vec<2> a = f[0] - x, b = f[1] - x;
  return {dot(a, b), a[0] * b[1] - a[1] * b[0]};
}
template <>
Vec<2> coveredAngle<3>(const Facet<3>& f, const Vec<3>& x) {
  const Vec<3> a = f[0] - x, b = f[1] - x, c = f[2] - x;
  const double na = norm(a), nb = norm(b), nc = norm(c);
  return {na * nb * nc + dot(a, b) * nc + dot(b, c) * na + dot(c, a) * nb, dot(a, cross(b, c))};
}

}  // namespace treacle
