#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

/// How the viscosity of a generalised Newtonian fluid follows the shear rate gamma = sqrt(2 E:E).
enum class RheologyModel { PowerLaw, Cross, CarreauYasuda, Bingham, HerschelBulkley, Casson };

/// Constants of such a fluid; each model has some of them (docs/rheology.md).
struct Rheology {
  RheologyModel model = RheologyModel::PowerLaw;
  double consistency = 0;        // K [Pa s^n]
  double flowIndex = 1;          // n
  double yieldStress = 0;        // tau_y [Pa]
  double plasticViscosity = 0;   // mu_p [Pa s]
  double regularisation = 0;     // m of Papanastasiou [s]
  double zeroViscosity = 0;      // mu_0, at rest [Pa s]
  double infiniteViscosity = 0;  // mu_inf, of infinitely fast shear [Pa s]
  double timeConstant = 0;       // k [s]
  double transition = 2;         // a of Yasuda
  double leastViscosity = 0;     // bound on what the model gives [Pa s]
  double mostViscosity = 0;      // likewise; 0: none [Pa s]

  bool operator==(const Rheology&) const = default;

  /// Whether the model has a yield stress, and whether it has a flow index.
  bool yields() const {
    return model == RheologyModel::Bingham || model == RheologyModel::HerschelBulkley ||
           model == RheologyModel::Casson;
  }
  bool hasIndex() const { return model != RheologyModel::Bingham && model != RheologyModel::Casson; }

  /// Of a Newtonian fluid: a Bingham fluid that does not yield.
  static Rheology newtonian(double viscosity) {
    return {.model = RheologyModel::Bingham, .plasticViscosity = viscosity};
  }

  /// mu(gamma) [Pa s], at a shear rate of at least 0 [1/s]. Yield stresses are regularised (T. C. Papanastasiou,
  /// J. Rheol. 31, 1987): tau_y / gamma is multiplied by 1 - exp(-m gamma), so that the fluid at rest has the
  /// viscosity tau_y m besides that of its flow. `shift`: a_T of the temperature (viscosity_shift.hpp); the bounds
  /// hold at all temperatures. `yield`: by what the yield stress is multiplied.
  TREACLE_HD double viscosity(double rate, double shift = 1, double yield = 1) const {
    const double mu = shift * unbounded(shift * rate, yield * yieldStress);
    const double below = mostViscosity > 0 && !(mu < mostViscosity) ? mostViscosity : mu;
    return below > leastViscosity ? below : leastViscosity;
  }

  /// The shear rate that the next solve takes the viscosity of, after one with the viscosity of `last` has given
  /// `found`. A fluid that thickens answers more viscosity with less shear and would swing: with the exponent
  /// 2/(1+n) what is left of an error, wherever between stress and shear rate the flow is prescribed, is at most
  /// (n-1)/(n+1) of it.
  TREACLE_HD double nextRate(double last, double found) const {
    if (!(flowIndex > 1 && last > 0 && found > 0)) return found;
    const double share = 2 / (1 + flowIndex);
    return std::pow(last, 1 - share) * std::pow(found, share);
  }

 private:
  /// (1 - exp(-x)) / x
  TREACLE_HD static double grown(double x) { return x > 1e-9 ? -std::expm1(-x) / x : 1; }

  TREACLE_HD double unbounded(double rate, double stress) const {
    switch (model) {
      case RheologyModel::PowerLaw:
        return power(rate);
      case RheologyModel::Cross:
        return between(1 / (1 + std::pow(timeConstant * rate, 1 - flowIndex)));
      case RheologyModel::CarreauYasuda:
        return between(std::pow(1 + std::pow(timeConstant * rate, transition), (flowIndex - 1) / transition));
      case RheologyModel::Bingham:
        return plasticViscosity + stress * regularisation * grown(regularisation * rate);
      case RheologyModel::HerschelBulkley:
        return power(rate) + stress * regularisation * grown(regularisation * rate);
      case RheologyModel::Casson: {
        const double root = std::sqrt(plasticViscosity) +
                            std::sqrt(stress * regularisation) * grown(std::sqrt(regularisation * rate));
        return root * root;
      }
    }
    return 0;
  }
  TREACLE_HD double power(double rate) const { return consistency * std::pow(rate, flowIndex - 1); }
  TREACLE_HD double between(double share) const {
    return infiniteViscosity + (zeroViscosity - infiniteViscosity) * share;
  }
};

}  // namespace treacle
