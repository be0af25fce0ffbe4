#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/case/case.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// A rectangle on the surface of a wall, in 2D a line, and which wall particles bear what is on it: those of the
/// body that lie across from it, each as a cube of a spacing, as far in as fluid acts.
template <int D>
struct WallPatch {
  std::uint8_t body = 0;
  Vec<D> corner{}, along{}, up{}, normal{};  // [m]; unit vectors at right angles, in 2D without up
  Vec<D> period{};                           // of the domain, 0 on open axes [m]
  double width = 0, height = 0;              // [m]
  double depth = 0;                          // [m]
  double spacing = 0;                        // [m]

  /// Of a probe of the kind WallPressure, as it stands (carriedProbe).
  static WallPatch of(const Probe& probe, const Case& c);
  /// [m2; m in 2D]
  double area() const { return width * (D == 3 ? height : 1); }

  /// From the corner to x, or to an image of it that is nearest to the middle of the patch [m].
  TREACLE_HD Vec<D> way(const Vec<D>& x) const {
    const Vec<D> middle = corner + 0.5 * width * along + 0.5 * height * up;
    Vec<D> d = x - middle;
    for (int k = 0; k < D; ++k)
      if (period[k] > 0) d[k] -= period[k] * std::rint(d[k] / period[k]);
    return d + middle - corner;
  }
  /// The share of a particle that lies across from the patch.
  TREACLE_HD double share(const Vec<D>& way) const {
    if (std::fabs(dot(way, normal)) > depth) return 0;
    return covered(dot(way, along), width) * (D == 3 ? covered(dot(way, up), height) : 1);
  }

 private:
  TREACLE_HD double covered(double place, double length) const {
    const double from = std::fmax(place - spacing / 2, 0.0), to = std::fmin(place + spacing / 2, length);
    return std::fmax(to - from, 0.0) / spacing;
  }
};

/// What active wall particles add to the load of a patch; spans in the backend's memory, all of the same length.
template <int D>
struct PatchTerms {
  enum { Force, Side = Force + D, Shares, count };  // places of the sums

  WallPatch<D> patch;
  std::span<const std::uint8_t> body;
  std::span<const Vec<D>> position;  // [m]
  std::span<const Vec<D>> force;     // [N/m3]

  TREACLE_HD void add(std::size_t i, double* sums) const {
    if (body[i] != patch.body) return;
    const Vec<D> way = patch.way(position[i]);
    const double share = patch.share(way);
    for (int k = 0; k < D; ++k) sums[Force + k] += share * force[i][k];
    sums[Side] += share * dot(way, patch.normal);
    sums[Shares] += share;
  }
};

/// Pressure on the patch by the force that pushes into the wall [Pa]; not a number where no wall particle is
/// across from it. Collective.
template <int D, class Backend>
double patchPressure(Context<Backend>&, const PatchTerms<D>&);

}  // namespace treacle
