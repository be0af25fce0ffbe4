#include "treacle/model/particles/lattice_sum.hpp"
#include "treacle/mph/surface_tension.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace treacle {

namespace {

/// A plane surface of a full lattice, half a spacing above its outermost row, with gamma = 1: what its pairs add
/// up to in a column below a unit of it, along the first axis.
struct PlaneSurface {
  double tension = 0;  // near 1
  double depth = 0;    // at which it acts in the mean [m]
  double bent = 0;     // by what the tension falls with the curvature and B, per unit of B [m2]
  double moment = 0;   // second moment of w in the plane; times half a curvature, by what that lessens c [m]
};

/// f(rows down, d) for all neighbours of a particle that many rows below the surface, and for itself.
template <int D, class F>
void overHalfLattice(int row, int reach, double l, F&& f) {
  const int across = D == 3 ? reach : 0;
  for (int along = -reach; along <= reach; ++along)
    for (int side = -across; side <= across; ++side)
      for (int down = -std::min(row, reach); down <= reach; ++down) {
        Vec<D> d{};
        d[0] = along * l, d[D - 1] = down * l;
        if (D == 3) d[1] = side * l;
        f(down, d);
      }
}

template <int D>
PlaneSurface planeSurface(SurfaceTerms<D> terms, double l, int reach) {
  terms.tension[0] = 1;
  std::vector<double> m2(2 * reach + 1);  // |m|^2 of each row [1/m]
  for (int row = 0; row < static_cast<int>(m2.size()); ++row) {
    SurfaceSums<D> sums{};
    overHalfLattice<D>(row, reach, l, [&](int, const Vec<D>& d) {
      sums.fluid += terms.gradient(norm2(d)) * d;
      sums.colour += terms.weight(norm2(d));
    });
    m2[row] = norm2(terms.slope(0, sums).m);
  }
  PlaneSurface plane;
  for (int row = 0; row <= reach; ++row)
    overHalfLattice<D>(row, reach, l, [&](int down, const Vec<D>& d) {
      const double r2 = norm2(d), along2 = d[0] * d[0];
      if (r2 == 0) return;
      const double part = 0.5 * (m2[row] + m2[row + down]) * terms.gradient(r2) * along2 * l;
      plane.tension += part;
      plane.depth += part * (row + 0.5 * down + 0.5) * l;
      plane.bent += 0.5 * terms.nearness(r2) * std::sqrt(m2[row] * m2[row + down]) * along2 * along2 / r2 * l;
      if (row == 0 && down == 0) plane.moment += terms.weight(r2) * along2 / l;
    });
  plane.depth /= plane.tension;
  return plane;
}

/// K(theta). Of walls that are wetted it is the cosine, in the plane but for 4 % that lines stay behind by in a
/// slit, stepped by the lattice as they are; in space they are curved, and cross its rows. Beyond 90 degrees,
/// where stress and surface are not sharp, it was found by drops at rest in the plane.
template <int D>
double pullOf(double cosine) {
  if (cosine > 0) return cosine * (D == 2 ? 1.04 : 1.0);
  return cosine * (1.1 + 1.1 * std::pow(cosine, 6));
}

/// Sets rowColour and rowDensity.
template <int D>
void setRows(const Case& c, SurfaceTerms<D>& terms) {
  const MphPairs<D> pairs = makeMphPairs<D>(c);
  const int reach = static_cast<int>(c.interactionRadius() / c.spacing) + 1;
  for (int row = 0; row < terms.rows; ++row) {
    double colour = 0, density = 0;
    overHalfLattice<D>(row, reach, c.spacing, [&](int, const Vec<D>& d) {
      const double r2 = norm2(d);
      colour += terms.weight(r2);
      if (r2 > 0) density += pairs.terms.density(pairs.terms.densityFactor, ExactDistance(r2));
    });
    terms.rowColour[row] = colour, terms.rowDensity[row] = density / pairs.restDensity;
  }
}

}  // namespace

template <int D>
SurfaceTerms<D> SurfaceTerms<D>::make(const Case& c) {
  const double h = c.interactionRadius(), l = c.spacing;
  SurfaceTerms terms{};
  terms.inverseSquare = 1 / (h * h);
  terms.weightFactor = 1;
  terms.weightFactor =
      1 / (terms.weight(0.0) + latticeSum<D>(h, l, [&](double r) { return terms.weight(r * r); }));
  terms.gradientFactor = 11 / (h * h) * terms.weightFactor;
  terms.shareFactor = 1 / latticeSum<D>(h, l, [&](double r) { return terms.gradient(r * r) * r * r; });
  terms.wettingFactor = 1;
  terms.wettingFactor =
      1 / (terms.wetting(0.0) + latticeSum<D>(h, l, [&](double r) { return terms.wetting(r * r); }));
  setRows<D>(c, terms);
  terms.coreRadius = 0.95 * l;
  terms.coreFactor = 0.5 / (terms.coreRadius * terms.coreRadius);
  terms.noise2 = 0.01 / (h * h);
  const PlaneSurface plane = planeSurface(terms, l, static_cast<int>(h / l) + 1);
  // The tension of a curved surface, the integral of 2 gamma p dc from less than 1/2 on, grows with each of its
  // curvatures by p(1/2) times the moment; the one of a ball has two.
  terms.bendFactor = (plane.depth + (D - 1) * terms.profile(0.5) * plane.moment) / plane.bent;
  const double along = D == 2 ? 3.0 / 8 : 4.0 / 15;  // mean of (e.t)^2 (1 - (e.n)^2) over all directions e
  terms.evenFactor = 1 / (along * latticeSum<D>(h, l, [&](double r) { return terms.nearness(r * r); }));
  double largest = 0;
  for (const Material& m : c.materials) largest = std::max(largest, m.surfaceTension);
  terms.evenNoise = 1e-3 * 2 * largest * std::sqrt(terms.noise2);
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    terms.tension[m] = c.materials[m].surfaceTension;
    for (std::size_t wall = 0; wall < c.materials.size(); ++wall) {
      const double angle = c.materials[wall].contactAngleWith(c.materials[m].name);
      terms.pulls[m * maxMaterials + wall] = pullOf<D>(std::cos(angle * std::numbers::pi / 180));
    }
  }
  return terms;
}

template struct SurfaceTerms<2>;
template struct SurfaceTerms<3>;

}  // namespace treacle
