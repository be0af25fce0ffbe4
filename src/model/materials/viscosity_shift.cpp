#include "treacle/model/materials/viscosity_shift.hpp"

#include <algorithm>
#include <numbers>

namespace treacle {

ShiftFactor ShiftFactor::make(const ViscosityShift& s) {
  ShiftFactor f;
  f.model = s.model;
  f.reference = s.reference;
  f.least = std::log(s.least), f.most = std::log(s.most);
  switch (s.model) {
    case ShiftModel::Arrhenius:
      f.numerator = s.activationEnergy / gasConstant;
      break;
    case ShiftModel::Vft:
      f.numerator = std::numbers::ln10 * s.slope;
      f.pole = s.divergence;
      break;
    case ShiftModel::Wlf:
      f.numerator = std::numbers::ln10 * s.c1 * s.c2;
      f.pole = s.reference - s.c2;
      break;
    case ShiftModel::Table:
      f.rows = static_cast<int>(std::min<std::size_t>(s.temperatures.size(), ViscosityShift::mostRows));
      for (int k = 0; k < f.rows; ++k) {
        f.temperature[k] = s.temperatures[static_cast<std::size_t>(k)];
        f.logarithm[k] = std::log(s.factors[static_cast<std::size_t>(k)]);
      }
      // Its rows bound it.
      f.least = *std::min_element(f.logarithm, f.logarithm + f.rows);
      f.most = *std::max_element(f.logarithm, f.logarithm + f.rows);
      break;
  }
  return f;
}

}  // namespace treacle
