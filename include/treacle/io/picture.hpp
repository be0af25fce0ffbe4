#pragma once

#include "treacle/io/convergence.hpp"
#include "treacle/io/frame.hpp"
#include "treacle/io/history.hpp"
#include "treacle/io/probe_table.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
  ShearRate
};

struct PictureOptions {
  PictureField field = PictureField::Speed;
  double spacing = 0;  // particle spacing: the diameter of the discs [m]
  Vec<3> gravity{};    // 3D: its main axis points down in the picture [m/s2]
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

/// Draws iterations, energies, extents and largest speed over time as PNG.
/// Values that are not finite are left out. Errors: InputError if there are no rows; RunError if the file cannot
/// be written.
void drawHistory(const std::filesystem::path& path, const std::vector<HistoryRow>& rows,
                 const std::string& title = {});

/// Draws what a probe has read as PNG: of a line the profiles at some times, of a plane its last state, coloured
/// by the field of the options, of all others curves over time. `options.spacing`: that of the case. Errors:
/// InputError if it has read nothing, or nothing of the field; RunError if the file cannot be written.
void drawProbe(const std::filesystem::path& path, const ProbeTable& table, const Probe& probe,
               const PictureOptions& options);

/// Draws residuals over iterations as PNG, on a logarithmic axis, one curve per solver; below it their names with
/// iterations and milliseconds. Residuals that are zero or not finite are left out. `remark`: at the right of the
/// title. Errors: InputError if there is no curve; RunError if the file cannot be written.
void drawConvergence(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves,
                     const std::string& title = {}, const std::string& remark = {});

}  // namespace treacle
