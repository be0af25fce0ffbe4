#pragma once

#include <string>

namespace treacle {

/// Largest number of modes of an elastic fluid.
inline constexpr int maxElasticModes = 4;

/// How the stress of a mode relaxes.
enum class ElasticModel { OldroydB, Giesekus, LinearPtt, ExponentialPtt };

/// A mode of a viscoelastic fluid: a polymer with the stress tau = (eta/lambda) (c - I), whose conformation c
/// follows
///   dc/dt = L c + c L^T - (K (c - I) + (c - I) K)/2,   K = f/lambda ((1 - alpha) I + alpha c),   L = grad u
///   oldroyd-b        alpha = 0, f = 1                          (J. G. Oldroyd, Proc. R. Soc. A 200, 1950)
///   giesekus         f = 1                                     (H. Giesekus, J. Non-Newton. Fluid Mech. 11, 1982)
///   linear-ptt       alpha = 0, f = 1 + epsilon tr(c - I)      (N. Phan-Thien, R. I. Tanner, JNNFM 2, 1977)
///   exponential-ptt  alpha = 0, f = exp(epsilon tr(c - I))     (N. Phan-Thien, J. Rheol. 22, 1978)
struct ElasticMode {
  std::string name;
  ElasticModel model = ElasticModel::OldroydB;
  double viscosity = 0;       // eta [Pa s]
  double relaxationTime = 0;  // lambda [s]
  double mobility = 0;        // alpha of Giesekus
  double extensibility = 0;   // epsilon of PTT

  bool operator==(const ElasticMode&) const = default;
};

}  // namespace treacle
