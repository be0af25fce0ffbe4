#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace treacle {

/// The layers of particles that an inflow of a case consists of: each has the same places on a square lattice
/// across its direction, and the next one stands a spacing behind it.
template <int D>
class NozzleLayers {
 public:
  /// Errors: InputError where no particle has room in the opening.
  NozzleLayers(const Case& c, const Body& body);

  /// Particles of one layer.
  std::size_t size() const { return across_.size(); }
  /// How many layers stand behind the opening: as deep as particles act on each other.
  int depth() const { return depth_; }
  /// That fluid leaves in where the nozzle is turned to at time t [s]; of length 1.
  Vec<D> direction(double t) const;
  /// Cross-section of the particles, and of the opening as it was asked for [m2; m in 2D].
  double area() const { return area_; }
  double openingArea() const { return openingArea_; }

  /// Places of the layer that is `way` in front of the opening [m], where the nozzle is at time t [s].
  std::vector<Vec<D>> layer(double way, double t) const;
  /// With which the fluid leaves the nozzle: the mean over the step of dt from t on, or that at t where dt is 0
  /// [m/s]. Errors: InputError for a formula without a value.
  double speed(double t, double dt) const;
  /// That of the layers in the step of dt from t on, by which they get to where layer() has them.
  WallMotion<D> motion(const Domain& domain, double t, double dt) const;
  /// The same about where the nozzle is when that step has ended: its velocityAt is that of fluid that leaves
  /// then.
  WallMotion<D> motionAtEnd(const Domain& domain, double t, double dt) const;

 private:
  const Body body_;
  double spacing_;
  int depth_;
  Vec<D> direction_;            // at the start
  std::vector<Vec<D>> across_;  // from the centre, at the start [m]
  double area_, openingArea_;
};

/// What a user should know about a nozzle: how its cross-section differs from the one that was asked for.
template <int D>
void describeNozzle(const Body& body, const NozzleLayers<D>& layers, std::vector<std::string>& notes);

extern template class NozzleLayers<2>;
extern template class NozzleLayers<3>;

}  // namespace treacle
