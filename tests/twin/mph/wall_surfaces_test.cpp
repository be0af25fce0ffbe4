#include "treacle/mph/wall_surfaces.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "support/wall_motions.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// The surfaces of walls that turn, on both backends.
template <int D>
void check() {
  Scene<D> s = makeScene<D>({.scheme = SchemeKind::Accurate});
  const std::uint32_t n = s.n(), walls = s.pairs().activeCount - n;
  ASSERT_GT(walls, 0u);
  std::vector<WallMotion<D>> motion = randomMotions<D>(s.c.domain, 3);
  for (WallMotion<D>& m : motion) m.sine = 0.6, m.cosine = -0.8;
  for (std::uint32_t k = 0; k < s.particles.wallCount(); ++k)
    s.particles.body[n + k] = static_cast<std::uint8_t>(k % 3);
  const auto body = s.particles.body.span().subspan(n, walls);
  Buffer<WallSurface<D>> expected(walls);
  placeSurfaces<D>(s.context, {s.particles.wallSurface.span(), motion}, body, expected);

  Context<Cuda> context;
  const auto known = copyToDevice<WallSurface<D>>(context, s.particles.wallSurface);
  const auto motions = copyToDevice<WallMotion<D>>(context, motion);
  Buffer<WallSurface<D>, Cuda> found(context, walls);
  placeSurfaces<D>(context, {known.span(), motions.span()}, copyToDevice<std::uint8_t>(context, body), found);
  const Buffer<WallSurface<D>> back = copyToHost(context, found);
  for (std::uint32_t k = 0; k < walls; ++k)
    for (int f = 0; f < 2; ++f)
      ASSERT_LE(norm(back[k].face[f] - expected[k].face[f]), 1e-7 * norm(expected[k].face[0]));
}

TEST(WallSurfacesTwin, TurnLikeThoseOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  check<2>();
  check<3>();
}

}  // namespace
}  // namespace treacle::test
