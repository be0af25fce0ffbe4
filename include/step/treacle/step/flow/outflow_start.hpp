#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/any_particles.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// How many of the fluid particles stand in each outflow of a case, the first that holds them, at the places of
/// the start, and then how many are at the face or in the reserve of each opening.
std::vector<std::uint64_t> fluidInOutflows(const Case& c, const AnyParticles& particles);

/// Notes fluid that leaves in the first step, and openings without fluid. `held`: the counts of all particles,
/// `fluid`: how many there are. Errors: InputError where that is all of it, and none comes in.
void noteFluidInOutflows(const Case& c, std::span<const std::uint64_t> held, std::uint64_t fluid,
                         std::vector<std::string>& notes);

}  // namespace treacle
