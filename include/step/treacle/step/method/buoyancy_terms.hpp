#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/motion/frame_force.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// By how much the weight of a fluid per volume follows its temperature and volume, by Boussinesq's approximation:
/// its inertia is that of its density.
struct ExpansionTable {
  double rho[maxMaterials] = {};        // [kg/m3]
  double perKelvin[maxMaterials] = {};  // rho beta [kg/(m3 K)]
  double reference[maxMaterials] = {};  // the temperature at which the density is rho [K]

  static ExpansionTable make(const Case& c) {
    ExpansionTable table;
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      const Material& of = c.materials[m];
      table.rho[m] = of.density;
      table.perKelvin[m] = of.density * of.thermalExpansion;
      if (c.heat) table.reference[m] = of.expansionTemperature > 0 ? of.expansionTemperature : c.heat->ambient;
    }
    return table;
  }

  /// What is added to the density of material m at T [K] with v times its volume, [kg/m3].
  TREACLE_HD double density(int m, double T, double v) const {
    return rho[m] * (1 / v - 1) - perKelvin[m] * (T - reference[m]);
  }
};

/// What acts on own fluid particles. Spans are in the backend's memory.
template <int D>
struct Buoyancy {
  ExpansionTable table;
  FrameForce<D> frame;
  std::span<const std::uint8_t> material;
  std::span<const Vec<D>> position;     // [m]
  std::span<const double> temperature;  // at the start of the step [K]; empty: there is none
  std::span<const double> volume{};     // by which volumes are multiplied [-]; empty: 1

  TREACLE_HD bool acts() const { return !temperature.empty() || !volume.empty(); }
  /// Of particle i [N/m3].
  TREACLE_HD Vec<D> on(std::size_t i) const {
    const double T = temperature.empty() ? 0 : temperature[i], v = volume.empty() ? 1 : volume[i];
    return frame.onFurther(position[i], table.density(material[i], T, v));
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
