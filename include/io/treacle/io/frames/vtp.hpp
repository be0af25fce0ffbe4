#pragma once

#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <filesystem>

namespace treacle {

/// Writes a frame as VTK XML PolyData (.vtp), appended binary with UInt64 headers: one vertex per particle,
/// point data `velocity` (3 components), `pressure`, `number_density`, `dynamic_viscosity`, `shear_rate`,
/// `material` (Int32), `id` (UInt32), as far as selected and present in the frame, and `TimeValue`. The precision
/// is that of the positions and of all real fields. Compressed arrays stand in blocks of zlib's. Returns the size
/// of the file [B]. Errors: RunError if the file cannot be written; no part of it is then left.
std::uint64_t writeVtp(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
                       OutputPrecision precision, OutputCompression compression = OutputCompression::None);

/// Reads a file of writeVtp. Errors: InputError for a missing, foreign, truncated or damaged file.
Frame readVtp(const std::filesystem::path& path);

}  // namespace treacle
