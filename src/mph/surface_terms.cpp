#include "treacle/model/lattice_sum.hpp"
#include "treacle/mph/surface_tension.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace treacle {

template <int D>
SurfaceTerms<D> SurfaceTerms<D>::make(const Case& c) {
  const double h = c.interactionRadius();
  SurfaceTerms terms{};
  terms.inverseSquare = 1 / (h * h);
  const double lattice =
      1 + latticeSum<D>(h, c.spacing, [&](double r) { return std::pow(positivePart(1 - r * r / (h * h)), 4); });
  terms.gradientFactor = 8 / (h * h * lattice);
  terms.shareFactor = 1 / latticeSum<D>(h, c.spacing, [&](double r) { return terms.gradient(r * r) * r * r; });
  terms.coreRadius = 0.95 * c.spacing;
  terms.coreFactor = 0.5 / (terms.coreRadius * terms.coreRadius);
  terms.noise2 = 0.01 / (h * h);
  const double along = D == 2 ? 3.0 / 8 : 4.0 / 15;  // mean of (e.t)^2 (1 - (e.n)^2) over all directions e
  terms.evenFactor =
      1 / (along * latticeSum<D>(h, c.spacing, [&](double r) { return positivePart(1 - r * r / (h * h)); }));
  double largest = 0;
  for (const Material& m : c.materials) largest = std::max(largest, m.surfaceTension);
  terms.evenNoise = 1e-3 * 8.0 / 3.0 * largest * std::sqrt(terms.noise2);
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    terms.tension[m] = c.materials[m].surfaceTension;
    const double cosine = std::cos(c.materials[m].contactAngle * std::numbers::pi / 180);
    // 1 times the cosine would do where stress and surface were sharp; found by drops on walls.
    terms.pull[m] = (1.25 + 0.14 * cosine) * cosine;
  }
  return terms;
}

template struct SurfaceTerms<2>;
template struct SurfaceTerms<3>;

}  // namespace treacle
