#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>
#include <vector>

namespace treacle {

/// How the viscosity of a fluid follows its temperature.
enum class ShiftModel { Arrhenius, Vft, Wlf, Table };

/// The shift factor a_T: the fluid at temperature T has the stress that it would have at the reference temperature
/// if it were sheared a_T times as fast (thermorheologically simple fluids; J. D. Ferry, Viscoelastic Properties
/// of Polymers, 3rd ed., 1980, ch. 11). The viscosity of a Newtonian fluid is multiplied by it.
///   arrhenius  ln a = E/R (1/T - 1/T_r)
///   vft        log10 a = B (1/(T - T_0) - 1/(T_r - T_0))      (Vogel, Fulcher, Tammann)
///   wlf        log10 a = -C1 (T - T_r) / (C2 + T - T_r)       (Williams, Landel, Ferry)
///   table      ln a linear in T between the rows, constant beyond them
/// Below their poles, T_0 and T_r - C2, the models have no value: there a is the largest one.
struct ViscosityShift {
  /// Rows of a table: device code looks it up in memory of a fixed size.
  static constexpr int mostRows = 16;

  ShiftModel model = ShiftModel::Arrhenius;
  double reference = 0;         // T_r [K]
  double activationEnergy = 0;  // E [J/mol]
  double slope = 0;             // B [K]
  double divergence = 0;        // T_0 [K]
  double c1 = 0;                // [-]
  double c2 = 0;                // [K]
  double least = 1e-6, most = 1e6;
  std::vector<double> temperatures{}, factors{};  // [K], rising, and [-]

  bool operator==(const ViscosityShift&) const = default;
};

/// The same as a number of constants, for device code.
struct ShiftFactor {
  static constexpr double gasConstant = 8.31446261815324;  // [J/(mol K)], exact since 2019

  ShiftModel model = ShiftModel::Arrhenius;
  int rows = 0;                                                        // of a table
  double reference = 1, numerator = 0, pole = 0, least = 0, most = 0;  // of ln a; as they are here, a = 1
  double temperature[ViscosityShift::mostRows];
  double logarithm[ViscosityShift::mostRows];

  static ShiftFactor make(const ViscosityShift& shift);

  /// a_T of T [K].
  TREACLE_HD double operator()(double T) const {
    const double log = model == ShiftModel::Table ? fromTable(T) : fromModel(T);
    return std::exp(log < least ? least : log > most ? most : log);
  }

 private:
  /// n (1/(T - T_0) - 1/(T_r - T_0)), which all three models are: that of Arrhenius has its pole at 0, and that of
  /// Williams, Landel and Ferry is that of Vogel, Fulcher and Tammann.
  TREACLE_HD double fromModel(double T) const {
    return T > pole ? numerator * (1 / (T - pole) - 1 / (reference - pole)) : most;
  }
  TREACLE_HD double fromTable(double T) const {
    int k = 0;
    while (k + 1 < rows && T > temperature[k + 1]) ++k;
    if (k + 1 >= rows) return logarithm[rows - 1];
    const double share = (T - temperature[k]) / (temperature[k + 1] - temperature[k]);
    return logarithm[k] + (share > 0 ? share : 0) * (logarithm[k + 1] - logarithm[k]);
  }
};

}  // namespace treacle
