#include "treacle/model/materials/material_state.hpp"

#include "treacle/model/materials/viscosity_shift.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace treacle {
namespace {

/// A exp(-E/(R T)), or A where it does not follow the temperature.
std::string arrhenius(double factor, double energy) {
  return energy == 0 ? fmt::format("{}", factor)
                     : fmt::format("{}*exp(-({})/T)", factor, energy / ShiftFactor::gasConstant);
}

}  // namespace

std::string MaterialState::rateText() const {
  switch (law) {
    case StateLaw::Expression:
      return rate;
    case StateLaw::KamalSourour:
      return fmt::format("({} + {}*max({},0)^{})*max({}-{},0)^{}", arrhenius(a1, e1), arrhenius(a2, e2), name, m,
                         mostConversion, name, n);
    case StateLaw::Houska:
      return fmt::format("{}*(1-{}) - {}*{}*shear_rate^{}", buildUp, name, breakDown, name, exponent);
    case StateLaw::Roussel:
      return fmt::format("1/{} - {}*{}*shear_rate", time, breakDown, name);
  }
  return {};
}

double MaterialState::lowest() const { return law == StateLaw::Expression ? least : 0; }

double MaterialState::highest() const {
  return law == StateLaw::KamalSourour ? mostConversion : law == StateLaw::Houska ? 1 : most;
}

std::string Gelling::text() const {
  return fmt::format("{0} < {1} ? min(({1}/max({1}-{0},1e-300))^({2}+{3}*{0}), {4}) : {4}", state, conversion, a,
                     fmt::format("({})", b), mostFactor);
}

}  // namespace treacle
