#include "treacle/mph/viscosity_classes.hpp"

#include "treacle/model/materials/state_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {
namespace {

/// For the constants of the preconditioner that are numbers per material: its degree was found to suit the fluid
/// where it is thin, not where it is thick.
double flowingViscosity(const Material& m, double shift) {
  return std::min(m.viscosity(0.1, shift), m.viscosity(10, shift)) + shift * m.elasticViscosity();
}

struct Range {
  double least, most;  // [Pa s]
};

/// a_T between the lowest and the highest temperature that a case gives, and a little beyond; where formulas or
/// files give them at all temperatures.
Range shifts(const Case& c, const Material& m) {
  if (!c.heat || !m.viscosityShift) return {1, 1};
  const ShiftFactor factor = ShiftFactor::make(*m.viscosityShift);
  double least = c.heat->ambient, most = least;
  for (const Body& body : c.bodies) {
    if (!body.temperatureExpression.empty() || body.fileTemperatures)
      return {std::exp(factor.least), std::exp(factor.most)};
    if (body.temperature == 0) continue;
    least = std::min(least, body.temperature), most = std::max(most, body.temperature);
  }
  const double beyond = 5 + 0.1 * (most - least);  // [K]
  Range range{factor(most), factor(most)};
  for (int k = -32; k <= 32; ++k) {
    const double a = factor(0.5 * (least + most) + k / 32.0 * (0.5 * (most - least) + beyond));
    range.least = std::min(range.least, a), range.most = std::max(range.most, a);
  }
  return range;
}

/// By which viscosities of particles are multiplied: what bodies say, and, as formulas and who changes a state may
/// say anything, three powers of ten on both sides.
Range factors(const Case& c) {
  if (!c.hasViscosityFactors()) return {1, 1};
  Range range{1e-3, 1e3};
  for (const Body& body : c.bodies)
    if (const double factor = body.viscosityFactor; factor > 0)
      range = {std::min(range.least, factor), std::max(range.most, factor)};
  return range;
}

/// What a formula of the material gives: at values of the states between their bounds, where these are all narrow,
/// and three powers of ten on both sides where nobody knows.
Range formulaRange(const Case& c, const Material& m, const std::string& text) {
  if (text.empty()) return {1, 1};
  constexpr double wide = 1e6;
  constexpr int points = 9;
  for (const MaterialState& s : m.states)
    if (s.lowest() < -wide || s.highest() > wide) return {1e-3, 1e3};
  const std::vector<std::string> names = c.stateNames();
  const Formula formula(text, stateVariables(c, m));
  Range range{std::numeric_limits<double>::infinity(), 0};
  int all = 1;
  for (std::size_t k = 0; k < m.states.size(); ++k) all *= points;
  for (const double rate : {0.0, 1e-3, 1.0, 1e3})
    for (int at = 0; at < all; ++at) {
      double x[StateTable::variables] = {c.heat ? c.typicalTemperature(m) : 0, rate, 0};
      int rest = at;
      for (const MaterialState& s : m.states) {
        const auto k = std::ranges::find(names, s.name) - names.begin();
        x[StateTable::FirstState + k] = s.lowest() + rest % points * (s.highest() - s.lowest()) / (points - 1);
        rest /= points;
      }
      if (const double value = formula(x); value > 0 && std::isfinite(value))
        range = {std::min(range.least, value), std::max(range.most, value)};
    }
  return range.most > 0 ? range : Range{1, 1};
}

/// The viscosities at shear rates from rest to a million per second; no case here flows faster.
Range viscosities(const Case& c, const Material& m) {
  const Range shift = shifts(c, m), factor = factors(c), yield = formulaRange(c, m, m.yieldFactor);
  const Range ofFormula = formulaRange(c, m, m.viscosityFactor), ofGel{1, m.gelling ? m.gelling->mostFactor : 1};
  const double ofSolid = m.freezing ? m.freezing->solidFactor : 1;
  Range range{m.viscosity(0, shift.least, yield.least), m.viscosity(0, shift.most, yield.most)};
  for (double rate = 1e-6; rate < 2e6; rate *= 10) {
    range.least = std::min(range.least, m.viscosity(rate, shift.least, yield.least));
    range.most = std::max(range.most, m.viscosity(rate, shift.most, yield.most));
  }
  // From steps of a tenth of the relaxation time to modes stretched tenfold.
  const double elastic = m.elasticViscosity();
  return {factor.least * ofFormula.least * (range.least + 0.1 * shift.least * elastic),
          ofSolid * factor.most * ofFormula.most * ofGel.most * (range.most + 10 * shift.most * elastic)};
}

bool hasSteps(const ViscosityClasses& classes, const Case& c, const Material& m) {
  if (m.rheology) return true;
  return (m.dynamicViscosity > 0 || !m.elastic.empty()) &&
         (m.viscosityShift || m.freezing || m.hasFormulas() || !m.elastic.empty() || c.hasViscosityFactors() ||
          classes.ofNeighbours || c.isAccurate());
}

/// Among particles of another fluid, or at a surface, a particle may be resisted by a fraction of its viscosity,
/// at a wall by a multiple, and under pressure by what long steps take (pressure_stiffness.hpp).
Range rangeOf(const ViscosityClasses& classes, const Case& c, const Material& m) {
  Range own = viscosities(c, m);
  if (c.isAccurate()) own.most = std::max(own.most, 100 * own.least);
  return classes.ofNeighbours ? Range{own.least / 16, 8 * own.most} : own;
}

}  // namespace

ViscosityClasses ViscosityClasses::make(const Case& c) {
  ViscosityClasses classes;
  classes.ofNeighbours = c.hasSeveralFluids();
  int shared = 0;  // by how many materials the other classes are
  for (const Material& m : c.materials) {
    classes.material[classes.count] = static_cast<std::uint8_t>(classes.count);
    classes.viscosity[classes.count++] = flowingViscosity(m, c.typicalShift(m));
    shared += hasSteps(classes, c, m);
  }
  const int each = shared > 0 ? (most - classes.count) / shared : 0;
  // A few wide steps would say less of a particle than its material does.
  if (classes.ofNeighbours && each < 3) return classes;
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    if (!hasSteps(classes, c, c.materials[m])) continue;
    const Range range = rangeOf(classes, c, c.materials[m]);
    const double width = std::max(std::log(range.most / range.least) / each, 0.1);
    classes.steps_[m] = {classes.count, each, range.least, 1 / width};
    for (int k = 0; k < each; ++k) {
      classes.material[classes.count] = static_cast<std::uint8_t>(m);
      classes.viscosity[classes.count++] = range.least * std::exp((k + 0.5) * width);
    }
  }
  return classes;
}

}  // namespace treacle
