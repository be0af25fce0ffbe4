#include "wall_part.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

bool isConvex(const Shape& s) {
  const bool hollow = s.innerRadius > 0 || s.innerStartRadius > 0 || s.innerEndRadius > 0;
  return !hollow && s.kind != ShapeKind::Torus && !isSolid(s);
}

}  // namespace

template <int D>
WallPart<D>::WallPart(const Body& body, const Vec<D>& shift, const BodyCondition<D>* condition,
                      const Solid<D>* solid, double spacing)
    : shape_(body.shape),
      similarity_(similarityOf<D>(body.shape)),
      shift_(shift),
      condition_(condition),
      solid_(solid),
      slack_(1e-6 * spacing),
      convex_(isConvex(body.shape)) {
  const double own = spacing / similarity_.scale();  // before the transform
  if (shape_.kind == ShapeKind::Box)
    // Where a box is that thin, its only layer of particles stands outside of it.
    for (int k = 0; k < D; ++k)
      if (shape_.max[k] - shape_.min[k] < own / 2) shape_.max[k] = shape_.min[k] + own;
  const Extent box = boundingBox(shape_, D);
  min_ = (solid ? solid->min() : resized<D>(box.min)) + shift - Vec<D>::filled(slack_);
  max_ = (solid ? solid->max() : resized<D>(box.max)) + shift + Vec<D>::filled(slack_);
  faces_ = facesOf<D>(shape_, solid);
  for (Face<D>& face : faces_) {
    if (!solid) face.origin = similarity_.point(face.origin);
    face.origin += shift;
    face.normal = similarity_.direction(face.normal), face.axis = similarity_.direction(face.axis);
    face.radius *= similarity_.scale(), face.ring *= similarity_.scale();
  }
}

template <int D>
bool WallPart<D>::shapeContains(const Vec<D>& x) const {
  for (int k = 0; k < D; ++k)
    if (x[k] < min_[k] || x[k] > max_[k]) return false;
  if (solid_) return solid_->contains(x - shift_);
  return shape_.kind != ShapeKind::Particles &&
         treacle::contains<D>(shape_, similarity_.pointBefore(x - shift_), slack_ / similarity_.scale());
}

template <int D>
bool WallPart<D>::conditionHolds(const Vec<D>& x) const {
  return !condition_ || condition_->holds(x - shift_);
}

template class WallPart<2>;
template class WallPart<3>;

bool moveAlike(const Body& a, const Body& b) {
  constexpr double rounding = 1e-12;
  if (a.displacement != b.displacement) return false;
  const auto spin = [](const Body& body) {
    return body.rotation ? body.rotation->speed * body.rotation->direction() : Vec<3>{};
  };
  const auto swings = [](const Body& body) {
    return body.oscillation.period > 0 && norm(body.oscillation.amplitude) > 0;
  };
  if (a.kind != BodyKind::Wall || b.kind != BodyKind::Wall) return false;
  if (a.velocity != b.velocity || swings(a) != swings(b)) return false;
  if (swings(a) && a.oscillation != b.oscillation) return false;
  if ((a.rotation && a.rotation->angle) || (b.rotation && b.rotation->angle)) return a.rotation == b.rotation;
  const Vec<3> turn = spin(a);
  if (norm(turn - spin(b)) > rounding * norm(turn)) return false;
  if (norm(turn) == 0) return true;
  // Two points of one axis are centres of the same rotation.
  const Vec<3>& from = a.rotation->center;
  const Vec<3> apart = b.rotation->center - from;
  return norm(cross(turn, apart)) <= rounding * norm(turn) * (norm(from) + norm(apart));
}

}  // namespace treacle
