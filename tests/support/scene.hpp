#pragma once

#include "support/dense.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_operator.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/search/buckets.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace treacle::test {

/// A small body of fluid on a floor in a periodic domain, jittered, with two materials, one of which slips:
/// everything that a step prepares before its solve, and the same state for oracles that know only positions and
/// constants. For D = 2 and 3, as all templates of this folder that are declared in a header and defined in a
/// source.
template <int D>
struct Scene {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  std::unique_ptr<MphNeighbourhood<D>> neighbourhood;
  Buffer<WallSurface<D>> wallSurface;         // per active wall particle
  Buffer<SymmetricBlock<D>> renormalisation;  // per fluid particle where the case has it
  Buffer<double> viscosityScale;              // likewise
  Buffer<double> wallShare;                   // per active particle where the case lets gaps close
  Buffer<Block<D>> wallBlock;
  Buffer<Vec<D>> wallGradient;

  WallTerms<D> terms() { return {wallBlock.span(), wallGradient.span()}; }
  double volume() const { return std::pow(c.spacing, D); }
  const MphPairs<D>& pairs() const { return neighbourhood->pairs(); }
  const CellRanges<>& ranges() const { return neighbourhood->ranges(); }
  std::uint32_t n() const { return pairs().fluidCount; }
  Index unknowns() const { return Index{D} * n(); }
};

Case sceneCase(int dimensions, bool twoMaterials = true, SchemeKind scheme = SchemeKind::Published);

template <int D>
using Where = std::function<bool(const Vec<D>&)>;

/// Fluid and wall particles at jittered lattice points; fluid where inFluid(x), wall where inWall(x) says so.
template <int D>
Particles<D> jitteredLattice(const Case& c, double jitter, unsigned seed, const Where<D>& inFluid,
                             const Where<D>& inWall);

/// Gives the wall particles a surface at this height [m], and every third one another face beside it, where the
/// case's method looks at surfaces.
template <int D>
void knowSurface(const Case& c, double height, Particles<D>& p);

/// Brings particles into the state of a step before its solve.
template <int D>
void prepare(Scene<D>& s);

enum class Walls { Floor, None };

inline constexpr SchemeKind bothSchemes[] = {SchemeKind::Published, SchemeKind::Accurate};
inline const char* nameOf(SchemeKind scheme) { return scheme == SchemeKind::Published ? "published" : "accurate"; }

struct SceneOptions {
  Walls walls = Walls::Floor;
  unsigned seed = 1;
  double jitter = 0.2;  // of the places [spacings]
  bool twoMaterials = true;
  SchemeKind scheme = SchemeKind::Published;
  bool slips = true;  // the second of two materials; what assembles the matrix does not know that
};
template <int D>
Scene<D> makeScene(const SceneOptions& options = {});

/// One vector per particle as a vector of numbers, and back.
template <int D>
Vector flat(std::span<const Vec<D>> v) {
  return Vector(std::span(reinterpret_cast<const double*>(v.data()), D * v.size()));
}
template <int D>
std::vector<Vec<D>> unflat(const Vector& v) {
  std::vector<Vec<D>> r(v.size() / D);
  for (Index i = 0; i < v.size(); ++i) r[i / D][i % D] = v[i];
  return r;
}

}  // namespace treacle::test
