#pragma once

#include "treacle/io/files/atomic_file.hpp"

#include <cstdint>
#include <functional>
#include <istream>
#include <string>

namespace treacle {

/// Arrays in the appended data of VTK's XML files: their bytes behind a number of them, or in blocks that zlib has
/// compressed, behind a table of these. (VTK File Formats, kitware; all numbers are UInt64.)

/// An array as bytes. `copy(begin, end, out)` writes those from begin to end [B], by several threads at once.
struct ArrayBytes {
  std::uint64_t size = 0;  // [B]
  std::function<void(std::uint64_t begin, std::uint64_t end, char* out)> copy;
};

/// Parts that begin and end at multiples of this are asked for [B].
inline constexpr std::uint64_t vtkBlock = 1 << 18;

/// Both hold one block, the latter one per thread, and never the array. Errors: RunError, std::bad_alloc.
void appendRaw(AtomicFile& file, const ArrayBytes& array);
void appendCompressed(AtomicFile& file, const ArrayBytes& array);

/// Reads an array of `size` bytes from a stream that stands where it was appended, with `room` bytes of the file
/// from there on: calls reserve() once the file is known to have what is said to be there, and before anything
/// large is taken memory for, then sink(begin, end, bytes) for one part after the other; each begins and ends at
/// multiples of `item` [B]. Returns what is wrong, as what the array has ("5 bytes, expected 8"); empty where all
/// is well.
std::string readAppended(
    std::istream& stream, bool isCompressed, std::uint64_t size, std::uint64_t room, std::uint64_t item,
    const std::function<void()>& reserve,
    const std::function<void(std::uint64_t begin, std::uint64_t end, const char* bytes)>& sink);

}  // namespace treacle
