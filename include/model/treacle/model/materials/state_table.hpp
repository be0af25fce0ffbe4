#pragma once

#include "treacle/model/case/formula.hpp"
#include "treacle/model/materials/material.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace treacle {

struct Case;

/// What expressions of a material may read, in the order of StateTable: empty names are not to be had.
std::vector<std::string> stateVariables(const Case& c, const Material& m);

/// Laws of the states of all materials, and what reads them. The formulas stand one after the other in the memory
/// of a backend.
struct StateTable {
  struct Part {
    int first = 0, count = 0;  // steps; without any the formula is 1, and a state has no law
  };
  /// Where variables stand in those of the formulas.
  enum { Temperature, ShearRate, Time, FirstState, variables = FirstState + maxStates };

  const FormulaStep* steps = nullptr;
  Part rate[maxMaterials][maxStates];
  Part viscosity[maxMaterials], gelling[maxMaterials], yield[maxMaterials], volume[maxMaterials];
  double least[maxMaterials][maxStates], most[maxMaterials][maxStates];
  double heat[maxMaterials][maxStates];     // set free per unit and volume [J/m3]
  double warming[maxMaterials][maxStates];  // and by how much it warms the particle by itself [K]; 0: no heat

  /// Errors: InputError for expressions that are none.
  static StateTable make(const Case& c, std::vector<FormulaStep>& steps);

  TREACLE_HD double value(const Part& part, const double* x) const {
    return part.count > 0 ? formulaValue(steps + part.first, part.count, x) : 1;
  }
  /// By what a viscosity, a yield stress and a volume are multiplied, with the variables x.
  TREACLE_HD double viscosityFactor(int m, const double* x) const {
    return value(viscosity[m], x) * value(gelling[m], x);
  }
  TREACLE_HD double yieldFactor(int m, const double* x) const { return value(yield[m], x); }
  TREACLE_HD double volumeFactor(int m, const double* x) const { return value(volume[m], x); }

  /// Integrates the states of a particle of material m over dt [s] from its values x of all variables, which are
  /// those of the end afterwards; the temperature follows the heat that is set free. The method is ROS2, of second
  /// order with any diagonal in place of the Jacobian matrix and L-stable (J. G. Verwer et al., SIAM J. Sci.
  /// Comput. 20, 1999), in steps that it chooses.
  TREACLE_HD void advance(int m, double dt, double* x) const {
    const double start = x[Time], T = x[Temperature];
    double first[maxStates], done = 0, step = dt;
    for (int k = 0; k < maxStates; ++k) first[k] = x[FirstState + k];
    for (int tries = 0; done < dt && tries < mostTries; ++tries) {
      // What is left after so many tries is one step, which is stable.
      if (step > dt - done || tries == mostTries - 1) step = dt - done;
      double next[maxStates];
      const double error = tryStep(m, step, T, first, x, next);
      if (error <= 1 || tries == mostTries - 1) {
        done += step;
        set(m, next, T, first, start + done, x);
      }
      const double change = error > 0 ? 0.9 / std::sqrt(error) : 4;
      step *= change < 0.1 ? 0.1 : change < 4 ? change : 4;
    }
  }

 private:
  static constexpr int mostTries = 2000;
  static constexpr double tolerance = 1e-5;  // of a step, of first order, relative to the state

  /// Variables for the states s, within their bounds.
  TREACLE_HD void set(int m, const double* s, double T, const double* first, double time, double* x) const {
    x[Temperature] = T;
    x[Time] = time;
    for (int k = 0; k < maxStates; ++k) {
      const double low = least[m][k], high = most[m][k];
      x[FirstState + k] = s[k] < low ? low : s[k] > high ? high : s[k];  // NaN stays
      x[Temperature] += warming[m][k] * (x[FirstState + k] - first[k]);
    }
  }
  TREACLE_HD double rateOf(int m, int k, const double* x) const {
    return rate[m][k].count > 0 ? value(rate[m][k], x) : 0;
  }

  /// Sets next; the error over what is tolerated.
  TREACLE_HD double tryStep(int m, double step, double T, const double* first, const double* x,
                            double* next) const {
    constexpr double gamma = 1.7071067811865475;  // 1 + 1/sqrt(2)
    double k1[maxStates], damping[maxStates], y[variables], middle[maxStates];
    for (int j = 0; j < variables; ++j) y[j] = x[j];
    for (int k = 0; k < maxStates; ++k) {
      const double s = x[FirstState + k], f = rateOf(m, k, x);
      const double offset = 1e-6 * (std::fabs(s) + step * std::fabs(f)) + 1e-30;
      y[FirstState + k] = s + offset;
      y[Temperature] = x[Temperature] + warming[m][k] * offset;
      const double slope = (rateOf(m, k, y) - f) / offset;
      y[FirstState + k] = s, y[Temperature] = x[Temperature];
      damping[k] = 1 / (1 + gamma * step * (slope < 0 ? -slope : 0));
      k1[k] = damping[k] * f;
      middle[k] = s + step * k1[k];
    }
    set(m, middle, T, first, x[Time] + step, y);
    double error = 0;
    for (int k = 0; k < maxStates; ++k) {
      const double s = x[FirstState + k], k2 = damping[k] * (rateOf(m, k, y) - 2 * k1[k]);
      next[k] = s + step * (1.5 * k1[k] + 0.5 * k2);
      const double off = std::fabs(0.5 * step * (k1[k] + k2));
      const double size = std::fmax(std::fabs(first[k]), std::fabs(s)) + step * std::fabs(k1[k]);
      if (off > 0) error = std::fmax(error, off / (tolerance * size));
    }
    return error;
  }
};

}  // namespace treacle
