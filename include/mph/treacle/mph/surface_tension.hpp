#pragma once

#include "treacle/mph/pair_sums.hpp"

#include <numbers>
#include <span>

namespace treacle {

/// Surface tension of free surfaces as a stress along them, a continuum surface stress (docs/surface-tension.md):
///
///   sigma_i = |m_i|^2 I - t_i m_i m_i^T + l_i l_i^T [Pa],   m_i = G_i sqrt(2 gamma p(c_i) / (c_i |G_i|)) [Pa^1/2]
///
///   f_i = sum_j (sigma_i + sigma_j) grad w_ij - (|m_i|^2 + |m_j|^2) k [r_0 - r]_+ e / r_0^2 [N/m3]
///
///   G_i = sum_j grad w_ij [1/m],   c_i = sum_j w_ij,   p = 5/4 - c/3,   t = min(1, 2 c)
///
/// with w = A (1 - r^2/h^2)^5.5, d = x_j - x_i = r e. G is not zero near a free surface alone, whose normal it
/// has, and c is the colour, the sum of w, of which G is the gradient; walls are in both like fluid. The stress
/// has no component along G, so that a plane surface bears no force. The forces are those of pairs of fluid, equal
/// and opposite. Across a cut through a plane surface they add up to the integral of 2 gamma p dc, c rising from
/// 1/2 at the surface to 1: that is gamma, p being 1 in the mean. Its slope makes the tension of a lattice nearly
/// the same however it is stretched. t is 1 but for a particle that is outside of a plane surface, c <
/// 1/2, as one that stands on it alone: there it is 2 c, so that what has run out is drawn back. A tension lets
/// particles gather; the second term, with k = 0.5 and r_0 = 0.95 l, keeps those of the surface apart.
///
/// The tension acts at a mean depth delta_1 below the surface. Between there and the surface the pressure gamma
/// times the curvature is missing, which would push along the surface; and where the surface is curved c does not
/// begin at 1/2. Both are made up for by central forces between particles whose normals n differ:
///
///   f_i += B sum_j [1 - r^2/h^2]_+ |m_i| |m_j| e (e.(n_j - n_i)),   n_i along S_i = sum_j w_ij |m_j| m_j
///
/// which leave gamma (1 - delta kappa) of the tension along a direction of curvature kappa.
///
/// What a surface of uniform tension has of forces is along S, whose curvature is smooth. What else there is comes
/// of how the particles stand, and moves them without end: f_i less q_i S_i, where the curvature q is the fit of f
/// by q S among the neighbours. It is shared among them, surfacePasses times, by pair forces that are central
/// (what keeps particles apart is not):
///
///   f_i += sum_j k_ij (1 - (e.n)^2) e (e.(f_j - f_i)),   k = K [1 - r^2/h^2]_+,   n along |m_i| n_i + |m_j| n_j
///
/// n being shorter than 1 where m is noise. With K a particle of a full lattice takes, along the surface, just its
/// neighbours' mean. Not near walls, where forces along the surface are to be.
///
/// At walls the surface ends in a contact line. There G and c are continued as if the surface went on behind the
/// wall, and the wall holds what the stress pulls off it. In 3D the line is curved, and a tension along it pulls
/// it inward; the pairs of this tension that the wall hides are made up for by l, along the line. A wall that the
/// fluid wets, with a contact angle of at most 90 degrees, pulls it along itself by the gradient, along the wall,
/// of an energy that wall particles have per volume where fluid lies on them:
///
///   e_j = -gamma K(theta) 2 |H_j| F(f_j),   H_j = sum over walls of grad v_jk [1/m],   v = A_v (1 - r^2/h^2)^3
///
/// f_j being the share of what other walls leave around the particle that fluid has, with the weight v, and F a
/// smooth step of it from 0 to 0.85. The sum of 2 |H_j| over the depth of a wall is 1 per area, so that a line is
/// pulled by gamma K whatever its shape. A wall that is not wetted pushes at the stress itself.
///
/// Under surfaces that curve inward the pressure is less than zero, which kappa [n - n_0]_+ never is. Where they
/// lie well inside, or covered, particles bear that, too (Adhesion), unless a wall is near that is not wetted.

/// What a fluid particle has of fluid and of walls around it; sums of r^2 gradient are shares of a full lattice's.
template <int D>
struct SurfaceSums {
  Vec<D> fluid, wall;  // parts of G [1/m]
  double filled;       // with the share of the fluid
  double walls;        // of walls
  double colour;       // sum of w of fluid, the particle's own included
  double wallColour;   // of walls
  double repelled;     // share of walls that it does not wet, each with its K, which is negative
};

/// What a wall particle has of walls and of fluid around it, by the weight v unless told.
template <int D>
struct WallSums {
  Vec<D> wall;    // H [1/m]
  double walls;   // of walls, the particle's own included
  double filled;  // of fluid
  double colour;  // of both, by w
  double repels;  // of fluid that does not wet it, with its K, which is negative
};

/// What particles of fluid and of walls do against pressures below zero, and what these pull fluid by.
template <int D>
struct Adhesion {
  double rest;   // number density at which its pressure is zero, over n_0: that of a plane lattice at the same c
  double bears;  // share of a pressure below zero that it bears, 0 to 1
  Vec<D> along;  // of a wall: H_j 2 dF/df_j over what other walls leave around it [1/m]; of fluid nothing
};

/// What the stress of a particle follows from.
template <int D>
struct SurfaceSlope {
  Vec<D> m;    // [Pa^1/2]
  double tie;  // t [-]
};
template <>
struct SurfaceSlope<3> {
  Vec<3> m;
  double tie;
  Vec<3> line;  // l [Pa^1/2]
};

/// How well q S is the force f of a particle. Zero near walls and where there is no tension; anywhere else the
/// second is not.
struct SurfaceFit {
  double along;   // f.S [Pa N/m3]
  double square;  // S.S [Pa2]
};

/// Fields of the fluid that surfaceForces() sets, of own particles alone.
template <int D>
struct SurfaceForces {
  std::span<Vec<D>> force;     // of stress, and what ofWalls() has of it [N/m3]
  std::span<Vec<D>> unshared;  // what keeps particles apart and wetted walls pull [N/m3]
  std::span<Vec<D>> smoothed;  // S [Pa]
  std::span<Vec<D>> normal;    // |m| n [Pa^1/2]
  std::span<SurfaceFit> fit;
  std::span<Vec<D>> ofWalls{};  // unless empty: ofWalls(), over what they fill around a particle [N/m3]
};

template <int D>
struct SurfaceTerms {
  double inverseSquare = 0;      // 1/h^2 [1/m2]
  double weightFactor = 0;       // A, which makes the sum of w over a full lattice 1
  double gradientFactor = 0;     // 11 A / h^2 [1/m2]
  double shareFactor = 0;        // 1 over the sum of r^2 gradient over a full lattice
  double noise2 = 0;             // square of a |G| that particles in disorder have inside of the fluid [1/m2]
  double coreRadius = 0;         // r_0 [m]
  double coreFactor = 0;         // k / r_0^2 [1/m2]
  double bendFactor = 0;         // B [1/m]
  double evenFactor = 0;         // K
  double evenNoise = 0;          // |m|^2 that tells no direction, since particles in disorder have it [Pa]
  double wettingFactor = 0;      // A_v, which makes the sum of v over a full lattice 1
  double tension[maxMaterials];  // gamma [N/m]
  double pulls[maxMaterials * maxMaterials];  // pull(), by fluid and wall

  static constexpr int rows = 8;  // of a plane lattice, from the outermost one on
  double rowColour[rows];         // c
  double rowDensity[rows];        // n/n_0

  static SurfaceTerms make(const Case& c);

  /// K(theta), what a wall of one material pulls a fluid of another along itself, over gamma.
  TREACLE_HD double pull(int fluid, int wall) const { return pulls[fluid * int{maxMaterials} + wall]; }
  /// The same for walls that it wets [N/m], and for those that it does not, over gamma; else nothing.
  TREACLE_HD double wetPull(int fluid, int wall) const { return tension[fluid] * fmax(pull(fluid, wall), 0.0); }
  TREACLE_HD double dryPull(int fluid, int wall) const { return fmin(pull(fluid, wall), 0.0); }

  /// grad w = gradient d, d = x_j - x_i; r2 = d.d
  template <class Real>
  TREACLE_HD Real gradient(const Real& r2) const {
    const Real part = nearness(r2), square = part * part;
    return gradientFactor * (square * square * squareRoot(part));
  }
  /// w
  template <class Real>
  TREACLE_HD Real weight(const Real& r2) const {
    const Real part = nearness(r2), square = part * part;
    return weightFactor * (square * square * part * squareRoot(part));
  }
  /// v
  template <class Real>
  TREACLE_HD Real wetting(const Real& r2) const {
    const Real part = nearness(r2);
    return wettingFactor * (part * part * part);
  }
  /// grad v = wettingGradient d
  template <class Real>
  TREACLE_HD Real wettingGradient(const Real& r2) const {
    const Real part = nearness(r2);
    return 6 * wettingFactor * inverseSquare * (part * part);
  }
  /// The force of a wall particle on a fluid particle at x_i over wetPull() [1/m2], d = x_j - x_i; the wall
  /// particle has the opposite.
  template <class T, class Along>
  TREACLE_HD Vec<D, T> alongWall(const Vec<D, T>& d, const T& r2, const Vec<D, Along>& along) const {
    constexpr double tiny = 1e-100;  // of a wall particle that does not pull
    const Along size = squareRoot(norm2(along));
    const T across = treacle::along(along, d) / (size + tiny), g = wettingGradient(r2);
    Vec<D, T> force;
    for (int k = 0; k < D; ++k) force[k] = g * (size * d[k] - across * along[k]);
    return force;
  }
  /// The share that a neighbour fills, from its gradient.
  template <class Real>
  TREACLE_HD Real share(const Real& gradient, const Real& r2) const {
    return shareFactor * gradient * r2;
  }
  /// What is to be multiplied by -(|m_i|^2 + |m_j|^2) d.
  template <class Real>
  TREACLE_HD Real core(const Real& inverseDistance) const {
    return coreFactor * positivePart(coreRadius * inverseDistance - 1.0);
  }
  /// What is to be multiplied by |m_i| |m_j| (n_j - n_i).d d.
  template <class Real>
  TREACLE_HD Real bending(const Real& r2, const Real& inverseDistance) const {
    return bendFactor * nearness(r2) * (inverseDistance * inverseDistance);
  }
  /// [1 - r^2/h^2]_+
  template <class Real>
  TREACLE_HD Real nearness(const Real& r2) const {
    return positivePart(1.0 - inverseSquare * r2);
  }
  /// p, of a colour c
  TREACLE_HD static double profile(double colour) { return 1.25 - colour / 3; }
  /// The share of the lattice around a particle that walls leave, at least what a particle between two of them has
  /// that close up on it.
  TREACLE_HD static double besideWalls(const SurfaceSums<D>& s) { return fmax(1 - s.walls, 0.1); }
  /// The share that fluid has of the colour that walls leave around a fluid particle, at most 1.
  TREACLE_HD static double openColour(const SurfaceSums<D>& s) {
    return s.colour / fmax(1 - s.wallColour, s.colour);  // the latter never less than the fluid that is there
  }
  /// Of a particle, 2 gamma p |G| / c being |m|^2 where |G| is more than noise. Of what lies along a wall, and of
  /// c, the wall hides its share s, and of the stress along a contact line, which is |m|^2, s/(1 - s) of what is
  /// left. Where surface and wall are parallel there is no line.
  TREACLE_HD SurfaceSlope<D> slope(int material, const SurfaceSums<D>& s) const {
    Vec<D> g = s.fluid + s.wall;
    const double size2 = norm2(s.wall);
    if (size2 > 0) g += (g - s.wall * (dot(g, s.wall) / size2)) * (s.walls / besideWalls(s));
    const double colour = openColour(s);
    const double m2 = 2 * tension[material] * profile(colour) / (colour * sqrt(norm2(g) + noise2));
    SurfaceSlope<D> result;
    result.m = g * sqrt(m2), result.tie = fmin(1.0, 2 * colour);
    if constexpr (D == 3) {
      const Vec<D> line = cross(s.wall, result.m);  // |H| |m| times the sine of the angle between surface and wall
      const double all = size2 * norm2(result.m);
      result.line = all > 0
                        ? line * sqrt(norm2(result.m) * s.walls / (besideWalls(s) * (norm2(line) + 0.01 * all)))
                        : Vec<D>{};
    }
    return result;
  }
  /// From 0 at a to 1 at b and beyond.
  TREACLE_HD static double smoothStep(double x, double a, double b) {
    const double t = fmin(1.0, fmax(0.0, (x - a) / (b - a)));
    return t * t * (3 - 2 * t);
  }
  /// n/n_0 of a particle of a plane lattice, or between its rows, of the colour c.
  TREACLE_HD double restShare(double colour) const {
    if (colour <= rowColour[0]) return rowDensity[0] * colour / rowColour[0];
    for (int row = 1; row < rows; ++row)
      if (colour < rowColour[row])
        return rowDensity[row - 1] + (rowDensity[row] - rowDensity[row - 1]) * (colour - rowColour[row - 1]) /
                                         (rowColour[row] - rowColour[row - 1]);
    return 1;
  }
  /// Of fluid: its outermost row has less than 0.8 of the colour that walls leave, the second one more than 0.9.
  TREACLE_HD Adhesion<D> adhesion(const SurfaceSums<D>& s) const {
    return {restShare(s.colour + s.wallColour), s.repelled < 0 ? 0 : smoothStep(openColour(s), 0.8, 0.9), {}};
  }
  /// Of a wall particle; deep ones have next to nothing beside them. dF/df = 6 x (1 - x) / full, x = f / full.
  TREACLE_HD Adhesion<D> adhesion(const WallSums<D>& s) const {
    const double beside = fmax(1 - s.walls, 0.01), share = s.filled / beside, full = 0.85;
    const double part = fmin(1.0, share / full);
    return {restShare(s.colour), s.repels < 0 ? 0 : smoothStep(fmin(share, s.colour), 0.6, 0.7),
            s.wall * (2 * 6 * part * (1 - part) / (full * beside))};
  }
  /// What of the stress of a particle, that gives it `ofFluid`, the walls hold, and what those that it does not
  /// wet push it along themselves [N/m3].
  TREACLE_HD Vec<D> ofWalls(const SurfaceSums<D>& s, const Vec<D>& m, const Vec<D>& ofFluid) const {
    const double size = norm(s.wall), m2 = norm2(m);
    if (!(size > 0 && m2 > 0)) return {};
    const Vec<D> inward = s.wall * (1 / size), along = m - inward * dot(m, inward);
    const double sine = norm(along) / sqrt(m2);  // of the angle between surface and wall
    if (!(sine > 0)) return {};
    const double line = 2 * m2 * size * fmin(1.0, s.filled / besideWalls(s));
    const double away = -dot(ofFluid, inward), most = line * sine * sine;
    const double held = away < 0 ? 0 : away < most ? away : most;
    return inward * held - along * (line * s.repelled / (s.walls * sqrt(m2)));
  }
  /// All of `of` for particle i, whose S is there, where the stress of the fluid gives `ofFluid`.
  TREACLE_HD void finish(int material, std::uint32_t i, const SurfaceSums<D>& s, const Vec<D>& m,
                         const Vec<D>& ofFluid, const SurfaceForces<D>& of) const {
    const Vec<D> smoothed = of.smoothed[i], wall = ofWalls(s, m, ofFluid), force = ofFluid + wall;
    const double size2 = norm2(smoothed);
    of.force[i] = force;
    of.normal[i] = size2 > 0 ? smoothed * sqrt(norm2(m) / size2) : Vec<D>{};
    // Never quite zero where forces are shared: S may be rounding alone.
    const double least = 1e-6 * evenNoise;
    of.fit[i] = s.walls > 0 || tension[material] == 0 ? SurfaceFit{0, 0}
                                                      : SurfaceFit{dot(smoothed, force), size2 + least * least};
    if (!of.ofWalls.empty()) of.ofWalls[i] = s.walls > 0 ? wall * (1 / s.walls) : Vec<D>{};
  }
  /// Moves q S from the force of particle i to what is not shared; `fitted`: the sums of its neighbours.
  TREACLE_HD void split(std::uint32_t i, const SurfaceFit& fitted, const SurfaceForces<D>& of) const {
    if (of.fit[i].square == 0) return;
    const Vec<D> smooth = of.smoothed[i] * (fitted.along / fitted.square);
    of.force[i] -= smooth;
    of.unshared[i] += smooth;
  }
};

/// Of |m_i|^2 per volume, the energy of the surface, gamma per area: 1 over the integral of 2 p/c dc
/// from 1/2 to 1.
inline constexpr double surfaceEnergyShare = 1 / (2.5 * std::numbers::ln2 - 1.0 / 3);

/// How often noise is shared. In 3D more leaves the fastest particles of a ball as fast, and its pressure is
/// higher.
template <int D>
inline constexpr int surfacePasses = D == 2 ? 8 : 4;

/// Per own fluid particle the sums, its slope and how it bears pressures below zero.
template <int D, class Backend>
void surfaceSlope(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<SurfaceSums<D>> sums,
                  std::span<SurfaceSlope<D>> slope, std::span<Adhesion<D>> adhesion);

/// Per wall particle of a list that reaches to h, from the first wall particle on.
template <int D, class Backend>
void wallAdhesion(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&, const ClusterListView& walls,
                  std::span<WallSums<D>> sums, std::span<Adhesion<D>> adhesion);

/// `slope` of all fluid, `adhesion` of all active particles, ghosts included.
template <int D, class Backend>
void surfaceForces(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,
                   std::span<const SurfaceSums<D>> sums, std::span<const SurfaceSlope<D>> slope,
                   std::span<const Adhesion<D>> adhesion, const SurfaceForces<D>& of);

/// Per own fluid particle: adds to `force` what makes up for the depth of the tension, and moves the smooth part
/// of it along the surface's curvature, q S, to `unshared`: what is left in `force` is to be shared. `normal` and
/// `fit` of all fluid, ghosts included; `fitted` is room for sums.
template <int D, class Backend>
void bendSurface(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&, const SurfaceForces<D>& of,
                 std::span<SurfaceFit> fitted);

/// What forces are shared by: `normal`, `fit` (see SurfaceForces) and f [N/m3] of all fluid, ghosts included.
template <int D>
struct SharedForces {
  std::span<const Vec<D>> normal;
  std::span<const SurfaceFit> fit;  // where it is zero nothing is shared
  std::span<const Vec<D>> f;
  std::span<Vec<D>> y;                    // the result, per own fluid particle [N/m3]
  std::span<const Vec<D>> unshared = {};  // added to it unless empty
};

/// Sets y_i to f_i and what the particle shares of it with its neighbours along the surface.
template <int D, class Backend>
void evenAlongSurface(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&, const SharedForces<D>& of);

/// y += f per own fluid particle [N/m3].
template <int D, class Backend>
void addSurfaceForces(Context<Backend>&, std::span<const Vec<D>> f, std::span<Vec<D>> y);

/// The reaction of walls.
template <int D>
struct WallReactions {
  std::span<const Vec<D>> ofWalls;        // SurfaceForces::ofWalls of all fluid, ghosts included
  std::span<const Adhesion<D>> adhesion;  // of active particles
  std::span<Vec<D>> y, load;              // per wall particle of the list [N/m3]
};

/// Sets y to the reaction and adds it to `load`.
template <int D, class Backend>
void surfaceOnWalls(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&, const ClusterListView& walls,
                    const WallReactions<D>& of);

}  // namespace treacle
