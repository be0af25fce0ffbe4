#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Which rows and columns of a matrix of all processes those of a process's part are; in the backend's memory.
struct JoinedRows {
  std::uint32_t rows = 0;                 // of the whole matrix
  std::uint32_t own = 0;                  // rows of a part that no other process has so many columns of
  std::span<const std::uint32_t> number;  // per row of the part: its number in the whole
};

/// The sum of the parts that the processes have of a matrix, whole and the same bits at every process. The first
/// `own` rows of a part have all columns that the whole has there; others, which are own rows of other processes,
/// may lack some. Collective.
template <int D, class Backend>
void joinRows(Context<Backend>&, const BlockCsr<D, double, Backend>& part, const JoinedRows& place,
              BlockCsr<D, double, Backend>& whole);

}  // namespace treacle
