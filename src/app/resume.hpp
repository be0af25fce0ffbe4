#pragma once

#include "treacle/io/checkpoint.hpp"
#include "treacle/model/case.hpp"

#include <filesystem>

namespace treacle {

/// The state in a checkpoint file, for the case; its step counts in time steps of the case, which need
/// not be those of the interrupted run, or where these vary in length it is that of the file. `made`: the
/// particles that the case starts with. Errors: InputError if the file cannot be used, if it does not fit the case
/// (numbers of particles, materials, bodies, domain, time step).
template <int D>
Checkpoint<D> fittingState(const Case& c, const std::filesystem::path& file, const Particles<D>& made);

/// The same for a run of the case. Errors: InputError also if its time is not before the end.
template <int D>
Checkpoint<D> resumedState(const Case& c, const std::filesystem::path& file, const Particles<D>& made);

extern template Checkpoint<2> fittingState<2>(const Case&, const std::filesystem::path&, const Particles<2>&);
extern template Checkpoint<3> fittingState<3>(const Case&, const std::filesystem::path&, const Particles<3>&);
extern template Checkpoint<2> resumedState<2>(const Case&, const std::filesystem::path&, const Particles<2>&);
extern template Checkpoint<3> resumedState<3>(const Case&, const std::filesystem::path&, const Particles<3>&);

}  // namespace treacle
