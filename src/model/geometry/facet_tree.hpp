#pragma once

#include "treacle/core/vec.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace treacle {

/// A straight piece of a boundary: in the plane a segment, from whose first end the inside is on the left; in
/// space a triangle whose corners go round counter-clockwise seen from outside.
template <int D>
using Facet = std::array<Vec<D>, D>;

/// Outward, as long as the facet is long or, in space, large.
template <int D>
Vec<D> facetNormal(const Facet<D>& facet);

/// The point of a facet that is nearest to x.
template <int D>
Vec<D> nearestOn(const Facet<D>& facet, const Vec<D>& x);

/// Cosine and sine, times a common length, of an angle that is to pi as the directions from x that a facet covers
/// are to half of all directions; negative seen from outside. In space [Van Oosterom, Strackee 1983].
template <int D>
Vec<2> coveredAngle(const Facet<D>& facet, const Vec<D>& x);

template <>
Vec<2> facetNormal<2>(const Facet<2>& facet);
template <>
Vec<3> facetNormal<3>(const Facet<3>& facet);
template <>
Vec<2> nearestOn<2>(const Facet<2>& facet, const Vec<2>& x);
template <>
Vec<3> nearestOn<3>(const Facet<3>& facet, const Vec<3>& x);
template <>
Vec<2> coveredAngle<2>(const Facet<2>& facet, const Vec<2>& x);
template <>
Vec<2> coveredAngle<3>(const Facet<3>& facet, const Vec<3>& x);

/// Facets in a tree of boxes, with the questions how often they go round a point and which of them is near it.
/// Nothing is asked of how they hang together.
template <int D>
class FacetTree {
 public:
  static constexpr std::uint32_t none = ~0u;

  /// Facets must have a length or area.
  explicit FacetTree(const std::vector<Facet<D>>& facets);

  std::size_t size() const { return facets_.size(); }
  const Facet<D>& facet(std::size_t k) const { return facets_[k]; }
  std::uint32_t original(std::size_t k) const { return original_[k]; }  // its index among those given
  const Vec<D>& min() const { return nodes_.front().min; }
  const Vec<D>& max() const { return nodes_.front().max; }

  /// The winding number: 1 inside of a closed boundary, 0 outside, something between where holes are, by the share
  /// of the directions that the facets cover [Jacobson et al. 2013]. Far ones count together, by their flux
  /// [Barill et al. 2018], so that it is right to about 0.01 and, near the boundary, to far less.
  double winding(const Vec<D>& x) const;

  struct Near {
    double distance = std::numeric_limits<double>::infinity();
    Vec<D> point{};
    std::uint32_t facet = none;
  };
  /// The nearest facet; none if it is not nearer than `limit`.
  Near nearest(const Vec<D>& x, double limit = std::numeric_limits<double>::infinity()) const;

  /// Calls f for each facet within reach. `beside`: a unit vector, or zero: facets with normals within 60 degrees
  /// of it may be passed over.
  void near(const Vec<D>& x, double reach, const Vec<D>& beside, const std::function<void(const Near&)>& f) const;

  /// Calls f with the index of each facet whose box touches that from min to max.
  void touching(const Vec<D>& min, const Vec<D>& max, const std::function<void(std::uint32_t)>& f) const;

 private:
  struct Node {
    Vec<D> min, max;
    Vec<D> center;  // of the facets, by size
    double radius;  // around it, of all
    Vec<D> flux;    // sum of their normals
    double size;    // sum of the lengths of these
    Vec<D> axis;    // of the cone that has all normals in it; zero: there is none
    double spread;  // its half angle [rad]
    std::uint32_t begin, end;
    std::uint32_t right;  // second child, the first one is the next node; 0: a leaf
  };
  static constexpr std::uint32_t leafSize = 4;

  struct Building;
  std::uint32_t build(Building& b, std::uint32_t begin, std::uint32_t end);
  Node leaf(std::uint32_t begin, std::uint32_t end) const;
  static Node joined(const Node& a, const Node& b);
  static void finish(Node& node);
  static double distance2(const Node& node, const Vec<D>& x);
  template <class Enter, class Visit>
  void walk(Enter&& enter, Visit&& visit) const;

  std::vector<Facet<D>> facets_;
  std::vector<std::uint32_t> original_;
  std::vector<Node> nodes_;
};

extern template class FacetTree<2>;
extern template class FacetTree<3>;

}  // namespace treacle
