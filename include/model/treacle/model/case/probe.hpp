#pragma once

#include "treacle/core/vec.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// What is measured: fields at places (Point, Line, Plane), where the free surface is along a line (Height), what
/// flows through a plane (Flow), sums and means over a part of the fluid (Region), what a wall bears (Load), and
/// the pressure on a part of one (WallPressure).
enum class ProbeKind { Point, Line, Plane, Height, Flow, Region, Load, WallPressure };

/// A part of space along the axes.
struct ProbeBox {
  Vec<3> min{}, max{};  // [m]

  bool operator==(const ProbeBox&) const = default;
};

/// A case has at most so many probes, that a set of them is a number.
inline constexpr std::size_t maxProbes = 64;

/// Something that is measured while a case runs (docs/probes.md).
struct Probe {
  std::string name{};
  ProbeKind kind = ProbeKind::Point;
  double interval = 0;            // [s]; 0: after every step
  Vec<3> point{};                 // Point; Flow, Region: a point of the plane [m]
  Vec<3> from{}, to{};            // Line, Height [m]
  int count = 0;                  // Line: places; 0: about one per spacing
  Vec<3> corner{};                // Plane, WallPressure: of a rectangle [m]
  Vec<3> along{}, up{};           // likewise: its edges, at right angles; WallPressure in 2D: along alone [m]
  int columns = 0;                // Plane: places along these; 0: about one per spacing
  int rows = 0;                   // Plane
  Vec<3> normal{};                // Flow: downstream; Region: away from what counts, zero: no plane
  std::optional<ProbeBox> box{};  // Flow, Region: what lies in it alone
  std::string material{};         // Flow, Region: of it alone; empty: all
  std::string body{};             // Load, WallPressure
  std::string movesWith{};        // others: the wall or rigid body that carries it (carriedProbe); empty: none

  bool isSampled() const { return kind <= ProbeKind::Height; }
  bool isOnWall() const { return kind == ProbeKind::Load || kind == ProbeKind::WallPressure; }
  bool isSummed() const { return kind == ProbeKind::Flow || kind == ProbeKind::Region; }

  bool operator==(const Probe&) const = default;
};

/// Places in rows, of which any dimension may be one: corner + c along/(columns - 1) + r up/(rows - 1).
struct ProbePlaces {
  Vec<3> corner{}, along{}, up{};  // [m]
  int columns = 1, rows = 1;

  /// Of a probe that is sampled; of Height the ends of the line alone. `spacing`: of the particles [m].
  static ProbePlaces of(const Probe& probe, double spacing);

  std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  /// Columns first.
  Vec<3> at(std::size_t place) const;
};

/// How far around a place particles count that a probe samples, in spacings.
inline constexpr double probeReach = 2.5;

/// Sums over a part of the fluid, with the volume V and mass m of the particles in it; in 2D per metre of depth.
/// Of what flows through a plane all are per metre of way across it.
struct PartSums {
  double volume = 0;                        // [m3]
  double mass = 0;                          // [kg]
  Vec<3> moment{};                          // sum of m x [kg m]
  Vec<3> flow{};                            // sum of V u [m4/s]
  Vec<3> momentum{};                        // sum of m u [kg m/s]
  double pressure = 0;                      // sum of V p [J]
  double viscosity = 0;                     // sum of V mu [Pa s m3]
  double shearRate = 0;                     // sum of V gamma [m3/s]
  double temperature = 0;                   // sum of V T [K m3]
  static constexpr std::size_t count = 15;  // of numbers
};
static_assert(sizeof(PartSums) == PartSums::count * sizeof(double));

}  // namespace treacle
