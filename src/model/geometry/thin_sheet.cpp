#include "thin_sheet.hpp"

#include "facet_joint.hpp"
#include "solid.hpp"
#include "thin_solid.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/geometry/thickness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

template <int D>
double distanceTo(const FacetJoint<D>& joint, const Vec<D>& x) {
  if constexpr (D == 2) return norm(x - joint[0]);
  if constexpr (D == 3) {
    const Vec<3> along = joint[1] - joint[0];
    const double share = std::clamp(dot(x - joint[0], along) / norm2(along), 0.0, 1.0);
    return norm(x - joint[0] - along * share);
  }
}

}  // namespace

template <int D>
ThinSheet<D>::ThinSheet(const Case& c, const Body& body)
    : similarity_(similarityOf<D>(body.shape)),
      tree_(facetsOf<D>(body.shape)),
      sign_(body.shape.flip ? -1 : 1),
      reach_(c.interactionRadius() / similarity_.scale()),
      slack_(1e-6 * c.spacing / similarity_.scale()) {
  const Extent box = boundingBox(body.shape, D);
  const Vec<D> margin = Vec<D>::filled(c.interactionRadius() + c.spacing);
  min_ = resized<D>(box.min) - margin, max_ = resized<D>(box.max) + margin;
  takeMiddle(body.name);
  findEnds(body.name);
}

template <int D>
void ThinSheet<D>::takeMiddle(const std::string& name) {
  const auto refuse = [&](std::string_view problem, std::string_view part, const Vec<D>& place) {
    throw InputError(
        fmt::format("thin sheet '{}' is a thin solid that {} at {}; expected two sides, less than {} apart "
                    "everywhere: make {} a body of its own",
                    name, problem, positionText(resized<3>(similarity_.point(place)), D),
                    lengthText(reach_ * similarity_.scale()), part));
  };
  if (auto middle = middleOfThinSolid<D>(*tree_, reach_, refuse)) tree_ = std::move(middle), isMiddle_ = true;
}

template <int D>
void ThinSheet<D>::findEnds(const std::string& name) {
  struct Meeting {
    int facets = 0, forward = 0;
  };
  std::map<FacetJoint<D>, Meeting, JointOrder<D>> joints;
  const auto forEachJoint = [&](auto&& f) {
    for (std::uint32_t facet = 0; facet < tree_->size(); ++facet)
      for (std::size_t k = 0; k < D; ++k) {
        const auto [joint, forward] = jointOf<D>(tree_->facet(facet), k);
        f(facet, k, joints[joint], joint, forward);
      }
  };
  forEachJoint([](std::uint32_t, std::size_t, Meeting& meeting, const FacetJoint<D>&, bool forward) {
    ++meeting.facets, meeting.forward += forward;
  });
  for (const auto& [joint, meeting] : joints) {
    if (meeting.facets < 2 || (meeting.facets == 2 && meeting.forward == 1)) continue;
    const std::string place = positionText(resized<3>(similarity_.point(joint[0])), D);
    if (meeting.facets > 2)
      throw InputError(
          fmt::format("thin sheet '{}': {} of its faces meet at {}; expected at most two, and a body "
                      "of its own for what branches off",
                      name, meeting.facets, place));
    throw InputError(
        fmt::format("thin sheet '{}': two faces that meet at {} do not agree on which side is the "
                    "front; turn one of them in the program that made the file",
                    name, place));
  }
  ends_.assign(tree_->size(), 0);
  std::set<Vec<D>, PointOrder<D>> corners;
  forEachJoint([&](std::uint32_t facet, std::size_t k, const Meeting& meeting, const FacetJoint<D>& joint, bool) {
    if (meeting.facets != 1) return;
    ends_[facet] |= static_cast<std::uint8_t>(1u << k);
    corners.insert(joint.begin(), joint.end());
  });
  for (std::uint32_t facet = 0; facet < tree_->size(); ++facet)
    for (std::size_t k = 0; k < D; ++k)
      if (corners.contains(tree_->facet(facet)[k])) ends_[facet] |= static_cast<std::uint8_t>(8u << k);
}

template <int D>
bool ThinSheet<D>::isAtEnd(std::uint32_t facet, const Vec<D>& point) const {
  for (std::size_t k = 0; k < D; ++k) {
    if (ends_[facet] & 8u << k && norm(point - tree_->facet(facet)[k]) <= slack_) return true;
    if (ends_[facet] & 1u << k && distanceTo<D>(jointOf<D>(tree_->facet(facet), k).first, point) <= slack_)
      return true;
  }
  return false;
}

template <int D>
typename ThinSheet<D>::Place ThinSheet<D>::at(const Vec<D>& x, double reach) const {
  const Vec<D> local = similarity_.pointBefore(x);
  const double limit = reach / similarity_.scale() + slack_;
  const auto nearest = tree_->nearest(local, 2 * limit);
  Place place;
  if (nearest.facet == tree_->none || nearest.distance > limit) {
    const double distance = std::min(nearest.distance, 2 * limit);
    place.distance = (distance - limit) * similarity_.scale();
    return place;
  }
  if (isAtEnd(nearest.facet, nearest.point)) return place;
  // At a corner or edge several facets are as near. That one counts which the point is farthest above or below.
  double height = 0;
  Vec<D> normal{};
  tree_->near(local, nearest.distance + slack_, {}, [&](const auto& near) {
    const Vec<D> n = facetNormal<D>(tree_->facet(near.facet)), unit = n * (sign_ / norm(n));
    const double above = dot(local - near.point, unit);
    if (norm2(normal) == 0 || std::abs(above) > std::abs(height)) height = above, normal = unit;
  });
  place.side = height >= 0 ? sides::Front : sides::Back;
  place.distance = nearest.distance * similarity_.scale();
  place.way = similarity_.direction(nearest.point - local) * similarity_.scale();
  place.normal = nearest.distance > 10 * slack_ ? place.way * (1 / place.distance)
                                                : similarity_.direction(normal) * (height >= 0 ? -1.0 : 1.0);
  return place;
}

template <int D>
typename ThinSheet<D>::Answer ThinSheet<D>::filled(const Vec<D>& x) const {
  const Place place = at(x, reach_ * similarity_.scale());
  return {place.side != sides::None, place.side == sides::None ? place.distance : 0};
}

bool isMiddleOfSolid(const Case& c, const Body& body) {
  return c.dimensions == 2 ? ThinSheet<2>(c, body).isMiddle() : ThinSheet<3>(c, body).isMiddle();
}

template class ThinSheet<2>;
template class ThinSheet<3>;

}  // namespace treacle
