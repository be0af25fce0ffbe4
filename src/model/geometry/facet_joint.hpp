#pragma once

#include "facet_tree.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace treacle {

/// What two facets meet in: a corner in the plane or an edge in space, by its ends in the order of their
/// coordinates.
template <int D>
using FacetJoint = std::array<Vec<D>, D - 1>;

template <int D>
struct PointOrder {
  bool operator()(const Vec<D>& a, const Vec<D>& b) const {
    return std::lexicographical_compare(a.v, a.v + D, b.v, b.v + D);
  }
};

template <int D>
struct JointOrder {
  bool operator()(const FacetJoint<D>& a, const FacetJoint<D>& b) const {
    return std::ranges::lexicographical_compare(a, b, PointOrder<D>{});
  }
};

/// Joint k of a facet, and whether the facet begins there or, in space, goes along it in this order.
template <int D>
std::pair<FacetJoint<D>, bool> jointOf(const Facet<D>& facet, std::size_t k) {
  if constexpr (D == 2) return {{facet[k]}, k == 0};
  if constexpr (D == 3) {
    const Vec<3>&a = facet[k], &b = facet[(k + 1) % 3];
    return PointOrder<3>{}(a, b) ? std::pair{FacetJoint<3>{a, b}, true} : std::pair{FacetJoint<3>{b, a}, false};
  }
}

}  // namespace treacle
