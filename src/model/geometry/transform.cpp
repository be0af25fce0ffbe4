#include "treacle/model/geometry/transform.hpp"

#include <cmath>
#include <numbers>

namespace treacle {
namespace {

/// A vector turned about an axis, a unit vector, by an angle [rad].
Vec<3> turned(const Vec<3>& x, const Vec<3>& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return x * c + cross(axis, x) * s + axis * (dot(axis, x) * (1 - c));
}

}  // namespace

template <int D>
Similarity<D>::Similarity() {
  for (int k = 0; k < D; ++k) columns_[k] = {}, columns_[k][k] = 1;
}

template <int D>
Similarity<D>::Similarity(const Transform& t) : Similarity() {
  constexpr double degree = std::numbers::pi / 180;
  turns_ = t.angle != 0 || norm2(t.angles) > 0;
  for (int k = 0; turns_ && k < D; ++k) {
    Vec<3> column = resized<3>(columns_[k]);
    if (t.angle != 0) column = turned(column, t.axis * (1 / norm(t.axis)), t.angle * degree);
    for (int m = 0; m < 3; ++m) {
      Vec<3> axis{};
      axis[m] = 1;
      if (t.angles[m] != 0) column = turned(column, axis, t.angles[m] * degree);
    }
    columns_[k] = resized<D>(column);
  }
  scale_ = t.scale;
  const Vec<D> center = resized<D>(t.center);
  origin_ = center + resized<D>(t.translate) - direction(center) * scale_;
}

template <int D>
Vec<D> Similarity<D>::direction(const Vec<D>& d) const {
  if (!turns_) return d;
  Vec<D> sum{};
  for (int k = 0; k < D; ++k) sum += columns_[k] * d[k];
  return sum;
}

template <int D>
Vec<D> Similarity<D>::directionBefore(const Vec<D>& d) const {
  if (!turns_) return d;
  Vec<D> products{};
  for (int k = 0; k < D; ++k) products[k] = dot(columns_[k], d);
  return products;
}

template class Similarity<2>;
template class Similarity<3>;

}  // namespace treacle
