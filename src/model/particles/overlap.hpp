#pragma once

#include "geometry/body_region.hpp"
#include "nozzle_region.hpp"
#include "treacle/model/case/case.hpp"

#include <memory>
#include <vector>

namespace treacle {

/// Which particles of different bodies stand in each other's places. Particles that are closer to each other than
/// half a spacing do. Those of lattices that are shifted against each other are farther apart: there a particle
/// is among those of another body if it is well inside its shape. Not for several threads at once.
template <int D>
class Overlap {
 public:
  explicit Overlap(const Case& c);

  /// Half a spacing [m]. Particles exactly that far apart, give or take rounding, are not too close.
  double radius() const { return radius_; }
  /// From a place inside a lattice to its nearest point at most [m].
  double reach() const { return reach_; }

  bool areClose(const Vec<D>& a, const Vec<D>& b) const { return norm2(a - b) < radius_ * radius_; }
  /// Whether a place is a clear part of a spacing inside what a body fills. Inflows and particles of a file have
  /// no shape.
  bool isInside(const Body& body, const Vec<D>& x) const;
  /// Whether a particle of a solid is in the place of one of an earlier solid within reach of it. Walls may stand
  /// in each other, bodies that move may not: a rigid body is as its shape, a nozzle needs all of its room. `at`
  /// and `earlierAt` are as they see each other across periodic ends.
  bool isTaken(const Body& solid, const Vec<D>& at, const Body& earlier, const Vec<D>& earlierAt) const;
  /// Whether a particle of fluid and one of a wall, within reach of each other, share a place: one of them is
  /// inside the body of the other. `fluidAt`: where the former is as the wall sees it across periodic ends,
  /// `wallAt` likewise. Where a body subtracts the other one it has left it the room.
  bool sharePlace(const Body& fluid, const Vec<D>& fluidAt, const Body& wall, const Vec<D>& wallAt) const;

 private:
  bool isInNozzle(const Body& body, const Vec<D>& x) const;

  const Case& case_;
  double radius_, reach_, depth_;
  mutable std::vector<std::unique_ptr<const BodyRegion<D>>> regions_;    // of bodies, as they are needed
  mutable std::vector<std::unique_ptr<const NozzleRegion<D>>> nozzles_;  // likewise
};

extern template class Overlap<2>;
extern template class Overlap<3>;

}  // namespace treacle
