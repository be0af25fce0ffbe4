#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// The coefficients of conjugate gradients and the tridiagonal matrix of Lanczos' method that they make up:
/// T_jj = 1 / alpha_j + beta_{j-1} / alpha_{j-1}, T_{j,j+1} = sqrt(beta_j) / alpha_j.
struct LanczosScalars {
  static constexpr int maxSteps = 64;

  double diagonal[maxSteps], offDiagonal[maxSteps];  // offDiagonal[j]: between j and j + 1
  double rho, alpha, beta;                           // rho = r.D^-1 r
  double smallest;                                   // below, r is rounding error
  int count;                                         // rows of T
  bool done;

  TREACLE_HD void start(double newRho, double epsilon) {
    rho = newRho;
    smallest = 100 * epsilon * epsilon * newRho;
    alpha = beta = 0;
    count = 0;
    done = !isPositive(newRho);
  }
  /// sigma = p.A p
  TREACLE_HD void setStep(double sigma) {
    done = done || !isPositive(sigma);
    const double before = alpha;
    alpha = done ? 0 : rho / sigma;  // with zero the vectors stay as they are
    if (done) return;
    diagonal[count] = 1 / alpha + (count > 0 ? beta / before : 0);
    if (count > 0) offDiagonal[count - 1] = std::sqrt(beta) / before;
    ++count;
  }
  TREACLE_HD void setDirection(double newRho) {
    done = done || !(newRho > smallest) || !isPositive(newRho);
    beta = done ? 0 : newRho / rho;
    rho = newRho;
  }

  /// Bounds of the largest eigenvalue of T (count > 0): its largest diagonal element, and Gershgorin's circles.
  TREACLE_HD void bounds(double& lower, double& upper) const {
    lower = upper = diagonal[0];
    for (int j = 0; j < count; ++j) {
      const double radius = (j > 0 ? offDiagonal[j - 1] : 0) + (j + 1 < count ? offDiagonal[j] : 0);
      lower = diagonal[j] > lower ? diagonal[j] : lower;
      upper = diagonal[j] + radius > upper ? diagonal[j] + radius : upper;
    }
  }
  /// Whether T has an eigenvalue at or above x: whether T - x has a pivot that is not negative (Sturm).
  TREACLE_HD bool reaches(double x) const {
    double pivot = diagonal[0] - x;
    for (int j = 1; j < count && pivot < 0; ++j)
      pivot = diagonal[j] - x - offDiagonal[j - 1] * offDiagonal[j - 1] / pivot;
    return !(pivot < 0);
  }

 private:
  TREACLE_HD static bool isPositive(double x) { return x > 0 && x - x == 0; }
};

}  // namespace treacle
