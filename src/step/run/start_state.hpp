#pragma once

#include "treacle/core/error.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/model/particles/particles_copy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace treacle {

/// The state that a simulation begins with, as its case wants it and where its backend computes.

template <int D>
void toBackend(Context<Cpu>&, Particles<D> host, Particles<D>& particles) {
  particles = std::move(host);
}
template <int D>
void toBackend(Context<Cuda>& context, const Particles<D>& host, Particles<D, Cuda>& particles) {
  copyToDevice(context, host, particles);
}

/// Whether the fluid has a field; it has this value where it had none.
template <int D>
void setField(bool wanted, bool FluidExtras::*has, Buffer<double> Particles<D>::*field, double value,
              Particles<D>& particles) {
  if (std::exchange(particles.has.*has, wanted) == wanted) return;
  (particles.*field).resize(wanted ? particles.fluidCount : 0);
  std::fill((particles.*field).begin(), (particles.*field).end(), value);
}

/// Temperatures are part of the state, not of its memory. Errors: InputError where they are missing.
template <int D>
void requireTemperatures(const Case& c, Particles<D>& particles) {
  if (c.heat && !particles.has.temperatures)
    throw InputError("the case has heat, but its state has no temperatures");
  if (!c.heat) setField(false, &FluidExtras::temperatures, &Particles<D>::temperature, 0, particles);
}

/// Likewise of the states of materials, which the state has in the order of the case, and of elastic modes.
template <int D>
void requireStates(const Case& c, const Particles<D>& particles) {
  if (particles.has.states != c.stateNames().size())
    throw InputError(fmt::format("the case has {} states of materials, but its particles have {}",
                                 c.stateNames().size(), particles.has.states));
  if (particles.has.elasticModes != c.elasticModes())
    throw InputError(fmt::format("the fluids of the case have {} elastic modes, but its particles have {}",
                                 c.elasticModes(), particles.has.elasticModes));
}

/// The fields that the case wants the fluid to have, and no others. Errors: those of requireTemperatures and
/// requireStates.
template <int D>
void setExtras(const Case& c, Particles<D>& particles) {
  requireTemperatures(c, particles);
  requireStates(c, particles);
  setField(c.hasOwnViscosities(), &FluidExtras::shearRates, &Particles<D>::shearRate, 0, particles);
  setField(c.hasViscosityFactors(), &FluidExtras::viscosityFactors, &Particles<D>::viscosityFactor, 1, particles);
}

/// The mass of the fluid [kg; per metre of depth in 2D].
template <int D>
double fluidMass(const Case& c, const Particles<D>& particles) {
  double density = 0;
  for (std::uint32_t i = 0; i < particles.fluidCount; ++i) density += c.materials[particles.material[i]].density;
  return density * std::pow(c.spacing, D);
}

}  // namespace treacle
