#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/materials/rheology_table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// Integrates the states of a particle over a step, from the temperature at its start and with the shear rate of
/// its end. Spans and pointers are to own fluid in the backend's memory.
struct StateTerms {
  enum { NotFinite, Heat, count };  // sums: particles whose states are not finite; heat set free per volume [W/m3]

  RheologyTable table;
  double timeStep;  // [s]
  std::span<const std::uint8_t> material;
  std::span<const double> rate;  // [1/s]
  double* next[maxStates];       // null: there is none
  std::span<double> heating;     // what the states set free [W/m3], or empty

  TREACLE_HD void add(std::size_t i, double* sums) const {
    const int m = material[i];
    double x[StateTable::variables];
    table.variables(i, rate[i], x);
    table.states.advance(m, timeStep, x);
    double heat = 0;
    bool finite = true;
    for (int k = 0; k < maxStates; ++k) {
      if (!next[k]) continue;
      const double value = x[StateTable::FirstState + k];
      finite = finite && value - value == 0;
      heat += table.states.heat[m][k] * (value - table.state[k][i]) / timeStep;
      next[k][i] = value;
    }
    if (!finite) sums[NotFinite] += 1;
    if (heating.empty()) return;
    heating[i] = heat;
    sums[Heat] += heat;
  }
};

/// Sets all states and heats; their sums over all processes, in an order that depends on the number of particles
/// alone.
template <class Backend>
std::array<double, StateTerms::count> advanceStates(Context<Backend>&, const StateTerms& terms);

}  // namespace treacle
