#pragma once

#include "color_map.hpp"

#include <cairo.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace treacle {

struct Point {
  double x = 0, y = 0;  // [px], y down
};

enum class Align { Left, Center, Right };

/// A white picture to draw on. Lines and text by Cairo; discs, which come by the million, directly on the pixels.
class Canvas {
 public:
  Canvas(int width, int height);  // [px]

  int width() const { return width_; }
  int height() const { return height_; }

  void line(const std::vector<Point>& points, Rgb color, double lineWidth, double opacity = 1);
  void rectangle(Point topLeft, Point size, Rgb color);
  void frame(Point topLeft, Point size, Rgb color, double lineWidth);
  /// `at` is on the line's vertical middle. Turned: reads upwards.
  void text(Point at, const std::string& text, double size, Align align, Rgb color = {}, bool bold = false,
            bool turned = false);
  double textWidth(const std::string& text, double size);

  /// A disc with smooth edge. `relief` 0: flat; 1: shaded as a ball that is lit from the upper left.
  void disc(Point center, double radius, Rgb color, double relief = 0);

  /// Errors: RunError.
  void writePng(const std::filesystem::path& path);

 private:
  void font(double size, bool bold);

  int width_, height_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace treacle
