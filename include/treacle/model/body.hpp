#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/inflow.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace treacle {

/// Largest number of bodies: particles keep theirs in one byte, of which one value says that it is not known.
inline constexpr std::size_t maxBodies = 255;

enum class ShapeKind { Box, Sphere, Cylinder };

/// A region of space. In two dimensions a sphere is a disc and a cylinder a strip along its axis.
struct Shape {
  ShapeKind kind = ShapeKind::Box;
  Vec<3> min{}, max{};     // box corners [m]
  Vec<3> center{};         // sphere [m]
  Vec<3> start{}, end{};   // cylinder: ends of the axis [m]
  double radius = 0;       // sphere, cylinder [m]
  double innerRadius = 0;  // sphere, cylinder: hollow inside [m]

  bool operator==(const Shape&) const = default;
};

/// An inflow is both: the fluid that comes out of it, and what drives that (Inflow), which counts as wall. A rigid
/// body is a wall that the fluid and gravity move.
enum class BodyKind { Fluid, Wall, Inflow, Rigid };

/// Displacement of a wall from where it starts: amplitude (sin(2 pi t / period + phase) - sin(phase)).
struct Oscillation {
  Vec<3> amplitude{};  // [m]
  double period = 0;   // [s]; 0: none
  double phase = 0;    // [rad]

  bool operator==(const Oscillation&) const = default;
};

/// Rotation of a wall, counter-clockwise seen from the end of its axis. The centre goes along with the wall's
/// translation and oscillation.
struct Rotation {
  Vec<3> center{};       // at the start [m]
  Vec<3> axis{0, 0, 1};  // of any length but zero; in two dimensions this one
  double speed = 0;      // [rad/s]

  Vec<3> direction() const { return axis * (1 / norm(axis)); }

  bool operator==(const Rotation&) const = default;
};

/// What a rigid body has beside its particles.
struct RigidSettings {
  double mass = 0;           // [kg; per metre of depth in 2D]; 0: that of its material's density
  Vec<3> angularVelocity{};  // at the start [rad/s]
  std::array<bool, 3> translates{true, true, true};  // along these axes
  std::array<bool, 3> rotates{true, true, true};     // about them; in two dimensions about z

  bool operator==(const RigidSettings&) const = default;
};

/// Particles of one kind and material that fill a shape, or come out of a nozzle. Expressions are those of
/// model/expression.hpp; an empty one is none.
struct Body {
  std::string name;
  BodyKind kind = BodyKind::Fluid;
  int material = 0;   // index into Case::materials
  Vec<3> velocity{};  // fluid: at the start; wall: prescribed translation [m/s]
  Shape shape;
  Oscillation oscillation{};                        // of a wall, on top of its velocity
  std::optional<Rotation> rotation{};               // of a wall, on top of both
  std::array<std::string, 3> velocityExpression{};  // of a fluid, in place of a component of its velocity [m/s]
  std::string where{};                              // there are particles only where it is not zero
  // In cases with heat. Of a fluid that at the start; of a wall that of its surface or, where it has a
  // conductance, of what is behind it; 0: the wall is adiabatic [K].
  double temperature = 0;
  std::string temperatureExpression{};  // of a fluid, in place of its temperature [K]
  double wallConductance = 0;           // of a wall, its conductivity over its thickness [W/(m2 K)]; 0: infinite
  Inflow inflow{};                      // of an inflow, in place of a shape
  RigidSettings rigid{};                // of a rigid body

  bool holdsFluid() const { return kind == BodyKind::Fluid || kind == BodyKind::Inflow; }
  /// Whether fluid meets its surface.
  bool isWall() const { return kind == BodyKind::Wall || kind == BodyKind::Rigid; }

  bool operator==(const Body&) const = default;
};

}  // namespace treacle
