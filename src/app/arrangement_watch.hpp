#pragma once

#include "treacle/io/frames/arrangement.hpp"
#include "treacle/model/case/case.hpp"

#include <limits>
#include <string>
#include <vector>

namespace treacle {

/// Says when a run's particles come to lie so that its results are to be doubted; docs/output.md explains the
/// bounds.
class ArrangementWatch {
 public:
  /// Of the 1 % quantile of nearest distances: with one of 0.38 the front of a dam break is the same to 1e-5.
  static constexpr double lowBound = closeDistance, densityBound = 0.02;
  /// The share of close particles that is usual in ISPH, in whose splashes some always lie together.
  static constexpr double closeBound = 0.05;

  explicit ArrangementWatch(const Case& c) : case_(c) {}

  /// Warnings about the frame at `time` [s]: of each kind one, and another only when it has become twice as bad.
  std::vector<std::string> look(const Arrangement& arrangement, double time);

 private:
  bool clumps(const Arrangement& arrangement);  // to be told
  std::string clumpText(const Arrangement& arrangement) const;
  std::string densityText(double density) const;
  bool published() const;  // the scheme
  bool isIsph() const { return case_.method.kind == MethodKind::Isph; }

  const Case& case_;
  double warnedClose_ = 0;
  double warnedLow_ = std::numeric_limits<double>::infinity();
  double warnedError_ = 0;  // of the density
};

/// "nearest distances from 0.64, 1 % below 0.66, density inside 1.006".
std::string textOf(const Arrangement& arrangement);

}  // namespace treacle
