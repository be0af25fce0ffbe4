#include "treacle/mph/viscosity_scale.hpp"

#include "support/oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// A block of fluid on a lattice, of so many particles along the edge; without walls.
template <int D>
Scene<D> blockOfFluid(int side) {
  Scene<D> s;
  s.c = sceneCase(D, false, SchemeKind::Accurate);
  const double edge = side * s.c.spacing;
  const auto inFluid = [&](const Vec<D>& x) {
    for (int k = 0; k < D; ++k)
      if (x[k] > edge) return false;
    return true;
  };
  s.particles = jitteredLattice<D>(s.c, 0, 1, inFluid, [](const Vec<D>&) { return false; });
  prepare(s);
  return s;
}

template <int D>
std::vector<double> scalesOf(Scene<D>& s, double correction) {
  std::vector<double> scale(s.n());
  viscosityScale<D>(s.context, s.pairs(), correction, scale);
  return scale;
}

template <int D>
void checkLattice() {
  Scene<D> s = blockOfFluid<D>(9);
  const std::vector<double> full = scalesOf(s, 1), half = scalesOf(s, 0.5), none = scalesOf(s, 0);
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    int faces = 0;
    bool inside = true;
    for (int k = 0; k < D; ++k) {
      const double place = s.particles.position[i][k] / s.c.spacing;
      faces += place < 1 || place > 8;
      inside = inside && place > 4 && place < 5;
    }
    ASSERT_EQ(none[i], 1);
    ASSERT_NEAR(half[i], 1 + 0.5 * (full[i] - 1), 1e-14);
    if (inside) {
      ASSERT_NEAR(full[i], 1, 0.01);  // as the lattice's sum is not quite the integral
    }
    // On a face nearly half of the neighbours are missing, at a corner nearly all but one in 2^D; not quite, since
    // those in the plane of the face are there.
    if (faces == 1) {
      ASSERT_GT(full[i], 1.3);
    }
    if (faces == D) {
      ASSERT_GT(full[i], D == 2 ? 2.0 : 2.9);
    }
    ASSERT_LE(full[i], mostViscosityScale);
  }
}

TEST(ViscosityScale, OfALatticeGrowsWithTheNeighboursThatAreMissing) {
  checkLattice<2>();
  checkLattice<3>();
}

template <int D>
void checkAgainstOracle(Walls walls) {
  Scene<D> s = makeScene<D>({.walls = walls, .jitter = 0.4, .scheme = SchemeKind::Accurate});
  const Oracle<D> oracle(s);
  ASSERT_EQ(s.viscosityScale.size(), s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i)
    ASSERT_NEAR(s.viscosityScale[i], oracle.viscosityScale(i), operatorTolerance) << "particle " << i;
}

TEST(ViscosityScale, EqualsTheSumOverAllParticles) {
  checkAgainstOracle<2>(Walls::Floor);
  checkAgainstOracle<3>(Walls::Floor);
  checkAgainstOracle<2>(Walls::None);
}

/// With the whole correction a stretched block dissipates, all in all, what the viscosity says, however many
/// neighbours its particles lack: by symmetry of the mean of two scales, sum_ij c_ij (s_i + s_j) / 2 is sum_i s_i
/// sum_j c_ij. The directions of the neighbours that are left are another matter, hence the second strain.
template <int D>
void checkDissipation() {
  Scene<D> s =
      makeScene<D>({.walls = Walls::None, .jitter = 0.3, .twoMaterials = false, .scheme = SchemeKind::Accurate});
  s.c.method.viscosityCorrection = 1;
  const Oracle<D> oracle(s);
  // The mean over all directions of (e . E e)^2 is that of E = I for the sum of c r^4: the trace alone is known.
  double sum = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i)
    for (std::uint32_t j = 0; j < s.n(); ++j) {
      if (i == j) continue;
      const double r = norm(oracle.difference(i, j));
      sum += oracle.pairScale(i, j) * oracle.viscousBlock(r) * std::pow(r, 4);
    }
  // In space the scales of corners are bounded, of 8 that they would need to 4.
  EXPECT_NEAR(sum / s.n(), 2 * D * (D + 2), D == 2 ? 1e-9 : 0.2);
}

TEST(ViscosityScale, GivesTheWholeFluidItsViscosity) {
  checkDissipation<2>();
  checkDissipation<3>();
}

TEST(ViscosityScale, OfParticlesWithoutNeighboursIsBounded) {
  EXPECT_EQ(viscosityScaleOf<2>(0, 1), mostViscosityScale);
  EXPECT_EQ(viscosityScaleOf<3>(0, 0.5), 1 + 0.5 * (mostViscosityScale - 1));
  EXPECT_EQ(viscosityScaleOf<3>(30, 1), 1);
}

}  // namespace
}  // namespace treacle::test
