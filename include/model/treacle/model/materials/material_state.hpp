#pragma once

#include <string>

namespace treacle {

/// Largest number of states of a case; materials may share names.
inline constexpr int maxStates = 4;

/// How a state of a material changes.
enum class StateLaw { Expression, KamalSourour, Houska, Roussel };

/// A number that particles of a material carry and that a law changes in each step: how far a resin has cured, how
/// much structure a paste has built up. Rates are those of the material's particle, at its temperature and shear
/// rate:
///   expression     ds/dt = rate
///   kamal-sourour  ds/dt = (A1 exp(-E1/(R T)) + A2 exp(-E2/(R T)) s^m) (s_max - s)^n
///                  (M. R. Kamal, S. Sourour, Polym. Eng. Sci. 13, 1973)
///   houska         ds/dt = a (1 - s) - b s gamma^e           (with e = 1: F. Moore, Trans. Br. Ceram. Soc. 58,
///   1959) roussel        ds/dt = 1/T_flocc - b s gamma             (N. Roussel, Cem. Concr. Res. 36, 2006)
struct MaterialState {
  std::string name;
  StateLaw law = StateLaw::Expression;
  std::string rate{};                                   // of an expression [1/s]
  double a1 = 0, e1 = 0, a2 = 0, e2 = 0, m = 0, n = 1;  // of Kamal and Sourour: A [1/s], E [J/mol]
  double mostConversion = 1;                            // likewise
  double buildUp = 0;                                   // a [1/s]
  double breakDown = 0;                                 // b [s^(e-1)]
  double exponent = 1;                                  // e
  double time = 0;                                      // T_flocc [s]
  double start = 0;                                     // of fluid of which no body says more
  double least = -1e30, most = 1e30;                    // bounds
  double heat = 0;                                      // set free per unit of the state and mass [J/kg]

  /// Its law as an expression in T, shear_rate and its name [1/s].
  std::string rateText() const;
  /// The bounds, of which laws have their own.
  double lowest() const;
  double highest() const;

  bool operator==(const MaterialState&) const = default;
};

/// A viscosity that grows without bound as a state comes to a gel point: it is multiplied by
/// (c_gel / (c_gel - s))^(a + b s) (J. M. Castro, C. W. Macosko, AIChE J. 28, 1982), at most by max_factor.
struct Gelling {
  std::string state;
  double conversion = 0;  // c_gel
  double a = 0, b = 0;
  double mostFactor = 1e4;

  /// As an expression.
  std::string text() const;

  bool operator==(const Gelling&) const = default;
};

/// What a body of fluid starts with.
struct StateStart {
  std::string name;
  double value = 0;
  std::string expression{};  // in place of the value, of the place

  bool operator==(const StateStart&) const = default;
};

}  // namespace treacle
