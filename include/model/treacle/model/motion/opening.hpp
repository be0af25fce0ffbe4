#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace treacle {

/// What an opening does to the fluid in its reserve, behind its face (docs/inflow.md). Over the first layers of
/// the reserve the pressure shall rise from zero to what is given at the face:
///
///   p(x) = c P,   P = pressure + rho (V(center) - V(x)),   f = grad p - rho g = c' P n - (1 - c) rho g
///
/// with the direction n of the face, and the potential V of the weight g: gravity, in a frame that turns with the
/// centrifugal force. c' is a trapezoid in the depth, one spacing wide at both ends, so that its
/// sum over a lattice is the same wherever the layers stand. Behind it fluid has no weight. Fluid of MPH-I, which
/// bears tension, pulls a tail of two layers along, on which nothing acts. Fluid of ISPH would leave such a tail
/// behind, so there the pressure rises over all layers. The friction of walls beside the reserve is made up for,
/// too: their mean force in the last step acts the other way.
template <int D>
struct OpeningForce {
  Vec<D> center{}, direction{};    // of the face [m]; into the case, of length 1
  Vec<D> axes[D - 1]{};            // of length 1, across it
  double half[D - 1]{};            // how far the face reaches along these [m]
  double radius = 0;               // of a disc; 0: it is a rectangle [m]
  double spacing = 0;              // l [m]
  double pressure = 0;             // at the centre [Pa]
  double drag = 0;                 // along the direction, against the friction [N/m3]
  int rises = 4;                   // c' is 1 / (rises l) between its ends; 6 with ISPH
  static constexpr int tail = 5;   // from where on fluid goes straight on [spacings]
  static constexpr int depth = 7;  // of the reserve [spacings]
  static constexpr int end = 10;   // beyond which fluid has nothing to do with the opening [spacings]

  /// How far behind the face [spacings].
  TREACLE_HD double behind(const Vec<D>& x) const { return -dot(x - center, direction) / spacing; }

  /// Whether x is in front of the face or behind it, and no more than `margin` spacings beside it.
  TREACLE_HD bool isAcross(const Vec<D>& x, double margin) const {
    double square = 0;
    for (int k = 0; k < D - 1; ++k) {
      const double a = dot(x - center, axes[k]);
      if (radius == 0 && fabs(a) > half[k] + margin * spacing) return false;
      square += a * a;
    }
    return radius == 0 || square <= (radius + margin * spacing) * (radius + margin * spacing);
  }
  /// Whether x is behind the face, or in front of it, by more than `from` spacings.
  TREACLE_HD bool isBehind(const Vec<D>& x, double from) const {
    const double t = behind(x);
    return t > from && t < end && isAcross(x, 0.5);
  }
  /// In the last layers of the reserve.
  TREACLE_HD bool isInTail(const Vec<D>& x) const { return isBehind(x, tail); }
  TREACLE_HD bool isInReserve(const Vec<D>& x) const { return isBehind(x, 0); }

  /// c' [1/m]; zero outside the reserve. Its mean over the fluid times the speed is the flow through the face.
  TREACLE_HD double rise(const Vec<D>& x) const {
    if (!isInReserve(x)) return 0;
    const double t = behind(x), rest = rises + 1 - t;
    return (t < 1 ? t : rest > 1 ? 1 : rest > 0 ? rest : 0) / (rises * spacing);
  }
  /// f [N/m3] on fluid of a density [kg/m3] at x, with the weight g there [m/s2] and V(center) - V(x) [m2/s2];
  /// zero outside the reserve.
  TREACLE_HD Vec<D> at(const Vec<D>& x, double density, const Vec<D>& weight, double drop) const {
    if (!isInReserve(x)) return {};
    return (pressure * rise(x) + drag) * direction + ofWeight(x, density, weight, drop);
  }
  /// The part of it that the weight has, for what the weight has beside that of the density, too.
  TREACLE_HD Vec<D> ofWeight(const Vec<D>& x, double density, const Vec<D>& weight, double drop) const {
    if (!isInReserve(x)) return {};
    const double t = behind(x), rest = rises + 1 - t;
    const double risen = t < 1 ? t * t / 2 : rest > 1 ? t - 0.5 : rest > 0 ? rises - rest * rest / 2 : rises;
    return density * (drop * rise(x) * direction - risen / rises * weight);
  }
};

/// The face of an opening of a case, and the columns of particles in its reserve.
template <int D>
class OpeningFace {
 public:
  /// Errors: InputError where no particle has room in the face.
  OpeningFace(const Case& c, const Opening& opening);

  /// Over a time from `from` to `to` [s]; without its pressure where a flow rate is given. Errors: InputError for
  /// a formula without a value.
  OpeningForce<D> force(double from, double to) const;
  bool hasFlowRate() const { return flowRate_.has_value(); }
  /// Likewise [m3/s; m2/s in 2D].
  double flowRate(double from, double to) const;
  const OpeningForce<D>& place() const { return place_; }

  std::size_t columns() const { return columns_.size(); }
  /// The place in a column that is so many spacings behind the face [m].
  Vec<D> at(std::size_t column, double behind) const;
  /// Calls f with each column that passes x at less than 0.71 spacings, so that each x across the face has one.
  template <class F>
  void forEachColumnNear(const Vec<D>& x, F&& f) const {
    for (const std::uint32_t column : candidates(x))
      if (norm2(acrossOf(x) - columns_[column]) < 0.71 * 0.71) f(column);
  }

 private:
  using Across = Vec<D - 1>;  // along the axes [spacings]

  Across acrossOf(const Vec<D>& x) const;
  std::span<const std::uint32_t> candidates(const Vec<D>& x) const;
  std::size_t cellOf(const Across& a) const;

  std::optional<TimeFunction> pressure_, flowRate_;
  OpeningForce<D> place_;
  std::vector<Across> columns_;
  Across low_{};                                  // corner of a grid of cells with an edge of one spacing
  std::array<int, D - 1> cells_{};                // of the grid
  std::vector<std::vector<std::uint32_t>> near_;  // per cell: the columns in it and next to it
};

extern template class OpeningFace<2>;
extern template class OpeningFace<3>;

}  // namespace treacle
