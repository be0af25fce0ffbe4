#pragma once

#include <optional>

#include "support/isph_scene.hpp"
#include "treacle/model/motion/wall_motion.hpp"

namespace treacle::test {

/// [O23] sect. 2 from its formulas, in the plainest way: all pairs, none of the program's own formulas. Walls are
/// met as docs/isph.md has it. Indices as in the scene: fluid first, then all walls.
template <int D>
struct IsphOracle {
  const IsphScene<D>& s;
  double l, h, volume, dt;
  std::vector<WallMotion<D>> motion{};  // per body; empty: no wall turns

  explicit IsphOracle(const IsphScene<D>& scene)
      : s(scene),
        l(s.c.spacing),
        h(s.c.method.isph.smoothingRatio * l),
        volume(std::pow(l, D)),
        dt(s.c.time.step) {}

  std::uint32_t count() const { return s.particles.count; }
  bool isWall(std::uint32_t i) const { return i >= s.n(); }
  const Material& material(std::uint32_t i) const { return s.c.materials[s.particles.material[i]]; }
  double mu(std::uint32_t i, std::uint32_t j) const;  // with a wall that of the fluid

  /// Cubic spline of Monaghan, or Wendland's C2, and dW/dr by its text-book derivative.
  double kernel(double r) const;
  double kernelSlope(double r) const;

  /// r_ij = x_i - x_j, of the nearest periodic image.
  Vec<D> apart(std::uint32_t i, std::uint32_t j) const;
  /// V grad_i W(r_ij)
  Vec<D> gradient(std::uint32_t i, std::uint32_t j) const;
  /// V r_ij . grad W / r_ij^2, negative: of eq. (6).
  double laplacian(std::uint32_t i, std::uint32_t j) const;

  template <class F>
  void forEachOther(std::uint32_t i, F&& f) const {
    for (std::uint32_t j = 0; j < count(); ++j)
      if (j != i && norm(apart(i, j)) < 2 * h) f(j);
  }

  /// Of a full lattice.
  double latticeLaplacian() const;
  bool isAccurate() const { return s.c.method.scheme == SchemeKind::Accurate; }
  /// Where i and j are on both sides of a face of the wall j: of those that j has, the one that the line from i to
  /// j crosses last.
  struct Face {
    Vec<D> normal;         // out of the wall
    double height, depth;  // of i and j [m]
  };
  std::optional<Face> face(std::uint32_t i, std::uint32_t j) const;
  /// How walls count in a moment.
  enum class WallPart { None, Whole, Across };
  /// The inverse of M = sum V grad W d^T, whose eigenvalues count as at least 0.3. Of walls that have a face their
  /// part across it counts as it is in a row of such walls: sum V W' / r (n.d)^2 n n^T.
  Matrix inverseMoment(std::uint32_t i, WallPart walls) const;
  /// That with walls in the accurate scheme, the unit matrix in the published one, and for derivatives of
  /// velocities.
  Matrix renormalisation(std::uint32_t i) const;
  Matrix derivative(std::uint32_t i) const;
  Vec<D> renormalised(std::uint32_t i, const Vec<D>& x) const;
  /// By how much the Laplacian of a pair counts more, by its particle i.
  double along(std::uint32_t i, std::uint32_t j) const;
  /// Share of the neighbours that particle i misses of a full lattice's, by the Laplacian, where it is at the free
  /// surface of the accurate scheme.
  double missing(std::uint32_t i) const;
  /// eq. (3), in units of the full lattice's.
  double density(std::uint32_t i) const;
  Vec<D> deficit(std::uint32_t i) const;

  /// By what the difference of velocities at a wall is multiplied for viscous forces: (height + depth) / height,
  /// the height at least l / 4, or 2 without faces.
  double wallFactor(std::uint32_t i, std::uint32_t j) const;
  /// The velocity of the body of wall particle j where the line to i crosses its surface: by `motion`, if any.
  Vec<D> onSurface(const std::vector<Vec<D>>& v, std::uint32_t i, std::uint32_t j) const;
  /// What particle i sees in j: its velocity, or that of a wall's image, 2 u_wall - v_i.
  Vec<D> seen(const std::vector<Vec<D>>& v, std::uint32_t i, std::uint32_t j) const;
  /// eqs. (6) and (7); mu nu^-1 of a pair by their harmonic mean, at walls mu of the fluid.
  Vec<D> predicted(const std::vector<Vec<D>>& v, std::uint32_t i) const;
  /// eq. (4), of a velocity.
  double divergence(const std::vector<Vec<D>>& v, std::uint32_t i) const;
  /// The velocity gradient of fluid alone.
  Matrix velocityGradient(const std::vector<Vec<D>>& v, std::uint32_t i) const;
  /// mu (L_i + L_j)^T V grad W of particle i, with its own L in walls: the divergence of mu L^T [N/m3].
  Vec<D> transposedForce(const std::vector<Vec<D>>& v, std::uint32_t i) const;
  /// A velocity without a part of what pairs have that their gradients do not, along the pair: sqrt(p / rho)
  /// dt / l, at most half; `p`: last pressures of fluid.
  Vec<D> damped(const std::vector<Vec<D>>& v, const std::vector<double>& p, std::uint32_t i) const;
  /// eq. (10) with both signs turned, by rho: the term of the divergence and that of the density.
  double flowSource(const std::vector<Vec<D>>& v, std::uint32_t i) const;
  double densitySource(std::uint32_t i) const;

  /// p of fluid particle i carried on to wall j hydrostatically, in the frame of the wall; accelerations of walls
  /// by particle.
  double inWall(double p, std::uint32_t i, std::uint32_t j, const std::vector<Vec<D>>& acceleration) const;
  /// eq. (8) with the gradient of eq. (5) for a mean density of the pair: rho_i grad p / rho = sum V (p_i + p_j)
  /// grad W.
  Vec<D> corrected(const std::vector<Vec<D>>& v, const std::vector<double>& p, std::uint32_t i,
                   const std::vector<Vec<D>>& acceleration) const;
  /// What a particle keeps of v where it is nearer to a wall than a lattice point, or clearly nearer if it has
  /// pressure: not the part into the wall, whose mean velocity, by slope, is that of its particles in `v`.
  Vec<D> stopped(const Vec<D>& moving, const std::vector<Vec<D>>& v, double p, std::uint32_t i) const;
  /// Mean over the fluid that a wall has around it, by kernel.
  double wallPressure(const std::vector<double>& p, std::uint32_t wall,
                      const std::vector<Vec<D>>& acceleration) const;

  /// Left-hand side of eq. (11) over -rho, of fluid where unknown(i); its other rows and columns are zero, but the
  /// diagonal counts known neighbours.
  Matrix pressureMatrix(const std::function<bool(std::uint32_t)>& unknown) const;
  /// rho/dt - mu lap for implicit steps of eq. (7).
  Matrix viscousMatrix() const;
};

}  // namespace treacle::test
