#pragma once

#include "treacle/method/mph_pairs.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/step/simulation.hpp"

namespace treacle {

/// Sums over the fluid particles in the order of storage.
template <int D>
Diagnostics computeDiagnostics(const Case& c, const MaterialTable& materials, const Particles<D>& particles);

}  // namespace treacle
