#pragma once

#include "geometry/facet_tree.hpp"
#include "treacle/model/case/case.hpp"

#include <array>
#include <memory>

namespace treacle {

/// The room behind the opening of an inflow at the start, as deep as its layers are.
template <int D>
class NozzleRegion {
 public:
  NozzleRegion(const Case& c, const Body& body);

  bool holds(const Vec<D>& x) const;
  /// Whether it holds a place and all around it up to so far along the axes.
  bool fillsAround(const Vec<D>& x, double distance) const;

 private:
  const Nozzle& nozzle_;
  double depth_, slack_;  // [m]
  Vec<D> center_, direction_;
  std::array<Vec<D>, D - 1> axes_;  // across
  std::unique_ptr<const FacetTree<2>> polygon_;
};

extern template class NozzleRegion<2>;
extern template class NozzleRegion<3>;

}  // namespace treacle
