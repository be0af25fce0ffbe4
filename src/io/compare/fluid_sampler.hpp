#pragma once

#include "point_tree.hpp"
#include "treacle/io/frames/frame.hpp"

#include <utility>
#include <vector>

namespace treacle {

/// The fields of the fluid at a place; not a number where no fluid is, and those that the fluid does not have.
struct FluidSample {
  Vec<3> velocity{};       // [m/s]
  double pressure = 0;     // [Pa]
  double viscosity = 0;    // [Pa s]
  double shearRate = 0;    // [1/s]
  double temperature = 0;  // [K]
};

/// Fields between particles: a plane is fitted to those of the particles within probeReach, by least squares with
/// the weight of Wendland's C2 function, so that a linear field is met at the surface of the fluid, too.
class FluidSampler {
 public:
  /// `fluid`, `walls`: at least all within reach of the places that will be asked for. `spacing` [m].
  FluidSampler(const Frame& fluid, const Frame& walls, const Domain& domain, double spacing);

  FluidSample at(const Vec<3>& x) const;
  /// Which share of the space that walls leave around a place is fluid: 1 inside, 1/2 at a free surface [-].
  double fraction(const Vec<3>& x) const;
  /// How far along the way from one place to the other fluid comes: to the last place with a fraction of 1/2; 0
  /// where there is none [m].
  double extent(const Vec<3>& from, const Vec<3>& to) const;

 private:
  struct Neighbour {
    std::size_t index;
    Vec<3> way;     // to it, in spacings
    double weight;  // [-]
  };
  struct Points {
    PointSet set;
    PointTree tree;
    explicit Points(std::vector<Vec<3>> points) : set{std::move(points)}, tree(3, set) {}
  };
  std::vector<Neighbour> neighbours(const Points& points, const Vec<3>& x) const;
  double filled(const Points& points, const Vec<3>& x) const;

  const Frame& fluid_;
  int dimensions_;
  double spacing_;
  std::vector<Vec<3>> shifts_;
  Points fluidPoints_, wallPoints_;
};

}  // namespace treacle
