#pragma once

#include "treacle/io/frames/frame.hpp"
#include "treacle/model/case/output_settings.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// The surface of the fluid in a frame, as triangles that enclose it: where half of space is filled. Of a lattice
/// that is half a spacing outside of its outermost particles. Also where the fluid touches walls, and at periodic
/// ends.
struct FreeSurface {
  struct Field {
    std::string name;    // as in frames
    int components = 1;  // 1 or 3
    std::vector<float> values;
  };

  double time = 0;                                      // [s]
  std::vector<Vec<3, float>> points;                    // [m]
  std::vector<Vec<3, float>> normals;                   // unit vectors at the points, out of the fluid
  std::vector<std::array<std::uint32_t, 3>> triangles;  // points, anticlockwise as seen from outside
  std::vector<Field> fields;           // of the fluid at the points, those of the frame that are reals
  std::vector<std::int32_t> material;  // of the particle that is most of it; empty: the frame has none
  std::size_t leftOut = 0;             // particles that lie nowhere, or absurdly far away
};

/// Whether surfaces can be made: the build needs OpenVDB, which is loaded here.
bool hasFreeSurface();
/// What to say where it cannot.
std::string whyNoFreeSurface();

/// `spacing` of the particles [m]; `node`: edge of the grid's cells in spacings, 1/4 to 1. Three dimensions only.
/// Errors: InputError for two, and where the build cannot; std::bad_alloc.
FreeSurface freeSurface(const Frame& fluid, double spacing, double node = 0.5);

enum class SurfaceFormat { Vtp, Ply };

/// VTK XML PolyData with fields and `normal` as point data. Returns the size of the file [B], as the next one.
/// Errors: RunError if the file cannot be written.
std::uint64_t writeSurfaceVtp(const std::filesystem::path& path, const FreeSurface& surface,
                              OutputCompression compression);

/// Binary PLY; vectors are three properties, `velocity_x` and so on. Errors likewise.
std::uint64_t writeSurfacePly(const std::filesystem::path& path, const FreeSurface& surface);

}  // namespace treacle
