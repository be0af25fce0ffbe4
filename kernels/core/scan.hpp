#pragma once

#include "treacle/core/cuda.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// value[k] = value[0] + … + value[k-1] of the values before. For 32- and 64-bit numbers.
template <class Count>
void sumBefore(Context<Cuda>& context, std::span<Count> value);
/// The same with value[k] itself.
void sumUpTo(Context<Cuda>& context, std::span<std::uint64_t> value);

/// Turns the number of entries of each row, rowStart[0 … rows-1], into the start of each row and the end,
/// rowStart[rows]. Returns the end; the host waits for it.
template <class Count>
Count startRows(Context<Cuda>& context, Buffer<Count, Cuda>& rowStart) {
  Count* end = rowStart.data() + rowStart.size() - 1;
  clearBytes(context, end, sizeof(Count));  // read, though it does not count
  sumBefore(context, rowStart.span());
  return valueOnHost(context, end);
}

}  // namespace treacle
