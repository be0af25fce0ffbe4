#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/expression.hpp"
#include "treacle/model/wall_motion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// The points of a body (lattice.hpp, given_points.hpp) at which its condition `where` holds; a note says where
/// there is none. Errors: InputError for too many points, for the first one outside the domain, or where the
/// condition is no number.
template <int D>
std::vector<Vec<D>> bodyPoints(const Case& c, const Body& body, std::vector<std::string>& notes);

/// Of an inflow, as it starts: the layers behind its opening, which count as wall, and the layer in front of it,
/// fluid, if it flows from the start. Errors: InputError for a nozzle without particles, for the first one outside
/// the domain.
template <int D>
std::vector<Vec<D>> nozzlePoints(const Case& c, const Body& body, BodyKind kind, std::vector<std::string>& notes);

/// What the particles of a body start with.
template <int D>
class InitialState {
 public:
  InitialState(const Case& c, const Body& body);

  /// At x [m/s]. Errors: InputError where it is not finite.
  Vec<D> velocityAt(const Vec<D>& x) const;
  /// At x, of a fluid in a case with heat [K]. Errors: InputError where it is not a positive number.
  double temperatureAt(const Vec<D>& x) const;

 private:
  const Body& body_;
  WallMotion<D> wall_;
  std::vector<std::optional<Expression>> expressions_;  // of the components
  std::optional<Expression> temperature_;
};

}  // namespace treacle
