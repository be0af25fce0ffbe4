#pragma once

#include "color_map.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// Curves of one quantity; what is not finite is left out.
struct PanelCurve {
  std::string name;
  std::vector<double> x, y;  // equally many
  Rgb color;
};
struct Panel {
  std::string label, unit;
  std::vector<PanelCurve> curves;
};

/// What the curves of all panels are drawn over.
struct PanelAxis {
  std::string label, unit;
  double low = 0, high = 1;
};

inline constexpr std::array<Rgb, 8> curveColors{{{0.13, 0.36, 0.60},
                                                 {0.85, 0.42, 0.08},
                                                 {0.10, 0.50, 0.35},
                                                 {0.42, 0.20, 0.52},
                                                 {0.75, 0.15, 0.20},
                                                 {0.30, 0.62, 0.80},
                                                 {0.55, 0.45, 0.10},
                                                 {0.40, 0.40, 0.43}}};

/// A PNG with the panels below each other. Errors: RunError if it cannot be written.
void drawPanels(const std::filesystem::path& path, const std::string& title, PanelAxis axis,
                const std::vector<Panel>& panels);

}  // namespace treacle
