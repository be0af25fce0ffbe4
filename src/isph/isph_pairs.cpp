#include "treacle/isph/isph_pairs.hpp"

#include "treacle/model/particles/lattice_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {

namespace {

/// Bounds are those of the materials of fluid bodies, or of all materials if there is no fluid body. Materials of
/// walls may be anything.
template <int D>
void setBounds(const Case& c, IsphPairs<D>& pairs) {
  const auto hasFluid = [&](int m) {
    return std::ranges::any_of(c.bodies, [&](const Body& b) { return b.holdsFluid() && b.material == m; });
  };
  const bool known = std::ranges::any_of(c.bodies, &Body::holdsFluid);
  const MaterialTable& m = pairs.materials;
  pairs.leastDensity = std::numeric_limits<double>::infinity();
  for (int a = 0; a < m.count; ++a) {
    if (known && !hasFluid(a)) continue;
    pairs.leastDensity = std::min(pairs.leastDensity, m.density[a]);
    pairs.mostViscosity = std::max(pairs.mostViscosity, m.viscosity(a));
    for (int b = 0; b < m.count; ++b)
      pairs.mostDiffusivity = std::max(pairs.mostDiffusivity, m.pairViscosity[a][b] / m.density[a]);
  }
}

/// Sum of value(r, y) over the half of a lattice that is below a particle; r: distance, y: depth [m].
template <int D, class Value>
double sumOfHalfLattice(const IsphPairs<D>& pairs, const Value& value) {
  const int reach = static_cast<int>(std::ceil(pairs.kernel.radius() / pairs.spacing));
  double sum = 0;
  for (int z = D == 3 ? -reach : 0; z <= (D == 3 ? reach : 0); ++z)
    for (int x = -reach; x <= reach; ++x)
      for (int y = 1; y <= reach; ++y)
        sum += value(pairs.spacing * std::sqrt(double(x * x + y * y + z * z)), pairs.spacing * y);
  return sum;
}

/// Share of a lattice's density that the half of it below a particle makes up.
template <int D>
double shareOfHalfLattice(const IsphPairs<D>& pairs) {
  const auto density = [&](double r, double) { return pairs.volume * pairs.kernel.value(r); };
  return sumOfHalfLattice(pairs, density) / pairs.latticeDensity;
}

/// Constants of the turbulence model.
template <int D>
void setTurbulence(const Case& c, IsphPairs<D>& pairs) {
  pairs.mixingLength = c.method.isph.smagorinsky * c.spacing;
  pairs.meanDistance = sumOfHalfLattice(pairs, [&](double r, double y) { return pairs.slope(r) * y; }) /
                       sumOfHalfLattice(pairs, [&](double r, double) { return pairs.slope(r); });
}

}  // namespace

template <int D>
IsphPairs<D> makeIsphPairs(const Case& c) {
  Vec<D, bool> periodic{};
  for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[k];
  const IsphSettings& s = c.method.isph;
  IsphPairs<D> pairs;
  pairs.spacing = c.spacing;
  pairs.grid =
      CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, 2 * c.smoothingLength());
  pairs.kernel = SmoothingKernel<D>::make(s.kernel, c.smoothingLength());
  pairs.materials = MaterialTable::make(c);
  setBounds(c, pairs);
  pairs.frame.gravity = resized<D>(c.gravity);
  pairs.volume = std::pow(c.spacing, D);
  const auto weight = [&](double r) { return pairs.kernel.value(r); };
  pairs.latticeDensity = pairs.volume * (weight(0) + latticeSum<D>(pairs.kernel.radius(), c.spacing, weight));
  pairs.accurate = c.method.scheme == SchemeKind::Accurate;
  pairs.latticeWeight = pairs.densityWeight(0) + latticeSum<D>(pairs.kernel.radius(), c.spacing,
                                                               [&](double r) { return pairs.densityWeight(r); });
  pairs.latticeLaplacian =
      latticeSum<D>(pairs.kernel.radius(), c.spacing, [&](double r) { return 2 * pairs.slope(r); });
  // A thousandth more, so that rounding does not decide about particles that start at that distance.
  pairs.contact.touching = 1.001 * shareOfHalfLattice(pairs);
  setTurbulence(c, pairs);
  pairs.timeStep = c.time.step;
  pairs.alpha = s.alpha;
  pairs.noSlip = s.walls == WallSlip::NoSlip;
  pairs.negativePressure = s.negativePressure;
  return pairs;
}

template <int D>
double explicitViscousLimit(const IsphPairs<D>& pairs) {
  const double diffusivity = pairs.mostDiffusivity;
  return diffusivity > 0 ? 0.5 / (diffusivity * pairs.latticeLaplacian) : std::numeric_limits<double>::infinity();
}

#define TREACLE_INSTANTIATE(D)                         \
  template IsphPairs<D> makeIsphPairs<D>(const Case&); \
  template double explicitViscousLimit<D>(const IsphPairs<D>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
