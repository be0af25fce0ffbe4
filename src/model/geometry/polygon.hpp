#pragma once

#include "facet_tree.hpp"
#include "treacle/model/case/body.hpp"

#include <optional>
#include <utility>

namespace treacle {

/// Twice the area that a polygon goes round, negative clockwise [m2].
double signedArea2(const std::vector<Vec<2>>& points);

/// Indices of two sides of a polygon that cut or touch each other, other than at the corner between them; of a
/// side without a length twice its own. A side is called by the corner that it begins at.
/// `closed`: of a polygon, whose last side leads back to the first point; else of a polyline.
std::optional<std::pair<std::size_t, std::size_t>> crossingSides(const std::vector<Vec<2>>& points,
                                                                 bool closed = true);

/// The boundary of a polygon, which must not cross itself, counter-clockwise; in space that of a prism.
template <int D>
std::vector<Facet<D>> polygonFacets(const Shape& polygon);

/// A polyline; in space the ribbon between its bottom and its top.
template <int D>
std::vector<Facet<D>> polylineFacets(const Shape& polyline);

}  // namespace treacle
