#pragma once

#include "facet_tree.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/side.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace treacle {

/// The surface of a body that is a thin sheet, as it stands at the start; of a thin solid the surface in its
/// middle. The front is the side that its normals point to. Beside an edge of it, farther than the edge goes, a
/// point is on neither side.
template <int D>
class ThinSheet {
 public:
  /// Errors: InputError for faces that disagree on their sides, for more than two that meet in an edge, and for a
  /// thin solid that branches or is thicker elsewhere.
  ThinSheet(const Case& c, const Body& body);

  bool isMiddle() const { return isMiddle_; }
  /// Around the sheet and all that its particles may fill [m].
  const Vec<D>& min() const { return min_; }
  const Vec<D>& max() const { return max_; }

  struct Place {
    sides::Side side = sides::None;
    double distance = 0;  // from the sheet; on neither side that up to which there is certainly no sheet [m]
    Vec<D> way{};         // to the nearest point of it [m]
    Vec<D> normal{};      // there, unit vector from this place through the sheet
  };
  /// Points farther than `reach` [m] are on neither side.
  Place at(const Vec<D>& x, double reach) const;

  /// Whether there are particles at a point, and up to which distance from it nothing changes that [m].
  struct Answer {
    bool within;
    double sure;
  };
  Answer filled(const Vec<D>& x) const;

 private:
  void takeMiddle(const std::string& name);
  void findEnds(const std::string& name);
  bool isAtEnd(std::uint32_t facet, const Vec<D>& point) const;

  Similarity<D> similarity_;
  std::shared_ptr<const FacetTree<D>> tree_;  // before the transform; so are lengths here
  double sign_, reach_, slack_;
  bool isMiddle_ = false;
  std::vector<std::uint8_t> ends_;  // per facet: 1 << k where side k ends the sheet, 8 << k where corner k does
  Vec<D> min_, max_;
};

extern template class ThinSheet<2>;
extern template class ThinSheet<3>;

}  // namespace treacle
