#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstdint>

namespace treacle {

/// Errors: InputError for a case that processes cannot share so far, with what it would have to be.
void requireShareable(const Case& c, BackendKind backend);

/// `filled`: search cells with fluid in them, the parts that it can be divided into. Errors: InputError for more
/// processes than these, most of which would never have anything to do; where fluid comes in they may have.
void requireCells(const Case& c, std::uint64_t filled, int processes);
/// The same where each of the processes has `some` of the particles, whichever. Collective; all throw.
template <int D>
void requireCells(const Case& c, const CellGrid<D>& grid, const Particles<D>& some, const Communicator& processes);

}  // namespace treacle
