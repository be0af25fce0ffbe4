#pragma once

#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace treacle {

/// How far particles look for the nearest other one, in spacings; one that finds none has this distance.
inline constexpr double nearestReach = 1.5;

/// Particles whose nearest other one is within this distance [spacings] act with it as one.
inline constexpr double closeDistance = 0.25;

/// How the fluid particles of a frame lie.
struct Arrangement {
  // Of the distances to the nearest other particle, over the spacing: the least and the 1 % quantile [-].
  double least = nearestReach, low = nearestReach;
  /// Particles per spacing^dimensions inside the fluid: its density over that of the material [-]. The mean over
  /// places with nothing but fluid for at least 2.25 spacings around; empty where there is none.
  std::optional<double> density{};
  double close = 0;          // share of the particles with another one within closeDistance [-]
  bool touchesWalls = true;  // a particle has one of a wall within nearestReach; true, too, where nobody looked

  bool operator==(const Arrangement&) const = default;
};

/// Fills in fluid.nearestDistance, in which walls and periodic images count. Time and memory are proportional to
/// the number of particles (their sort apart), wherever they lie. Periodic axes: at least 4.5 spacings long.
Arrangement measureArrangement(Frame& fluid, const Frame& walls, const Domain& domain, double spacing);

/// The smallest distance of a fluid particle from a wall particle, also across periodic ends [m]. It is infinite
/// if there is no fluid or no wall. The function takes O(n log n).
double distanceToWalls(const Frame& fluid, const Frame& walls, const Domain& domain);

/// What a process that has a part of the fluid can say: with what the others say it makes the arrangement of all.
struct ArrangementPart {
  static constexpr double bin = 1e-4;  // of distances [spacings]

  double least = nearestReach;
  double density = 0;                    // sum over `places`
  std::uint64_t close = 0, places = 0;   // particles, weight of the places
  std::vector<std::uint64_t> distances;  // particles per bin, up to nearestReach

  bool operator==(const ArrangementPart&) const = default;
};

/// The same of a part: `others` are the walls and the fluid of other processes within nearestReach of it, on
/// whichever side of periodic ends [m]. Densities are counted at places that have nothing but this part around
/// them.
ArrangementPart measureArrangementPart(Frame& fluid, std::span<const Vec<3>> others, const Domain& domain,
                                       double spacing);

/// Of parts that were added up, the least distance among theirs. The 1 % quantile is known to half a bin.
Arrangement arrangementOf(const ArrangementPart& all);

}  // namespace treacle
