#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/motion/inflow.hpp"

#include <array>
#include <vector>

namespace treacle {

/// Unit vectors across a direction of length 1: along the width of a nozzle and, in space, along its height.
template <int D>
std::array<Vec<D>, D - 1> axesAcross(const Nozzle& nozzle, const Vec<D>& direction);

/// Area of the opening of a nozzle in a space of N + 1 dimensions [m2; m for N = 1].
template <int N>
double areaOf(const Nozzle& nozzle);

/// The places of one layer of particles in the opening, from its centre along these axes [spacings].
template <int N>
std::vector<Vec<N>> placesAcross(const Nozzle& nozzle, double spacing);

}  // namespace treacle
