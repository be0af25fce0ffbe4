#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/side.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace treacle {

/// How high the nodes of a lattice are above a thin sheet where it stands at the start, in sixteenths of a
/// spacing: more than 0 before its front, less behind it, and 0 where the sheet is not beside them.
template <int D>
struct SideMap {
  static constexpr double unitsOfSpacing = 16;

  Vec<D> origin{};  // of node 0 [m]
  double edge = 0;  // between nodes, half a spacing [m]
  Vec<D, std::int32_t> count{};
  std::vector<std::int8_t> height;  // x fastest
};

/// That of a body which is a thin sheet. Errors: InputError for a sheet whose other side faces it, for one that is
/// no surface with two sides, and for one too large.
template <int D>
SideMap<D> makeSideMap(const Case& c, const Body& body);

/// A thin sheet as it is now: its map, and how places get to where they would be at the start. Memory is that of a
/// backend.
template <int D>
struct PlacedSheet {
  Vec<D> origin{};
  double inverseEdge = 0;
  Vec<D, std::int32_t> count{};
  const std::int8_t* height = nullptr;
  Vec<D> center{}, start{};     // what it turns about, now and at the start [m]
  Vec<D> period{};              // of the domain, 0 on open axes [m]
  Vec<3> axis{};                // of the rotation, of length 1
  double sine = 0, cosine = 1;  // of the angle turned since the start

  /// The height of the node that is nearest to x.
  TREACLE_HD int heightAt(const Vec<D>& x) const {
    Vec<D> d = x - center;
    for (int k = 0; k < D; ++k)
      if (period[k] > 0) d[k] -= period[k] * std::rint(d[k] / period[k]);
    d = start + turnedBack(d);
    std::size_t node = 0;
    for (int k = D - 1; k >= 0; --k) {
      const double at = std::rint((d[k] - origin[k]) * inverseEdge);
      if (!(at >= 0 && at < count[k])) return 0;
      node = node * static_cast<std::size_t>(count[k]) + static_cast<std::size_t>(at);
    }
    return height[node];
  }

 private:
  TREACLE_HD Vec<D> turnedBack(const Vec<D>& v) const {
    if constexpr (D == 2) {
      const double s = axis[2] * sine;
      return {cosine * v[0] + s * v[1], -s * v[0] + cosine * v[1]};
    } else {
      return cosine * v - sine * cross(axis, v) + ((1 - cosine) * dot(axis, v)) * axis;
    }
  }
};

/// `height`: that of the map, in the memory of a backend; `time` [s].
template <int D>
PlacedSheet<D> placedSheet(const Case& c, const Body& body, const SideMap<D>& map, const std::int8_t* height,
                           double time);

/// A word of sides after its particle has come to a place of this height beside a sheet: what the pressure has
/// pushed a little into the sheet stays on its side.
TREACLE_HD inline std::uint32_t movedSide(std::uint32_t word, int sheet, int height) {
  constexpr int held = 12;  // three quarters of a spacing
  const std::uint32_t before = sides::of(word, sheet), there = height == 0  ? sides::None
                                                               : height > 0 ? sides::Front
                                                                            : sides::Back;
  const bool stays = before != sides::None && height != 0 && (height > 0 ? height : -height) <= held;
  return stays ? word : sides::with(word, sheet, there);
}

/// The words of all particles of a case's start, with its sheets where they stand then. Errors: those of
/// makeSideMap.
template <int D>
void createSides(const Case& c, Particles<D>& particles);

extern template SideMap<2> makeSideMap<2>(const Case&, const Body&);
extern template SideMap<3> makeSideMap<3>(const Case&, const Body&);
extern template PlacedSheet<2> placedSheet<2>(const Case&, const Body&, const SideMap<2>&, const std::int8_t*,
                                              double);
extern template PlacedSheet<3> placedSheet<3>(const Case&, const Body&, const SideMap<3>&, const std::int8_t*,
                                              double);
extern template void createSides<2>(const Case&, Particles<2>&);
extern template void createSides<3>(const Case&, Particles<3>&);

}  // namespace treacle
