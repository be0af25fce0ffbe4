#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/any_particles.hpp"
#include "treacle/model/particles/particle_part.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// Largest number of particles of one case: an index has 32 bits, and room to count on to the end of a cluster, a
/// warp or a block.
inline constexpr std::size_t maxParticles = (std::size_t{1} << 32) - 1024;

/// Particles of one body; inflows have both.
struct BodyCount {
  std::uint32_t fluid = 0, wall = 0;

  std::uint32_t all() const { return fluid + wall; }

  bool operator==(const BodyCount&) const = default;
};

/// Lattice points of the shapes that no condition leaves any out of: createParticles needs room for at least
/// these.
double leastPoints(const Case& c);

/// Fills the case's bodies with particles on lattices of the case's spacing, where their conditions hold. A box
/// has its lattice cell-centred on its own corner `min`, a wall on the face nearer to the fluid; a sphere has a
/// lattice point at `center`, a cylinder half a spacing from `start` along the axis. Fluid first, then walls, both
/// in file order. Where bodies of the same kind overlap, the earlier one keeps the place (a particle closer than
/// half a spacing to an earlier one is left out, as is fluid inside the shape of earlier fluid). Pressure and
/// number density are 0; ids count from 0. Appends to `notes` what a user should know (a box that the spacing does
/// not divide, particles left out, a condition that never holds); `bodyCounts` takes the number of particles of
/// every body in file order. `part`: only these are made, with the ids that they have in the whole; all places are
/// looked at nevertheless, and numbers are those of the whole case, as are notes, but for those about surfaces of
/// walls, which a part does not know. Errors: InputError if there is no fluid and no inflow, if fluid and wall
/// overlap, if a particle lies outside the domain, if a wall cannot rotate in a periodic one, if there are more
/// particles than maxParticles, if an expression is not finite at a particle.
template <int D>
Particles<D> createParticles(const Case& c, std::vector<std::string>& notes,
                             std::vector<BodyCount>* bodyCounts = nullptr, ParticlePart part = {});

/// The same for the dimensions that the case has.
AnyParticles createParticles(const Case& c, std::vector<std::string>& notes,
                             std::vector<BodyCount>* bodyCounts = nullptr, ParticlePart part = {});

extern template Particles<2> createParticles<2>(const Case&, std::vector<std::string>&, std::vector<BodyCount>*,
                                                ParticlePart);
extern template Particles<3> createParticles<3>(const Case&, std::vector<std::string>&, std::vector<BodyCount>*,
                                                ParticlePart);

}  // namespace treacle
