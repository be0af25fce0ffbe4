#pragma once

#include <functional>
#include <vector>

namespace treacle {

/// That unknowns are on one side of a plane, row . x >= least, and what holds them there: a multiple >= 0 of
/// `push`, by which the function is no longer zero.
struct Restraint {
  /// What is to stay where it is as well, row . x = rest, by a multiple of `push`, as far as the restraint grips.
  struct Slide {
    std::vector<double> row, push;
    double rest = 0;
  };

  std::vector<double> row, push;
  double least = 0;
  // The multiples of all slides are a vector no longer than `grip` times the multiple of the restraint; where that
  // does not do, it points against what is missing (Coulomb's law).
  std::vector<Slide> slides{};
  double grip = 0;
};

/// Finds where a function of few unknowns is zero that is affine, or nearly so, and takes long to compute: by
/// steps with its derivative, which each value makes better (Broyden). An affine one of n unknowns takes n + 2
/// values with a derivative that is not known, and two or three with one that was so shortly before. One with
/// kinks leads such a derivative astray: where eight steps do not do, it is found anew from values nearby, and
/// steps of a hundred tolerances are then enough, because values have errors, too. With restraints it finds where
/// the function is a sum of their pushes, of those alone that hold with equality, and of those of their slides.
class AffineSolve {
 public:
  using Function = std::function<std::vector<double>(const std::vector<double>& x)>;

  struct Result {
    int values = 0;          // of the function that were computed; its last one is that at x
    bool converged = false;  // the next step would have been short enough
  };

  /// `derivative`: n x n, row by row; empty: not known; takes what it is in the end, or nothing where an unknown
  /// changes nothing: later it may. Such an unknown keeps its value, whatever the function is. `scale`: of each
  /// unknown, by which a derivative that is not known is found and the `tolerance` of a step is measured. `most`:
  /// steps.
  static Result run(const Function& f, std::vector<double>& x, std::vector<double>& derivative,
                    const std::vector<double>& scale, double tolerance, int most,
                    const std::vector<Restraint>& restraints = {});
};

}  // namespace treacle
