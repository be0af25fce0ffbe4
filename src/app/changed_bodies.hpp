#pragma once

#include "resume.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// Fits a state to a case with other bodies than those of the run, which are known by their names: takes out the
/// particles of bodies that the case no longer has, puts in those of bodies that it has beside them, and gives all
/// particles new ids. Bodies that stay must have as many wall particles as in the run; what shapes fluid has had
/// does not matter. `created`: the particles that the case starts with. Appends to `notes` what has changed.
/// Errors: InputError for open flows, for a part of a state, for a body that stays with other particles, and for
/// one that is added where fluid is.
template <int D>
void changeBodies(const Case& c, const std::filesystem::path& file, const MadeParticles& made,
                  const Particles<D>& created, Checkpoint<D>& state, std::vector<std::string>& notes);

extern template void changeBodies<2>(const Case&, const std::filesystem::path&, const MadeParticles&,
                                     const Particles<2>&, Checkpoint<2>&, std::vector<std::string>&);
extern template void changeBodies<3>(const Case&, const std::filesystem::path&, const MadeParticles&,
                                     const Particles<3>&, Checkpoint<3>&, std::vector<std::string>&);

}  // namespace treacle
