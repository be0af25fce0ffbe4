#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/materials/pressed_particle.hpp"
#include "treacle/model/materials/rheology_table.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

// What lets fluid under pressure take long steps (docs/accurate.md). A particle that is out of place is driven
// back by the pressure p around it, like by a spring. The forces of a step are those of its start, and so the
// spring is explicit: where p dt is large against R of PressedParticle, it carries the particle beyond its place.
// The particle then has a viscosity in proportion to p dt beside its own, of which the step gives back what
// resists smooth flow (StepStiffness).

/// What it takes of the materials.
struct StiffMaterials {
  double density[maxMaterials] = {};    // [kg/m3]
  double viscosity[maxMaterials] = {};  // where it is a constant [Pa s]

  static StiffMaterials make(const Case& c);
};

/// What setStiffness() finds of the fluid of all processes.
struct StiffFluid {
  double particles;  // that have such a viscosity
  double way;        // how far the pressure carries a particle in the step, in the mean, in spacings
};

/// Spans are per own fluid particle in the backend's memory.
struct StiffnessTerms {
  StiffMaterials materials;
  RheologyTable table;  // where particles have viscosities of their own; without what is implicit
  StiffnessLimits limits;
  double spacing, timeStep;  // [m], [s]
  std::span<const std::uint8_t> material;
  std::span<const double> rate;      // shear rates of these viscosities [1/s]; empty: those of the materials
  std::span<const double> pressure;  // of the last step [Pa]
  std::span<double> viscosity;       // [Pa s]

  static constexpr int count = 3;

  /// Sets the viscosity of particle i. Sums: 1 if that is not zero, its way, 1.
  TREACLE_HD void add(std::size_t i, double* sums) const {
    const int m = material[i];
    const double mu = rate.empty() ? materials.viscosity[m] : table.viscosity(i, m, rate[i]);
    const PressedParticle particle{materials.density[m], mu, spacing, timeStep};
    viscosity[i] = limits.viscosity(particle, pressure[i]);
    if (viscosity[i] > 0) sums[0] += 1;
    if (pressure[i] > 0) sums[1] += particle.way(pressure[i]);
    sums[2] += 1;
  }
};

template <class Backend>
StiffFluid setStiffness(Context<Backend>&, const StiffnessTerms&);

/// scale *= 1 + viscosity / mu of own particles whose viscosity is that of their material.
struct StiffScale {
  StiffMaterials materials;
  std::span<const std::uint8_t> material;
  std::span<const double> viscosity;  // of StiffnessTerms [Pa s]
  std::span<double> scale, sum;       // MphPairs::viscosityScale; both viscosities together [Pa s]

  TREACLE_HD void set(std::size_t i) const {
    const double mu = materials.viscosity[material[i]];
    sum[i] = mu + viscosity[i];
    if (mu > 0) scale[i] *= sum[i] / mu;
  }
};
template <class Backend>
void setStiffScale(Context<Backend>&, const StiffScale&);

/// Sets the part of MphPairs::viscosityScale that the additional viscosity has. It is never quite zero, because
/// pairs take a particle whose scale is zero for a wall.
struct GivenScale {
  std::span<const double> viscosity, sum, scale;  // as above
  std::span<double> given;

  TREACLE_HD void set(std::size_t i) const {
    const double part = sum[i] > 0 ? scale[i] * viscosity[i] / sum[i] : 0;
    given[i] = part > 1e-200 ? part : 1e-200;
  }
};
template <class Backend>
void setGivenScale(Context<Backend>&, const GivenScale&);

/// force_i -= what pairs of a viscosity resist where the velocity has the gradient L [N/m3]: those of fluid where
/// d L d is the mean of both particles', with walls that of the fluid particle. `pairs`: with what is given in
/// place of the viscosity scale; `gradient`: per fluid particle, ghosts included [1/s]. Pairs give equal and
/// opposite forces along d.
template <int D, class Backend>
void giveBack(Context<Backend>&, const MphPairs<D>& pairs, std::span<const Block<D>> gradient,
              std::span<Vec<D>> force);
/// The same of the wall particles of a list, from the first wall particle on.
template <int D, class Backend>
void giveBackOnWalls(Context<Backend>&, const MphPairs<D>& pairs, const ClusterListView& walls,
                     std::span<const Block<D>> gradient, std::span<Vec<D>> force);

}  // namespace treacle
