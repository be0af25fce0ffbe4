#include "nozzle_region.hpp"

#include "geometry/all_around.hpp"
#include "geometry/polygon.hpp"
#include "geometry/wall_turn.hpp"
#include "motion/nozzle_lattice.hpp"
#include "treacle/model/motion/nozzle.hpp"

#include <cmath>

namespace treacle {

template <int D>
NozzleRegion<D>::NozzleRegion(const Case& c, const Body& body)
    : nozzle_(body.inflow.nozzle), slack_(1e-6 * c.spacing) {
  const NozzleLayers<D> layers(c, body);
  depth_ = layers.depth() * c.spacing;
  direction_ = layers.direction(0);
  const Vec<D> given = resized<D>(nozzle_.direction);
  axes_ = axesAcross<D>(nozzle_, given * (1 / norm(given)));
  center_ = resized<D>(nozzle_.center + wallDisplacement(body, 0));
  if (body.rotation) {
    const WallMotion<D> turn = wallTurn<D>(body, 0);
    for (Vec<D>& axis : axes_) axis = turn.turned(axis);
    center_ = resized<D>(wallCenter(body, 0)) + turn.turned(resized<D>(nozzle_.center - body.rotation->center));
  }
  if (nozzle_.kind != NozzleKind::Polygon) return;
  Shape outline;
  outline.points = nozzle_.points;
  polygon_ = std::make_unique<const FacetTree<2>>(polygonFacets<2>(outline));
}

template <int D>
bool NozzleRegion<D>::holds(const Vec<D>& x) const {
  const Vec<D> way = x - center_;
  if (const double along = dot(way, direction_); along > slack_ || along < -depth_ - slack_) return false;
  Vec<D - 1> across;
  for (int k = 0; k < D - 1; ++k) across[k] = dot(way, axes_[static_cast<std::size_t>(k)]);
  if (nozzle_.kind == NozzleKind::Disc) {
    const double r = norm(across);
    return r <= nozzle_.radius + slack_ && (nozzle_.innerRadius == 0 || r > nozzle_.innerRadius - slack_);
  }
  if constexpr (D == 3) {
    if (polygon_) return polygon_->winding(across) > 0.5;
    if (std::abs(across[1]) > nozzle_.height / 2 + slack_) return false;
  }
  return std::abs(across[0]) <= nozzle_.width / 2 + slack_;
}

template <int D>
bool NozzleRegion<D>::fillsAround(const Vec<D>& x, double distance) const {
  return allAround(x, distance, [this](const Vec<D>& at) { return holds(at); });
}

template class NozzleRegion<2>;
template class NozzleRegion<3>;

}  // namespace treacle
