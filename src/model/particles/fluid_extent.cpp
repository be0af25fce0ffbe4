#include "fluid_extent.hpp"

#include "body_points.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace treacle {
namespace {

/// Largest speed of a fluid body at the start, of a wall at any time [m/s].
template <int D>
double largestSpeed(const Case& c, const Body& body) {
  const Oscillation& o = body.oscillation;
  const double carried =
      norm(body.velocity) + (o.period > 0 ? 2 * std::numbers::pi * norm(o.amplitude) / o.period : 0);
  const bool expressions = body.velocityExpression != decltype(body.velocityExpression){};
  if (!expressions && !body.fileVelocities && !body.rotation) return carried;
  const InitialState<D> initial(c, body);
  const WallMotion<D> wall = wallMotion<D>(c.domain, body, 0, 0);
  std::vector<std::string> notes;
  double speed = 0;
  const BodyPoints<D> points = body.kind == BodyKind::Inflow ? nozzlePoints<D>(c, body, BodyKind::Wall, notes)
                                                             : bodyPoints<D>(c, body, notes);
  for (std::size_t k = 0; k < points.size(); ++k)
    speed = std::max(speed,
                     norm(body.rotation ? wall.swirl(wall.arm(points.place[k])) : initial.velocityAt(points, k)));
  return body.rotation ? carried + speed : speed;
}

}  // namespace

Heights heightsOf(const Case& c, const Extent& box) {
  Heights h;
  for (int k = 0; k < 8; ++k) {
    const Vec<3> corner{k & 1 ? box.max[0] : box.min[0], k & 2 ? box.max[1] : box.min[1],
                        k & 4 ? box.max[2] : box.min[2]};
    const double up = -dot(corner, c.gravity) / norm(c.gravity);
    h.low = std::min(h.low, up), h.high = std::max(h.high, up);
  }
  return h;
}

double fluidHeight(const Case& c) {
  if (norm(c.gravity) == 0) return 0;
  Heights all;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Heights h = heightsOf(c, boundingBox(body.shape, c.dimensions));
    all.low = std::min(all.low, h.low), all.high = std::max(all.high, h.high);
  }
  return all.extent();
}

double givenSpeed(const Case& c) {
  double speed = 0;
  for (const Body& body : c.bodies)
    speed = std::max(speed, c.dimensions == 2 ? largestSpeed<2>(c, body) : largestSpeed<3>(c, body));
  return speed;
}

}  // namespace treacle
