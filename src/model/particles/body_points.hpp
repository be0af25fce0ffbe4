#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/expression.hpp"
#include "treacle/model/geometry/transform.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// Where the particles of a body are to be [m].
template <int D>
struct BodyPoints {
  std::vector<Vec<D>> place;
  std::vector<std::uint32_t> given;  // which of its file's each of them is; empty: none

  std::size_t size() const { return place.size(); }
  /// Leaves those for which keep(k) holds, called in their order.
  template <class Keep>
  void filter(Keep&& keep) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (!keep(k)) continue;
      place[kept] = place[k];
      if (!given.empty()) given[kept] = given[k];
      ++kept;
    }
    place.resize(kept);
    if (!given.empty()) given.resize(kept);
  }
};

/// The points of a body (lattice.hpp, given_points.hpp) at which its condition `where` holds; a note says where
/// there is none. Errors: InputError for too many points, for the first one outside the domain, or where the
/// condition is no number.
template <int D>
BodyPoints<D> bodyPoints(const Case& c, const Body& body, std::vector<std::string>& notes);

/// The points of an inflow as it starts: the layers behind its opening, which count as wall, and, if it flows from
/// the start, the layer of fluid in front of it. Errors: InputError for a nozzle without particles, for the first
/// one outside the domain.
template <int D>
BodyPoints<D> nozzlePoints(const Case& c, const Body& body, BodyKind kind, std::vector<std::string>& notes);

/// What the particles of a body start with.
template <int D>
class InitialState {
 public:
  InitialState(const Case& c, const Body& body);

  /// Where particle `id` at point k stands [m].
  Vec<D> placeOf(const BodyPoints<D>& points, std::size_t k, std::uint32_t id) const;
  /// At point k [m/s]. Errors: InputError where it is not finite.
  Vec<D> velocityAt(const BodyPoints<D>& points, std::size_t k) const;
  /// Likewise, of a fluid in a case with heat [K]. Errors: InputError where it is not a positive number.
  double temperatureAt(const BodyPoints<D>& points, std::size_t k) const;
  /// The viscosity factor of a fluid at a place [-]. Errors likewise.
  double viscosityFactorAt(const Vec<D>& x) const;
  /// State k of a fluid at a place, in the order of Case::stateNames; 0 if its material does not have it. Errors:
  /// InputError where it is outside its bounds.
  double stateAt(std::size_t k, const Vec<D>& x) const;
  /// Whether values are those of expressions, which throw and are not for several threads at once.
  bool hasExpressions() const;

 private:
  const Body& body_;
  double disorder_;  // [m]
  WallMotion<D> wall_;
  std::vector<Vec<D>> excess_;  // of the columns of a nozzle, beside the velocity of its layers [m/s]
  std::vector<std::optional<Expression>> expressions_;  // of the components
  std::optional<Expression> temperature_, viscosityFactor_;
  struct StartingState {
    double value = 0, least = 0, most = 0;
    const StateStart* given = nullptr;
    std::optional<Expression> expression{};
  };
  std::vector<StartingState> states_;
  Similarity<D> similarity_;
};

}  // namespace treacle
