#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/geometry/shape_file.hpp"
#include "treacle/model/geometry/transform.hpp"
#include "treacle/model/materials/material_state.hpp"
#include "treacle/model/motion/inflow.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// Largest number of bodies: particles keep theirs in one byte, of which one value says that it is not known.
inline constexpr std::size_t maxBodies = 255;

enum class ShapeKind { Box, Sphere, Cylinder, Cone, Torus, Polygon, Polyline, Mesh, Particles };

/// Which side of its boundary a polygon or mesh stands for: all of the inside, the inside up to a distance from
/// the boundary (of a wall whose rest nobody sees), a layer on the outside, or a sheet, half on each side. A thin
/// sheet has no thickness: its particles are for the fluid on their other side alone (sides).
enum class FillKind { Inside, Shell, Outside, Sheet, ThinSheet };

/// A region of space. In two dimensions a sphere is a disc, a cylinder a strip along its axis, a cone a strip
/// whose width changes; a torus and a mesh have three. A polyline is a thin sheet. Particles stand where a file
/// says.
struct Shape {
  ShapeKind kind = ShapeKind::Box;
  Vec<3> min{}, max{};                              // box corners [m]
  Vec<3> center{};                                  // sphere, torus [m]
  Vec<3> start{}, end{};                            // cylinder, cone: ends of the axis [m]
  double radius = 0;                                // sphere, cylinder; torus: of its circle [m]
  double innerRadius = 0;                           // sphere, cylinder; torus: of its tube: hollow inside [m]
  double startRadius = 0, endRadius = 0;            // cone: at the ends of its axis [m]
  double innerStartRadius = 0, innerEndRadius = 0;  // cone: hollow inside [m]
  double tubeRadius = 0;                            // torus [m]
  Vec<3> axis{0, 0, 1};                             // torus: of any length but zero
  std::vector<Vec<2>> points{};                     // polygon: corners in order, either way round; polyline [m]
  double bottom = 0, top = 0;                       // of both in three dimensions: where they end along z [m]
  FillKind fill = FillKind::Inside;                 // polygon, mesh
  double thickness = 0;  // of what is not all of the inside; 0: as far as particles act on each other [m]
  ShapeFile file{};      // mesh, particles
  bool flip = false;     // mesh: the file has its inside and outside the wrong way round
  std::optional<Transform> transform{};

  bool isThinSheet() const { return kind == ShapeKind::Polyline || fill == FillKind::ThinSheet; }

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

/// Rotation of a wall or nozzle, counter-clockwise seen from the end of its axis. The centre goes along with the
/// translation, oscillation and displacement.
struct Rotation {
  Vec<3> center{};                      // at the start [m]
  Vec<3> axis{0, 0, 1};                 // of any length but zero; in two dimensions this one
  double speed = 0;                     // [rad/s]
  std::optional<TimeFunction> angle{};  // in place of the speed, how far it has turned since the start [rad]

  Vec<3> direction() const { return axis * (1 / norm(axis)); }

  bool operator==(const Rotation&) const = default;
};

inline constexpr int maxSprings = 64;  // of a body

/// A spring to a rigid body from a place at rest or from another one.
struct Spring {
  std::string name;
  std::string to{};      // the other body; empty: a place at rest
  Vec<3> anchor{};       // the place; on a body as the way from its centre of mass, at the start [m]
  Vec<3> arm{};          // from the body's centre of mass to where the spring holds it, at the start [m]
  double length = 0;     // without a load [m]
  double stiffness = 0;  // [N/m; N/m2 in 2D]
  double damping = 0;    // against its change of length [N s/m; N s/m2 in 2D]

  bool operator==(const Spring&) const = default;
};

/// An axis at rest that a rigid body can only turn about.
struct Hinge {
  Vec<3> point{};        // of the axis [m]
  Vec<3> axis{0, 0, 1};  // of any length but zero; in two dimensions this one

  Vec<3> direction() const { return axis * (1 / norm(axis)); }

  bool operator==(const Hinge&) const = default;
};

/// What a rigid body has beside its particles.
struct RigidSettings {
  double mass = 0;           // [kg; per metre of depth in 2D]; 0: that of its material's density
  Vec<3> angularVelocity{};  // at the start [rad/s]
  std::array<bool, 3> translates{true, true, true};  // along these axes
  std::array<bool, 3> rotates{true, true, true};     // about them; in two dimensions about z
  std::optional<Hinge> hinge{};                      // in place of both
  double release = 0;                                // when it is let go; it stands still until then [s]
  TimeVector force{}, torque{};            // on the centre of mass, and about it [N, N m; in 2D per metre]
  double damping = 0, angularDamping = 0;  // force over speed and torque over spin [kg/s, kg m2/s]
  std::vector<Spring> springs{};

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
  Oscillation oscillation{};                        // of a wall or nozzle, on top of its velocity
  TimeVector displacement{};                        // likewise since the start, on top of both [m]
  std::optional<Rotation> rotation{};               // likewise, on top of all
  std::array<std::string, 3> velocityExpression{};  // of a fluid, in place of a component of its velocity [m/s]
  std::string where{};                              // there are particles only where it is not zero
  std::vector<std::string> subtract{};              // and only where these bodies hold no place
  double disorder = 0;                              // of a fluid at the start: how far off its places [spacings]
  // In cases with heat. Of a fluid that at the start; of a wall that of its surface or, where it has a
  // conductance, of what is behind it; 0: the wall is adiabatic [K].
  double temperature = 0;
  std::string temperatureExpression{};  // of a fluid, in place of its temperature [K]
  // Of a fluid, by what the viscosities of its particles are multiplied, which then are part of the state; 0: 1,
  // and no part of it where no body says more.
  double viscosityFactor = 0;
  std::string viscosityFactorExpression{};  // in place of it
  std::vector<StateStart> states{};  // of a fluid, those that start with another value than the material says
  double wallConductance = 0;        // of a wall, its conductivity over its thickness [W/(m2 K)]; 0: infinite
  bool fileVelocities = false;       // fluid of a file has its velocities, on top of that of the body
  bool fileTemperatures = false;     // likewise, in place of its temperature
  Inflow inflow{};                   // of an inflow, in place of a shape
  RigidSettings rigid{};             // of a rigid body
  double friction = 0;               // of a rigid body or wall that others touch: its coefficient
  double restitution = 0;            // likewise: the speed after an impact over that before

  bool holdsFluid() const { return kind == BodyKind::Fluid || kind == BodyKind::Inflow; }
  /// Whether fluid meets its surface.
  bool isWall() const { return kind == BodyKind::Wall || kind == BodyKind::Rigid; }

  bool givesViscosityFactor() const { return viscosityFactor > 0 || !viscosityFactorExpression.empty(); }

  bool operator==(const Body&) const = default;
};

}  // namespace treacle
