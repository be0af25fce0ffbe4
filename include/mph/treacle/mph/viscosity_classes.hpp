#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/materials/material_table.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// What stands for the viscosity of a particle in the preconditioner, whose constants are numbers per class. The
/// first classes are the materials, as their walls and a single Newtonian fluid have them. Materials with a
/// rheology share the others, each in equal steps of the logarithm of what their viscosity may be; in a case of
/// several fluids all of them do, because what resists a particle is then also its neighbours' viscosity.
struct ViscosityClasses {
  static constexpr int most = 2 * static_cast<int>(maxMaterials);

  int count = 0;
  std::uint8_t material[most];
  double viscosity[most];     // [Pa s]
  bool ofNeighbours = false;  // several fluids: by what a particle's pairs resist it, not by its own viscosity

  static ViscosityClasses make(const Case& c);

  /// The class of a fluid particle of material m with the viscosity mu.
  TREACLE_HD std::uint8_t of(std::uint8_t m, double mu) const {
    const Steps& s = steps_[m];
    if (s.count == 0) return m;
    const double step = std::floor(std::log(mu / s.least) * s.perLog);
    const int bounded = step > 0 ? step < s.count ? static_cast<int>(step) : s.count - 1 : 0;
    return static_cast<std::uint8_t>(s.first + bounded);
  }

 private:
  struct Steps {
    int first = 0, count = 0;
    double least = 1, perLog = 0;  // of the lowest one [Pa s], and their number in a factor of e
  };
  Steps steps_[maxMaterials];
};

}  // namespace treacle
