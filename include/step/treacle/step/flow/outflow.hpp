#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// An outflow of a case as a test of places.
template <int D>
struct OutflowRegion {
  Vec<D> low{}, high{};      // of a box [m]
  Vec<D> point{}, normal{};  // of a plane [m]
  bool isPlane = false;

  static OutflowRegion of(const Outflow& o) {
    return {resized<D>(o.min), resized<D>(o.max), resized<D>(o.point), resized<D>(o.normal),
            o.kind == OutflowKind::Plane};
  }

  TREACLE_HD bool holds(const Vec<D>& x) const {
    if (isPlane) return dot(x - point, normal) > 0;
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

/// The formula, for one place.
template <int D>
TREACLE_HD std::uint8_t regionOf(const OutflowRegion<D>* regions, std::size_t count, const Vec<D>& x) {
  for (std::size_t k = 0; k < count; ++k)
    if (regions[k].holds(x)) return static_cast<std::uint8_t>(k + 1);
  return 0;
}

}  // namespace treacle
