#pragma once

#include "treacle/io/files/rows.hpp"
#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/state/balance.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

namespace treacle {

/// The pressure on a patch of a wall, over steps.
struct PatchMean {
  double time = 0, impulse = 0;                               // [s], [Pa s]
  double largest = -std::numeric_limits<double>::infinity();  // of a step [Pa]

  /// `pressure`: not a number where the fluid is so far away that the patch has no active wall particles.
  void add(double pressure, double timeStep) {
    const double felt = std::isnan(pressure) ? 0 : pressure;
    time += timeStep, impulse += timeStep * felt;
    largest = std::fmax(largest, felt);
  }
};

/// Appends what a probe reads to a new CSV file (docs/probes.md); numbers read back to the same bits. Errors:
/// those of RowFile.
class ProbeWriter {
 public:
  /// Replaces what the target holds. `c` and `probe` must outlive this.
  ProbeWriter(RowTarget to, const Case& c, const Probe& probe);

  /// At a time [s], of a probe that is sampled: all fluid and walls within probeReach of its places. `now`: the
  /// probe as it stands then.
  void append(double time, const Probe& now, const Frame& fluid, const Frame& walls);
  /// Of one that is summed.
  void append(double time, const Probe& now, const PartSums& sums);
  /// Of the pressure on a wall since the last reading.
  void append(double time, const PatchMean& pressure);
  /// Of a load; `walls`: what the walls of the case bear, in their order.
  void append(double time, const std::vector<WallLoad>& walls);

 private:
  std::string components(const Vec<3>& v) const;

  const Case& case_;
  const Probe& probe_;
  const bool hasOwnViscosities_;  // when its columns were named: the case may change
  Rows rows_;
};

}  // namespace treacle
