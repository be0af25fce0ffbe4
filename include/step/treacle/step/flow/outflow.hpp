#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/opening.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// An outflow of a case, or what is behind the reserve of an opening, as a test of places.
template <int D>
struct OutflowRegion {
  Vec<D> low{}, high{};      // of a box [m]
  Vec<D> point{}, normal{};  // of a plane [m]
  bool isPlane = false;
  OpeningForce<D> opening{};  // of an opening, whose spacing is not zero

  static OutflowRegion of(const Outflow& o) {
    return {resized<D>(o.min), resized<D>(o.max), resized<D>(o.point), resized<D>(o.normal),
            o.kind == OutflowKind::Plane};
  }
  static OutflowRegion of(const OpeningForce<D>& opening) { return {{}, {}, {}, {}, false, opening}; }

  TREACLE_HD bool holds(const Vec<D>& x) const {
    if (isPlane) return dot(x - point, normal) > 0;
    if (opening.spacing > 0) return opening.isBehind(x, opening.depth + 0.5);
    for (int k = 0; k < D; ++k)
      if (!(x[k] >= low[k] && x[k] <= high[k])) return false;
    return true;
  }
};

/// Particles and where they may leave; spans in the backend's memory.
template <int D>
struct OutflowTest {
  std::span<const OutflowRegion<D>> regions;  // fewer than 255
  std::span<const Vec<D>> position;           // [m]
  std::span<const std::uint8_t> material;
};

/// Sets gone[i] to 1 + the first region that holds particle i, 0 where none does. Returns how many of each
/// material every region takes, [region * maxMaterials + material].
template <int D, class Backend>
std::vector<std::uint32_t> markOutflow(Context<Backend>&, const OutflowTest<D>& test,
                                       std::span<std::uint8_t> gone);

/// Fluid in front of the face of an opening, by a spacing and a bit at most, or in its reserve.
template <int D>
struct ReserveParticle {
  std::uint32_t opening;
  double behind;  // the face [spacings]
  double speed;   // along the direction of the face [m/s]
  Vec<D> x;       // [m]
};

/// The particles that are such ones and are not gone, in their order. Spans in the backend's memory.
template <int D, class Backend>
std::vector<ReserveParticle<D>> findReserves(Context<Backend>&, std::span<const OpeningForce<D>> openings,
                                             std::span<const Vec<D>> position, std::span<const Vec<D>> velocity,
                                             std::span<const std::uint8_t> gone);

/// straight_i = u_i, in the tails of reserves its part along the direction of the face: there nothing but the
/// columns that it came in by holds the fluid together.
template <int D, class Backend>
void straightenTails(Context<Backend>&, std::span<const OpeningForce<D>> openings,
                     std::span<const Vec<D>> position, std::span<const Vec<D>> u, std::span<Vec<D>> straight);

/// Flow through the face of an opening, into the case, of all processes: the mean over what pressures push on
/// [m3/s; m2/s in 2D].
template <int D, class Backend>
double openingFlow(Context<Backend>&, const OpeningForce<D>& opening, std::span<const Vec<D>> position,
                   std::span<const Vec<D>> u);

/// The mean of a vector of particles in the reserve of an opening, of all processes, along its direction; 0 where
/// there are none.
template <int D, class Backend>
double meanInReserve(Context<Backend>&, const OpeningForce<D>& opening, std::span<const Vec<D>> position,
                     std::span<const Vec<D>> vector);

/// The formula, for one place: which opening a particle is at, `count` for none.
template <int D>
TREACLE_HD std::size_t openingAt(const OpeningForce<D>* openings, std::size_t count, const Vec<D>& x) {
  for (std::size_t k = 0; k < count; ++k)
    if (openings[k].isBehind(x, -1.2)) return k;
  return count;
}

/// Likewise: the region that holds it, from 1 on.
template <int D>
TREACLE_HD std::uint8_t regionOf(const OutflowRegion<D>* regions, std::size_t count, const Vec<D>& x) {
  for (std::size_t k = 0; k < count; ++k)
    if (regions[k].holds(x)) return static_cast<std::uint8_t>(k + 1);
  return 0;
}

}  // namespace treacle
