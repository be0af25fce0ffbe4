#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/frame_force.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// By how much the weight of a fluid follows its temperature, by Boussinesq's approximation: its density is that
/// of its material everywhere else.
struct ExpansionTable {
  double perKelvin[maxMaterials] = {};  // rho beta [kg/(m3 K)]
  double reference[maxMaterials] = {};  // the temperature at which the density is rho [K]

  static ExpansionTable make(const Case& c) {
    ExpansionTable table;
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      const Material& of = c.materials[m];
      table.perKelvin[m] = of.density * of.thermalExpansion;
      table.reference[m] = of.expansionTemperature > 0 ? of.expansionTemperature : c.heat->ambient;
    }
    return table;
  }

  /// What is added to the density of material m at T [K], [kg/m3].
  TREACLE_HD double density(int m, double T) const { return -perKelvin[m] * (T - reference[m]); }
};

/// What acts on own fluid particles. Spans are in the backend's memory.
template <int D>
struct Buoyancy {
  ExpansionTable table;
  FrameForce<D> frame;
  std::span<const std::uint8_t> material;
  std::span<const Vec<D>> position;     // [m]
  std::span<const double> temperature;  // at the start of the step [K]; empty: no fluid expands

  /// Of particle i [N/m3].
  TREACLE_HD Vec<D> on(std::size_t i) const {
    return table.density(material[i], temperature[i]) * frame.at(position[i]);
  }
};

/// b += it.
template <int D>
struct AddBuoyancy {
  Buoyancy<D> of;
  std::span<Vec<D>> b;

  TREACLE_HD void set(std::size_t i) const { b[i] += of.on(i); }
};

}  // namespace treacle
