#include "treacle/mph/surface_tension.hpp"

#include "support/scene.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace treacle::test {
namespace {

/// A block of fluid that fills the domain across and leaves a plane surface below and above.
template <int D>
Case slabCase() {
  Case c = sceneCase(D, false, SchemeKind::Accurate);
  c.materials[0].surfaceTension = 0.07;
  for (int k = 0; k < D; ++k) {
    c.domain.min[k] = 0, c.domain.max[k] = 22 * c.spacing;
    c.domain.periodic[k] = k != D - 1;
  }
  return c;
}

template <int D>
struct Slab {
  Case c = slabCase<D>();
  Context<Cpu> context;
  Particles<D> particles;
  MphNeighbourhood<D> neighbourhood;
  SurfaceTerms<D> terms = SurfaceTerms<D>::make(c);
  std::vector<Vec<D>> slope, force;

  explicit Slab(double jitter)
      : particles(jitteredLattice<D>(
            c, jitter, 1, [&](const Vec<D>& x) { return x[D - 1] > 4 * c.spacing && x[D - 1] < 18 * c.spacing; },
            [](const Vec<D>&) { return false; })),
        neighbourhood(c) {
    std::fill(particles.material.data(), particles.material.data() + particles.count, 0);
    neighbourhood.sort(context, particles);
    neighbourhood.buildLists(context, particles);
    const std::uint32_t n = neighbourhood.pairs().fluidCount;
    slope.resize(n), force.assign(n, Vec<D>{});
    surfaceSlope<D>(context, neighbourhood.pairs(), terms, slope);
    addSurfaceTension<D>(context, neighbourhood.pairs(), terms, slope, force);
  }
};

/// Tension of both surfaces from the virial of the pairs, as what their forces do along the first axis.
template <int D>
double tensionOf(const Slab<D>& s) {
  const MphPairs<D>& pairs = s.neighbourhood.pairs();
  double virial = 0;
  for (std::uint32_t i = 0; i < pairs.fluidCount; ++i)
    for (std::uint32_t j = 0; j < i; ++j) {
      const Vec<D> d = pairs.difference(i, j);
      const auto stress = [&](const Vec<D>& m) { return norm2(m) * d[0] - dot(m, d) * m[0]; };
      virial += s.terms.gradient(norm2(d)) * d[0] * (stress(s.slope[i]) + stress(s.slope[j]));
    }
  double area = 1;
  for (int k = 0; k < D - 1; ++k) area *= s.c.domain.max[k];
  return virial * std::pow(s.c.spacing, D) / (2 * area);
}

template <int D>
void checkPlane() {
  const Slab<D> s(0);
  EXPECT_NEAR(tensionOf(s) / 0.07, 1, 0.02);  // 0.983 in 2D and 0.993 in 3D
  double most = 0;
  for (const Vec<D>& f : s.force) most = std::max(most, norm(f));
  EXPECT_LE(most, 1e-9 * 0.07 / (s.c.spacing * s.c.spacing));
}

TEST(SurfaceTension, IsThatOfThePlaneSurfaceWhichBearsNoForce) {
  checkPlane<2>();
  checkPlane<3>();
}

template <int D>
void checkMomentum() {
  const Slab<D> s(0.3);
  Vec<D> total{};
  double sum = 0;
  for (const Vec<D>& f : s.force) total += f, sum += norm(f);
  EXPECT_GT(sum, 0);
  EXPECT_LE(norm(total), operatorTolerance * sum);
  EXPECT_NEAR(tensionOf(s) / 0.07, 1, 0.3);  // 1.23 in 2D and 1.26 in 3D: a rough surface is larger
}

TEST(SurfaceTension, ForcesAreEqualAndOpposite) {
  checkMomentum<2>();
  checkMomentum<3>();
}

}  // namespace
}  // namespace treacle::test
