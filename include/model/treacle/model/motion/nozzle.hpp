#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/nozzle_columns.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// The layers of particles that an inflow of a case consists of: each has the same places on a square lattice
/// across its direction, and the next one stands a spacing behind it. The particles at one place are a column.
/// Where the speed is not the same everywhere, each column goes by itself.
template <int D>
class NozzleLayers {
 public:
  /// Errors: InputError where no particle has room in the opening, and of nozzleProfile().
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
  /// Speeds of the columns over their mean; a single 1 where all columns have the same.
  std::span<const double> profile() const { return profile_; }
  bool isPlug() const { return profile_.size() == 1; }

  /// Places of the layer that is `way` in front of the opening [m], where the nozzle is at time t [s].
  std::vector<Vec<D>> layer(double way, double t) const { return layer(std::span(&way, 1), t); }
  /// Likewise with one way for each column, or for all.
  std::vector<Vec<D>> layer(std::span<const double> ways, double t) const;
  /// With which the fluid leaves the nozzle: the mean over the opening and over the step of dt from t on, or that
  /// at t where dt is 0 [m/s]. Errors: InputError for a formula without a value.
  double speed(double t, double dt) const;
  /// That of the layers with this speed in the step of dt from t on, by which they get to where layer() has them.
  WallMotion<D> motion(const Domain& domain, double t, double dt) const;
  /// The same about where the nozzle is when that step has ended: its velocityAt is that of fluid that leaves
  /// then.
  WallMotion<D> motionAtEnd(const Domain& domain, double t, double dt) const;
  /// How much faster than this speed each column is, as a share of it; a single 0 where all have it.
  std::vector<double> excess() const;

  /// The lattice of the columns at time t; its vectors are still missing.
  NozzleColumns<D> columns(const Domain& domain, double t) const;
  /// Those vectors: multiples of one, each for a column, or a single one for all.
  std::vector<Vec<D>> eachOf(std::span<const double> multiples, const Vec<D>& of) const;

 private:
  const Body body_;
  double spacing_;
  int depth_;
  Vec<D> direction_;            // at the start
  std::vector<Vec<D>> across_;  // from the centre, at the start [m]
  std::vector<double> profile_;
  NozzleColumns<D> lattice_;  // at the start, from the centre
  double area_, openingArea_;
};

/// What a user should know about a nozzle: how its cross-section differs from the one that was asked for.
template <int D>
void describeNozzle(const Body& body, const NozzleLayers<D>& layers, std::vector<std::string>& notes);

extern template class NozzleLayers<2>;
extern template class NozzleLayers<3>;

}  // namespace treacle
