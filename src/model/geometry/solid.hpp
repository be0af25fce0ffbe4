#pragma once

#include "facet_tree.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace treacle {

/// The boundary of a polygon or mesh, or a polyline, before its transform.
template <int D>
std::shared_ptr<const FacetTree<D>> facetsOf(const Shape& shape);

/// A polygon or mesh, where it stands in the case: which points belong to it, and how far its surface is.
template <int D>
class Solid {
 public:
  /// `needed`: the thickness where the shape says none; `spacing` [m].
  Solid(const Shape& shape, double needed, double spacing);

  /// Around what it fills [m].
  const Vec<D>& min() const { return min_; }
  const Vec<D>& max() const { return max_; }

  /// Whether there are particles at a point, and up to which distance from it nothing changes that [m].
  struct Answer {
    bool within;
    double sure;
  };
  Answer filled(const Vec<D>& x) const;

  /// Whether a point belongs to the solid of which surfaces are the boundary: behind a shell all of the inside
  /// does.
  bool contains(const Vec<D>& x) const;

  /// Faces of that solid: one, or two where a layer ends on the outside, too. Height of a point above one of them,
  /// negative inside [m], and the outward normal there.
  struct At {
    double height;
    Vec<D> normal;
  };
  int faceCount() const { return fill_ == FillKind::Outside ? 2 : 1; }
  At at(int face, const Vec<D>& x) const;

  /// Ways from a point of the solid to its surface, to those points that are nearer than the points around them:
  /// the nearest, and others within reach, of which `all` says whether those less than 60 degrees from it are
  /// wanted.
  struct Way {
    Vec<D> out;       // unit vector, outward
    double distance;  // [m]
    bool clear;       // all on the way is of the solid
  };
  void ways(const Vec<D>& x, double reach, bool all, std::vector<Way>& found) const;

 private:
  using Near = typename FacetTree<D>::Near;

  /// Whether the surface goes round a point, and between what limits its distance is. Asked again nearby it
  /// answers from memory, which each thread has.
  struct Surroundings {
    bool within;
    double least, most;
  };
  Surroundings around(const Vec<D>& local) const;
  bool inside(const Vec<D>& local) const { return around(local).within; }
  /// The winding number of the surface around a point at that distance from it [m].
  double windingAt(const Vec<D>& local, double distance) const;
  /// How far from a point at distance d of the surface, with the winding number w, nothing changes.
  double sureDistance(double d, double w) const;
  Vec<D> direction(const Vec<D>& local, const Near& near) const;
  void otherWays(const Vec<D>& local, double reach, const Vec<D>& first, bool all, std::vector<Way>& found) const;

  Similarity<D> similarity_;
  std::shared_ptr<const FacetTree<D>> tree_;  // before the transform; so are lengths here
  FillKind fill_;
  bool closed_;
  double sign_ = 1;  // -1: inside-out
  double thickness_, slack_, spacing_;
  Vec<D> min_, max_;
  std::uint64_t number_;  // of this solid, among all that there were
};

extern template class Solid<2>;
extern template class Solid<3>;

/// Whether a shape is one that Solid is for.
inline bool isSolid(const Shape& s) {
  return (s.kind == ShapeKind::Polygon || s.kind == ShapeKind::Mesh) && !s.isThinSheet();
}

}  // namespace treacle
