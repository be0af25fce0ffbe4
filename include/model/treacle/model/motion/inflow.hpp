#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/time_function.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

enum class NozzleKind { Disc, Rectangle, Polygon };

/// The opening that fluid comes out of. In two dimensions it is a segment across the direction, a rectangle its
/// width alone, a disc with a radius.
struct Nozzle {
  NozzleKind kind = NozzleKind::Disc;
  Vec<3> center{};                     // [m]
  Vec<3> direction{};                  // that fluid leaves in, of any length but zero
  double radius = 0, innerRadius = 0;  // disc, ring [m]
  double width = 0, height = 0;        // rectangle [m]
  Vec<3> up{};                         // along the height, as far as it is across the direction; zero: any
  // Of a polygon, from the centre: along the width, which is direction x up, and along up [m].
  std::vector<Vec<2>> points{};

  bool operator==(const Nozzle&) const = default;
};

inline constexpr std::string_view plugProfile = "plug", parabolicProfile = "parabolic";

/// How fluid comes into a case (docs/inflow.md). Behind the opening stand some layers of particles that go with
/// the given speed, as a wall does. Whenever a column of particles has gone a spacing, its first one becomes
/// fluid, and another one follows at the end.
struct Inflow {
  Nozzle nozzle;
  // One of them: of the fluid relative to the nozzle [m/s]; through all of it [m3/s; m2/s in 2D].
  std::optional<TimeFunction> speed{}, flowRate{};
  // Of the speed over the opening: one of the words above, or an expression of the place at the start, of which
  // the ratios count.
  std::string profile{plugProfile};
  double start = 0, end = 0;  // when it flows [s]; end 0: it does not end

  bool operator==(const Inflow&) const = default;
};

/// Where fluid leaves a case: particles in it are taken out. A case has at most so many such places.
inline constexpr std::size_t maxOutflows = 64;
enum class OutflowKind { Box, Plane };
struct Outflow {
  std::string name;
  OutflowKind kind = OutflowKind::Box;
  Vec<3> min{}, max{};       // of a box [m]
  Vec<3> point{}, normal{};  // of a plane [m]; what is beyond it, in the direction of the normal, has left

  bool operator==(const Outflow&) const = default;
};

/// A face through which fluid goes either way, by a pressure (docs/inflow.md). Behind it, against its direction,
/// is a reserve of fluid. A case has at most so many.
inline constexpr std::size_t maxOpenings = 32;
struct Opening {
  std::string name;
  int material = 0;                        // index into Case::materials; of fluid that comes in
  Nozzle face;                             // a disc or a rectangle, whose direction leads into the case
  std::optional<TimeFunction> pressure{};  // at its centre, above that of the air; missing: 0 [Pa]
  // In its place, into the case through all of the face [m3/s; m2/s in 2D]: the pressure is then what that takes.
  std::optional<TimeFunction> flowRate{};
  double temperature = 0;      // of fluid that comes in, in cases with heat [K]
  double viscosityFactor = 0;  // likewise, by which its viscosity is multiplied; 0: 1

  bool operator==(const Opening&) const = default;
};

}  // namespace treacle
