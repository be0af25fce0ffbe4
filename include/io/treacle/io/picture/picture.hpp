#pragma once

#include "treacle/io/frames/frame.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace treacle {

/// The field that colours the fluid; the viscosity is shown by its decimal logarithm.
enum class PictureField {
  Speed,
  Pressure,
  NumberDensity,
  NearestDistance,
  Material,
  Temperature,
  DynamicViscosity,
  ShearRate,
  State
};

struct PictureOptions {
  PictureField field = PictureField::Speed;
  std::string state{};  // the name of a State
  double spacing = 0;   // particle spacing: the diameter of the discs [m]
  Vec<3> gravity{};     // 3D: its main axis points down in the picture [m/s2]
  std::string title;
  int width = 1200;  // [px]; the height follows from the shape of what is drawn
  std::optional<double> minimum,
      maximum;  // range of the colours; default: speed from 0, otherwise that of the data
};

/// Draws one frame as PNG, without a display: fluid coloured by a field, walls grey, axes, colour bar, title,
/// time. 2D: seen along z. 3D: parallel projection from an oblique direction; of the walls only the sides that
/// face the viewer are drawn, and nothing that hides the fluid. Particles whose position is not finite, or
/// absurdly far away, are left out; returns how many. Errors: InputError if the frame does not hold the field,
/// holds no particle, or spacing or width are unusable; RunError if the file cannot be written.
std::size_t drawFrame(const std::filesystem::path& path, const Frame& fluid, const Frame& walls,
                      const PictureOptions& options);

}  // namespace treacle
