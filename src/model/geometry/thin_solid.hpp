#pragma once

#include "facet_tree.hpp"

#include <functional>
#include <memory>
#include <string_view>

namespace treacle {

/// Throws: a thin solid is too thick or branches, and which part of it is to be a body of its own; the place of
/// it.
template <int D>
using RefuseThinSolid = std::function<void(std::string_view problem, std::string_view part, const Vec<D>& place)>;

/// The surface halfway between the two sides of a thin solid, such as a cup of a CAD program, without the rim
/// where they meet. Null where less than half of the surface is thinner than `thickest` [the facets' unit], and
/// where it is not closed.
template <int D>
std::shared_ptr<const FacetTree<D>> middleOfThinSolid(const FacetTree<D>& boundary, double thickest,
                                                      const RefuseThinSolid<D>& refuse);

}  // namespace treacle
