#pragma once

#include "support/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace treacle::test {

/// B of a moment M, as renormalisation.hpp has it. `acting`: without what is along walls at which fluid slips.
Matrix renormalisationOracle(const Matrix& whole, const Matrix& acting);

/// [K23] sect. 2 from its formulas, in the plainest way: all pairs, dense matrices, none of the program's own
/// formulas. Indices as in the scene: fluid first, then all walls.
template <int D>
struct Oracle {
  const Scene<D>& s;
  double l, hp, hn, hv, dt;
  double slopeScale = 1;               // with the renormalised gradient: what makes the moment of a full lattice I
  mutable std::vector<double> scales;  // viscosityScale of all, since pairs ask for it again and again
  std::vector<SlipSide<D>> sides;      // slipSides() as a step has them; empty: each pair by its face

  explicit Oracle(const Scene<D>& scene)
      : s(scene),
        l(s.c.spacing),
        hp(s.c.method.pressureRadius * l),
        hn(s.c.densityRadius()),
        hv(s.c.method.viscosityRadius * l),
        dt(s.c.time.step) {
    if (s.c.isAccurate()) slopeScale = 1 / latticeMoment();
  }

  /// From now on fluid particles see the walls along which they slip as in a step.
  void findSlipSides();

  std::uint32_t count() const { return s.particles.count; }
  const Material& material(std::uint32_t i) const { return s.c.materials[s.particles.material[i]]; }

  /// lambda [Pa s]
  double bulkViscosity(std::uint32_t i) const {
    const double whole = material(i).bulkViscosity;
    return i < s.wallShare.size() ? s.wallShare[i] * whole : whole;
  }

  /// dw/dr of the case's weight of gradients, as of eq. (3), with l^d.
  double dw(double r, double h) const;
  /// The weight of densities with the radius h_n.
  double densityWeight(double r) const;
  /// c of a viscous pair block mu c d d^T.
  double viscousBlock(double r) const;
  /// Force on i from j where both are too close [N/m3].
  Vec<D> repulsion(std::uint32_t i, std::uint32_t j) const;
  double mu(std::uint32_t i, std::uint32_t j) const;
  /// What a fluid particle's viscosity is multiplied by.
  double viscosityScale(std::uint32_t i) const;
  /// That of a pair: the mean of both, with a wall that of the fluid.
  double pairScale(std::uint32_t i, std::uint32_t j) const;
  /// (d_i + d_j) / (d_i + b) where one of them is a wall particle that knows its surface, else 1.
  double wallFactor(std::uint32_t i, std::uint32_t j) const;
  /// The face of wall particle j that the line from fluid particle i crosses last; depth 0: there is none.
  struct Face {
    Vec<D> normal{};
    double depth = 0, distance = 0;  // of j and i from the face
  };
  Face face(std::uint32_t i, std::uint32_t j) const;
  /// The part of a pair's vector v that acts in products with C: across the wall, where the fluid slips along it.
  Vec<D> acting(std::uint32_t i, std::uint32_t j, const Vec<D>& v) const;
  /// Nearest periodic image of x_j - x_i.
  Vec<D> difference(std::uint32_t i, std::uint32_t j) const;

  double numberDensity(std::uint32_t i) const;

  /// Sum of -w' r e_x^2 in a full lattice.
  double latticeMoment() const;

  /// M = sum of -w' r e e^T over the neighbours of a particle; of what acts of e alone.
  Matrix moment(std::uint32_t i, bool acts = false) const;
  /// B of a fluid particle where the case has it, else I.
  Matrix renormalisation(std::uint32_t i) const;

  /// Rayleigh's dissipation function of eq. (10) for the velocities of all particles [W].
  double dissipation(const Vector& u) const {
    return dissipation(
        u, [&](std::uint32_t i) { return renormalisation(i); }, [&](std::uint32_t i) { return bulkViscosity(i); });
  }
  /// `b`: by what C is multiplied. `lambda`: in place of bulkViscosity().
  double dissipation(const Vector& u, const std::function<Matrix(std::uint32_t)>& b,
                     const std::function<double(std::uint32_t)>& lambda) const;

  /// C: fluid unknowns by all particles. `reach`: in h_p, from which on pairs are left out.
  Matrix gradientMatrix(double reach = 1) const;

  Matrix viscosityMatrix() const;

  /// n_0: that of a particle in a full lattice.
  double restDensity() const;

  /// kappa [n - n_0]_+ of all particles [Pa].
  Vector elasticPressure() const;

  /// b of eq. (16) between walls at rest, and the repulsion.
  Vector rightHandSide() const;

  /// A of eq. (16).
  Matrix matrix() const;
};

/// A of the scene by the matrix-free operator.
template <int D>
Vector applyOperator(Scene<D>& s, MphOperator<D>& a, const Vector& x);

}  // namespace treacle::test
