#pragma once

#include "solid.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/case/expression.hpp"
#include "treacle/model/geometry/transform.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace treacle {

/// The places that a body holds at the start: those in its shape that `where` and `subtract` leave to it.
/// Particles of a file have no shape and hold none. Not for several threads at once.
template <int D>
class BodyRegion {
 public:
  BodyRegion(const Case& c, const Body& body);

  bool holds(const Vec<D>& x) const;
  bool touches(const Vec<D>& min, const Vec<D>& max) const;
  /// Whether the body holds a place and all around it up to so far along the axes, and has particles there: behind
  /// a shell it has none.
  bool fillsAround(const Vec<D>& x, double distance) const;

 private:
  bool fills(const Vec<D>& x) const { return holds(x) && (!solid_ || solid_->filled(x).within); }

  Shape shape_;
  Similarity<D> similarity_;
  std::unique_ptr<const Solid<D>> solid_;  // of a polygon or mesh
  std::optional<Expression> where_;
  std::vector<BodyRegion> subtracted_;
  double slack_;  // [m]
  Vec<D> min_, max_;
};

/// The places that `subtract` takes from a body.
template <int D>
std::vector<BodyRegion<D>> subtractedRegions(const Case& c, const Body& body);

/// What `where` and `subtract` of a body leave of its shape. Not for several threads at once.
template <int D>
class BodyCondition {
 public:
  BodyCondition(const Case& c, const Body& body);

  /// A body without either of the two.
  static bool isEmpty(const Body& body) { return body.where.empty() && body.subtract.empty(); }

  /// Beside particles an expression may have no value; there is no body then.
  bool holds(const Vec<D>& x) const;
  /// Whether it may fail somewhere in a box.
  bool mayFail(const Vec<D>& min, const Vec<D>& max) const;

 private:
  std::optional<Expression> where_;
  std::vector<BodyRegion<D>> subtracted_;
};

extern template class BodyRegion<2>;
extern template class BodyRegion<3>;
extern template class BodyCondition<2>;
extern template class BodyCondition<3>;

}  // namespace treacle
