#include "treacle/mph/elasticity.hpp"

#include "support/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace treacle::test {
namespace {

template <int D>
double component(int r, int s) {
  return std::sin(2.0 * r + 3.0 * s + 1);
}

/// A linear velocity has its gradient at every particle, also at a free surface.
template <int D>
void checkVelocityGradients() {
  Scene<D> s = makeScene<D>({.walls = Walls::None, .scheme = SchemeKind::Accurate});
  const MphPairs<D>& pairs = s.neighbourhood->pairs();
  const std::uint32_t n = pairs.fluidCount;
  const Vec<D> middle = Vec<D>::filled(0.5 * s.c.domain.max[0]);
  Buffer<Vec<D>> u(pairs.activeCount);
  for (std::uint32_t i = 0; i < pairs.activeCount; ++i)
    for (int r = 0; r < D; ++r) {
      u[i][r] = 0;
      for (int k = 0; k < D; ++k) u[i][r] += component<D>(r, k) * (pairs.position[i] - middle)[k];
    }
  Buffer<SymmetricBlock<D>> b(n);
  Buffer<Block<D>> gradient(n);
  gradientCorrection<D>(s.context, pairs, b.span(), false);
  velocityGradient<D>(s.context, pairs, b.span(), u.span(), gradient.span());
  std::uint32_t exact = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    double off = 0;
    for (int r = 0; r < D; ++r)
      for (int k = 0; k < D; ++k) off = std::max(off, std::abs(gradient[i](r, k) - component<D>(r, k)));
    exact += off < 1e-9;
  }
  // All but those whose images across periodic ends do not fit a linear velocity, and such as stand alone.
  EXPECT_GT(exact, n / 5);
}
TEST(Elasticity, GradientsOfLinearVelocitiesAreExact) {
  checkVelocityGradients<2>();
  checkVelocityGradients<3>();
}

/// The power of the forces on fluid without walls is minus that of the stresses on the gradients, for any
/// velocities and stresses: sum of f.u = -sum of tau:L.
template <int D>
void checkElasticPower() {
  Scene<D> s = makeScene<D>({.walls = Walls::None, .scheme = SchemeKind::Accurate});
  const MphPairs<D>& pairs = s.neighbourhood->pairs();
  const std::uint32_t n = pairs.fluidCount;
  Buffer<Vec<D>> u(pairs.activeCount), force(n);
  Buffer<SymmetricBlock<D>> b(n);
  Buffer<Block<D>> gradient(n), carried(n);
  std::vector<SymmetricBlock<D>> stress(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (int k = 0; k < D; ++k) u[i][k] = std::sin(i * (k + 1.0));
    for (int k = 0; k < SymmetricBlock<D>::size; ++k) stress[i].a[k] = std::cos(i * (k + 2.0));
  }
  gradientCorrection<D>(s.context, pairs, b.span(), false);
  velocityGradient<D>(s.context, pairs, b.span(), u.span(), gradient.span());
  double ofStress = 0, ofForce = 0, size = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    for (int r = 0; r < D; ++r)
      for (int k = 0; k < D; ++k) {
        ofStress += stress[i](r, k) * gradient[i](r, k);
        size += std::abs(stress[i](r, k) * gradient[i](r, k));
        carried[i](r, k) = 0;
        for (int m = 0; m < D; ++m) carried[i](r, k) += stress[i](r, m) * b[i](m, k);
      }
  stressForces<D>(s.context, pairs, carried.span(), force.span());
  Vec<D> sum{};
  for (std::uint32_t i = 0; i < n; ++i) ofForce += dot(force[i], u[i]), sum += force[i];
  EXPECT_NEAR(ofForce, -ofStress, 1e-11 * size);
  double most = 0;
  for (std::uint32_t i = 0; i < n; ++i) most += norm(force[i]);
  EXPECT_LT(norm(sum), 1e-12 * most);
}
TEST(Elasticity, ForcesAreTheTransposeOfGradients) {
  checkElasticPower<2>();
  checkElasticPower<3>();
}

/// What the fluid puts on the walls is what they put on it.
template <int D>
void checkStressOnWalls() {
  Scene<D> s = makeScene<D>({.scheme = SchemeKind::Accurate});
  const MphPairs<D>& pairs = s.neighbourhood->pairs();
  const std::uint32_t n = pairs.fluidCount, walls = pairs.activeCount - n;
  Buffer<Block<D>> carried(n);
  for (std::uint32_t i = 0; i < n; ++i)
    for (int k = 0; k < D * D; ++k) carried[i].a[k] = std::cos(i * (k + 2.0));
  Buffer<Vec<D>> force(n), onWalls(walls);
  stressForces<D>(s.context, pairs, carried.span(), force.span());
  // Lists of walls that reach as far as the viscosity.
  Vec<D> sum{}, reaction{};
  double size = 0;
  for (std::uint32_t i = 0; i < n; ++i) sum += force[i], size += norm(force[i]);
  ClusterList<Cpu> list;
  buildClusterList<D>(s.context, pairs.grid, s.neighbourhood->ranges(), pairs.position,
                      {n, pairs.ownEnd(), {pairs.terms.viscosityRadius, 0}, true, pairs.side}, list);
  Buffer<Vec<3>> couple(walls);
  stressOnWalls<D>(s.context, pairs, list.view(), carried.span(), onWalls.span(), couple.span());
  for (std::uint32_t j = 0; j < walls; ++j) reaction += onWalls[j];
  EXPECT_GT(norm(sum), 0);
  EXPECT_LT(norm(sum + reaction), 1e-11 * size);
}
TEST(Elasticity, WallsBearWhatTheyExert) {
  checkStressOnWalls<2>();
  checkStressOnWalls<3>();
}

}  // namespace
}  // namespace treacle::test
