#pragma once

#include "treacle/core/vec.hpp"

namespace treacle {

/// What a shape goes through after its own coordinates: scaled and turned about `center`, then moved. Turned by
/// one angle about an axis, or by three about the axes x, y and z of the case, in this order.
struct Transform {
  double scale = 1;      // positive
  Vec<3> axis{0, 0, 1};  // of any length but zero; in two dimensions this one
  double angle = 0;      // about it, counter-clockwise seen from its end [deg]
  Vec<3> angles{};       // [deg]
  Vec<3> center{};       // [m]
  Vec<3> translate{};    // [m]

  bool operator==(const Transform&) const = default;
};

/// The same as a map of points, in D dimensions.
template <int D>
class Similarity {
 public:
  /// The identity.
  Similarity();
  explicit Similarity(const Transform& transform);

  double scale() const { return scale_; }
  bool turns() const { return turns_; }
  Vec<D> point(const Vec<D>& x) const { return direction(x) * scale_ + origin_; }
  /// Turned alone.
  Vec<D> direction(const Vec<D>& d) const;
  /// Where a point came from.
  Vec<D> pointBefore(const Vec<D>& x) const { return directionBefore(x - origin_) * (1 / scale_); }
  Vec<D> directionBefore(const Vec<D>& d) const;

 private:
  Vec<D> columns_[D];  // of the rotation
  Vec<D> origin_{};    // where 0 goes [m]
  double scale_ = 1;
  bool turns_ = false;
};

extern template class Similarity<2>;
extern template class Similarity<3>;

}  // namespace treacle
