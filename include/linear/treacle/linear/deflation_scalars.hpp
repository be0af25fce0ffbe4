#pragma once

#include "treacle/linear/krylov_scalars.hpp"

namespace treacle {

/// A symmetric matrix with a row for each mode.
struct ModeMatrix {
  static constexpr int maxModes = 16;

  double value[maxModes * maxModes];

  TREACLE_HD double& operator()(int i, int j) { return value[i * maxModes + j]; }
  TREACLE_HD double operator()(int i, int j) const { return value[i * maxModes + j]; }
};

/// The small numbers of Deflation. They stay in the backend's memory, as KrylovScalars do.
struct DeflationScalars {
  static constexpr int maxModes = ModeMatrix::maxModes;
  static constexpr int maxBasis = 32;  // iterations that modes are taken from, the first ones of a solve

  double rho[maxBasis], alpha[maxBasis], beta[maxBasis];  // KrylovScalars of these iterations
  ModeMatrix galerkin;                                    // E = W^T A W
  ModeMatrix inverse;                                     // of E; rows of zeros for modes that are left out
  double weight[maxModes];                                // of the modes in what is added next

  /// `s`: after its setDirection; its alpha is that of the iteration before.
  TREACLE_HD void record(const KrylovScalars& s) {
    const int i = s.iteration;
    if (i > 0 && i <= maxBasis) alpha[i - 1] = s.alpha;
    if (i < maxBasis) rho[i] = s.rho, beta[i] = s.beta;
  }
  /// weight = E^-1 products, one of its elements
  TREACLE_HD void setWeight(int j, const double* products, int modes) {
    double sum = 0;
    for (int l = 0; l < modes; ++l) sum += inverse(j, l) * products[l];
    weight[j] = sum;
  }
};

/// Modes as sums of recorded vectors: column j has the coefficients of mode j.
struct RitzVectors {
  int modes = 0, rows = 0;
  double coefficient[ModeMatrix::maxModes][DeflationScalars::maxBasis];
};

/// Of the Lanczos matrix of M^1/2 A M^1/2 that a solve's coefficients make up, T_ii = 1/alpha_i +
/// beta_i/alpha_{i-1} and T_{i,i+1} = sqrt(beta_{i+1})/alpha_i: the vectors of its largest values, at most `modes`
/// and only those of values above `least`.
RitzVectors largestRitzVectors(const DeflationScalars& scalars, int iterations, int modes, double least);

/// The inverse of the leading rows and columns of E. A mode that depends on those before it is left out, its row
/// and column are zero. Returns how many are in; none where E is not finite.
int invert(const ModeMatrix& e, int modes, ModeMatrix& inverse);

}  // namespace treacle
