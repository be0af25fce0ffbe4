#pragma once

#include "treacle/model/case/case.hpp"

#include <cstdint>

namespace treacle {

/// Cells that a case is divided into to look for gas.
std::uint64_t gasCells(const Case& c);

}  // namespace treacle
