#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/mph/surface_tension.hpp"
#include "treacle/step/method/buoyancy_terms.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// What active particles add to the powers of a step, per volume of a particle. Spans are in the backend's memory;
/// those of walls start with the first wall particle.
template <int D>
struct PowerTerms {
  enum { Shear, Bulk, Inertial, Elastic, ElasticEnergy, Repulsion, Shift, Force, SurfaceEnergy, Buoyant, count };

  std::uint32_t fluidCount, ownFluid;  // fluid from ownFluid on is other processes'
  MaterialTable materials;
  BulkShare bulkShare;
  std::span<const std::uint8_t> material;
  std::span<const Vec<D>> before, after;   // u^k of the fluid, u^{k+1} of all [m/s]
  std::span<const double> divergence;      // C^T u^{k+1} [1/s]
  std::span<const double> elastic;         // elasticPressure() [Pa]
  std::span<const double> shear;           // of the fluid [W/m3]
  std::span<const double> wallDivergence;  // the fluid's parts of C^T u and n at walls
  std::span<const double> wallDensity;
  std::span<const double> repulsion;              // what it gives to the fluid [W/m3], or empty
  std::span<const Vec<D>> force;                  // of ExplicitForces, on walls, too [N/m3], or empty
  std::span<const SurfaceSlope<D>> surfaceSlope;  // surface_tension.hpp; or empty
  std::span<const Vec<D>> transport;              // what own fluid goes with, if that is not `after` [m/s]
  std::span<const Vec<D>> position;               // [m]
  FrameForce<D> frame;
  double velocityStep;  // dt of the inertia [s]
  Buoyancy<D> buoyancy;

  /// Pairs of walls do no work on the fluid, and what they are compressed by without fluid it cannot get back.
  TREACLE_HD void add(std::size_t i, double* sums) const {
    const int m = material[i];
    const bool fluid = i < fluidCount;
    const double worked = fluid ? divergence[i] : wallDivergence[i - fluidCount];
    sums[Bulk] += bulkShare.of(i) * materials.bulkViscosity[m] * divergence[i] * worked;
    sums[Elastic] -= elastic[i] * worked;
    if (elastic[i] > 0) {
      const double kappa = materials.bulkModulus[m], strain = elastic[i] / kappa;
      const double without = fluid ? 0 : strain - wallDensity[i - fluidCount];
      sums[ElasticEnergy] += 0.5 * kappa * (strain * strain - (without > 0 ? without * without : 0));
    }
    if (!force.empty()) sums[Force] += dot(force[i], after[i]);
    if (!fluid) return;
    sums[Shear] += shear[i];
    if (buoyancy.acts()) sums[Buoyant] += dot(buoyancy.on(i), after[i]);
    if (!repulsion.empty()) sums[Repulsion] += repulsion[i];
    if (!transport.empty())
      sums[Shift] -= dot(frame.on(position[i], materials.inertia[m] * velocityStep), transport[i] - after[i]);
    if (!surfaceSlope.empty()) sums[SurfaceEnergy] += surfaceEnergyShare * norm2(surfaceSlope[i].m);
    sums[Inertial] += 0.5 * materials.inertia[m] * norm2(after[i] - frame.turned(before[i]));
  }
};

/// Sums over active particles [0, active), in an order that depends on their number alone; of all processes.
template <int D, class Backend>
std::array<double, PowerTerms<D>::count> sumPowers(Context<Backend>&, const PowerTerms<D>&, std::size_t active);

/// What a body bears, per volume of a particle.
struct LoadSums {
  Vec<3> force, torque;  // [N/m3], [N/m2]; the torque about the origin
  double power;          // of the fluid on the body [W/m3]
};

/// What active wall particles add to it; spans in the backend's memory, all of the same length.
template <int D>
struct LoadTerms {
  static constexpr int count = sizeof(LoadSums) / sizeof(double);

  std::span<const std::uint8_t> body;
  std::span<const Vec<D>> position, velocity;  // [m], [m/s]
  std::span<const Vec<D>> force;               // [N/m3]
  std::span<const Vec<3>> couple;              // [N/m2], or empty
  std::span<const WallMotion<D>> motion;       // per body; empty: none turns

  TREACLE_HD void add(std::size_t i, double* sums) const {
    const Vec<3> f = resized<3>(force[i]);
    Vec<3> torque = cross(resized<3>(position[i]), f);
    if (!couple.empty()) torque += couple[i];
    for (int k = 0; k < 3; ++k) {
      sums[k] += f[k];
      sums[3 + k] += torque[k];
    }
    sums[6] += dot(force[i], velocity[i]);
    if (!couple.empty() && !motion.empty()) sums[6] += dot(couple[i], motion[body[i]].spin);
  }
};

/// Per body, in an order that depends on the number of wall particles alone. Errors: none, body < bodies.
template <int D, class Backend>
std::vector<LoadSums> sumLoads(Context<Backend>&, const LoadTerms<D>&, std::size_t bodies);

}  // namespace treacle
