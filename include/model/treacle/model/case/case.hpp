#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/body.hpp"
#include "treacle/model/case/method_settings.hpp"
#include "treacle/model/case/output_settings.hpp"
#include "treacle/model/case/probe.hpp"
#include "treacle/model/case/solver_settings.hpp"
#include "treacle/model/case/time_function.hpp"
#include "treacle/model/materials/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// The data of one simulation: SI units, resolution already applied. Two-dimensional cases leave the third
/// component at zero. A case read from a file is checked; for one made in code requireValid says what is wrong
/// with it.

struct Domain {
  Vec<3> min{}, max{};             // [m]
  std::array<bool, 3> periodic{};  // false: open, a particle that leaves ends the run

  bool operator==(const Domain&) const = default;
};

struct TimeSettings {
  double step = 0;     // [s]; where steps vary the longest one
  double end = 0;      // [s]
  double courant = 0;  // distance of the fastest particle in a step, in spacings; 0: no bound by the case
  // Steps of MPH-I that are chosen by their errors (docs/time-step.md).
  bool automatic = false;
  double tolerance = 0.02;  // of the error of a step
  double least = 0;         // shortest step [s]

  bool stepsVary() const { return courant > 0 || automatic; }
  /// The key that bounds the steps.
  const char* stepKey() const { return automatic ? "time.max_step" : "time.step"; }
  /// The bound on that distance that holds; 0: none.
  double mostCourant() const { return courant > 0 || !automatic ? courant : 1; }

  bool operator==(const TimeSettings&) const = default;
};

struct Case {
  std::string title;
  int dimensions = 2;
  double spacing = 0;     // l [m], resolution applied
  double resolution = 1;  // what spacing and time step were divided by
  Domain domain;
  Vec<3> gravity{};            // of one that varies what scales and pictures follow: its mean over the run [m/s2]
  TimeVector gravityInTime{};  // the components that vary
  // Of the frame that places and velocities are in, as seen from outside, where gravity is that of the case.
  std::optional<Rotation> frame{};
  std::vector<Material> materials;
  std::vector<Body> bodies;
  std::vector<Outflow> outflows{};
  std::vector<Opening> openings{};
  TimeSettings time;
  MethodSettings method;
  RheologySettings rheology;
  std::optional<HeatSettings> heat{};  // missing: there are no temperatures; MPH-I only
  std::optional<GasSettings> gas{};    // missing: what is empty has no pressure
  SolverSettings solver;
  OutputSettings output;
  std::vector<Probe> probes{};
  WatchSettings watch;

  double pressureRadius() const { return method.pressureRadius * spacing; }  // h_p [m]
  /// h_n [m]. Fluids with a surface tension have one of their own (makeMphPairs).
  double densityRadius() const { return std::max(method.densityRadius, method.pressureRadius) * spacing; }
  double viscosityRadius() const { return method.viscosityRadius * spacing; }  // h_v [m]
  /// r_0: distance below which particles of the accurate scheme of MPH-I repel each other; 0: they do not [m].
  double repulsionRadius() const { return method.scheme == SchemeKind::Accurate ? 0.53 * spacing : 0; }
  /// Smoothing length h of ISPH [m].
  double smoothingLength() const { return method.isph.smoothingRatio * spacing; }
  /// Whether the formulas are those of the accurate scheme of MPH-I.
  bool isAccurate() const { return method.kind == MethodKind::MphI && method.scheme == SchemeKind::Accurate; }
  /// Where in a step the forces on the fluid are those that it has: at its start, as in [K23], or in its middle.
  double middleShare() const { return keepsVolume() ? 0.5 : 0; }
  /// Whether the motion, the weight of densities and the tension of the fluid are those that keep the volume
  /// (docs/accurate.md). A surface tension, which acts by the places of particles, would need steps half as long,
  /// and was made for other densities. Gaps close by the matrix of the renormalised gradient.
  bool keepsVolume() const { return isAccurate() && !hasSurfaceTension(); }
  /// Farthest distance at which particles act on each other [m].
  double interactionRadius() const {
    return method.kind == MethodKind::Isph ? 2 * smoothingLength() : std::max(viscosityRadius(), densityRadius());
  }
  /// Smallest edge of the search cells [m].
  double searchEdge() const {
    return method.kind == MethodKind::Isph ? 2 * smoothingLength()
                                           : std::max({viscosityRadius(), densityRadius(), 2 * pressureRadius()});
  }
  /// Whether particles have viscosities of their own, by their shear rates, temperatures or factors: they then
  /// have the first of these, too.
  bool hasOwnViscosities() const {
    return hasViscosityFactors() ||
           std::ranges::any_of(materials, [](const Material& m) { return m.hasOwnViscosities(); });
  }
  /// Whether walls act on fluid that slips across their surfaces alone. The forces of a surface tension on the
  /// edge of a drop do not cancel well enough for that: with an angle of 135 degrees it would not stay in its
  /// place.
  bool hasSmoothWalls() const {
    return keepsVolume() && std::ranges::any_of(materials, [](const Material& m) { return m.slipLength > 0; });
  }
  /// Whether the density of some fluid follows its temperature or states.
  bool hasBuoyancy() const {
    return hasVolumeFactors() ||
           std::ranges::any_of(materials, [](const Material& m) { return m.thermalExpansion != 0; });
  }
  bool hasVolumeFactors() const {
    return std::ranges::any_of(materials, [](const Material& m) { return !m.volumeFactor.empty(); });
  }
  bool freezes() const {
    return std::ranges::any_of(materials, [](const Material& m) { return m.freezing.has_value(); });
  }
  bool hasViscosityFactors() const {
    return std::ranges::any_of(bodies, [](const Body& b) { return b.givesViscosityFactor(); });
  }
  /// The names of the states of all materials, each once.
  std::vector<std::string> stateNames() const;
  bool hasStates() const {
    return std::ranges::any_of(materials, [](const Material& m) { return !m.states.empty(); });
  }
  /// How many elastic modes the fluids have, at most.
  std::size_t elasticModes() const {
    std::size_t most = 0;
    for (const Material& m : materials) most = std::max(most, m.elastic.size());
    return most;
  }
  /// What fluid of a material starts with of which no body says more, in the order of stateNames(); 0 for states
  /// that it does not have.
  std::vector<double> startsOfStates(const Material& m) const;
  /// Leaves viscosities what they are.
  void haveViscosityFactors() {
    if (hasViscosityFactors()) return;
    const auto first = std::ranges::find_if(bodies, &Body::holdsFluid);
    if (first != bodies.end()) first->viscosityFactor = 1;
  }
  /// The temperature that the first fluid of a material of the case starts with; where a formula says that, one
  /// that the material has its constants at [K]. And a_T there.
  double typicalTemperature(const Material& m) const;
  double typicalShift(const Material& m) const;
  /// mu there, of a rheology that at a shear rate of 1/s: for what needs one number that stands for all [Pa s].
  double typicalViscosity(const Material& m) const;
  /// Whether materials differ among the fluids: those of fluid bodies, or all where no body says which.
  bool hasSeveralFluids() const {
    const auto isFluid = [](const Body& body) { return body.holdsFluid(); };
    const auto first = std::ranges::find_if(bodies, isFluid);
    if (first == bodies.end()) return materials.size() > 1;
    return std::ranges::any_of(
        bodies, [&](const Body& body) { return isFluid(body) && body.material != first->material; });
  }
  bool hasInflow() const {
    return std::ranges::any_of(bodies, [](const Body& b) { return b.kind == BodyKind::Inflow; });
  }
  bool hasThinSheets() const {
    return std::ranges::any_of(bodies, [](const Body& b) { return b.shape.isThinSheet(); });
  }
  bool hasRigid() const {
    return std::ranges::any_of(bodies, [](const Body& b) { return b.kind == BodyKind::Rigid; });
  }
  /// Whether the number of fluid particles changes.
  bool gravityVaries() const {
    return std::ranges::any_of(gravityInTime, [](const auto& component) { return component.has_value(); });
  }
  /// Its mean from one time to another, from 0 on [m/s2].
  Vec<3> meanGravity(double from, double to) const;

  bool isOpen() const { return hasInflow() || !outflows.empty() || !openings.empty(); }
  bool hasLoads() const {
    return std::ranges::any_of(probes, [](const Probe& p) { return p.isOnWall(); });
  }
  /// Whether the balance of each step is computed: for its file, or for what walls bear. Of MPH-I.
  bool needsBalance() const { return output.balance || hasLoads(); }
  /// Whether what walls bear is summed in each step: for the balance or for rigid bodies. Of MPH-I.
  bool needsWallForces() const { return needsBalance() || hasRigid(); }
  /// Whether some fluid has one; those of materials of walls do not count.
  bool hasSurfaceTension() const {
    return std::ranges::any_of(bodies, [&](const Body& b) {
      return b.holdsFluid() && materials[static_cast<std::size_t>(b.material)].surfaceTension > 0;
    });
  }
  /// Whether walls look for fluid as far as any pair acts, and not as far as densities alone. Of MPH-I.
  bool needsWallNeighbours() const { return needsWallForces() || hasSurfaceTension(); }
  /// Steps to the end, where all have one length.
  std::int64_t steps() const { return std::llround(time.end / time.step); }
  /// Whether a run that has made so many steps, and is at time `now` [s], is at its end.
  bool atEnd(std::int64_t step, double now) const {
    return time.stepsVary() ? now >= time.end * (1 - 1e-9) : step >= steps();
  }

  bool operator==(const Case&) const = default;
};

}  // namespace treacle
