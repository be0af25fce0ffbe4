#pragma once

#include "canvas.hpp"
#include "view.hpp"

#include <string>

namespace treacle {

/// Sizes of the parts of a picture that do not depend on the data.
struct Theme {
  double unit = 1;  // [px] 1/1200 of the picture's width

  double letters() const { return 19 * unit; }  // [px]
  double thin() const { return 1.3 * unit; }    // [px]
  double tick() const { return 7 * unit; }      // [px]
  Rgb ink{0.15, 0.15, 0.17};
  Rgb faint{0.55, 0.55, 0.58};
};

/// The top line of a picture. A long title gets smaller letters.
void drawHeading(Canvas& canvas, const std::string& title, const std::string& remark, const Theme& theme);

/// Frame around the box, ticks and labels of x and y outside.
void drawPlaneAxes(Canvas& canvas, const View& view, const Box& box, const Theme& theme);

/// The edges of the box behind what is inside, with ticks and labels along three of them.
void drawBoxBehind(Canvas& canvas, const View& view, const Box& box, const Upward& vertical, const Theme& theme);

/// The three edges that meet in the corner next to the viewer.
void drawBoxInFront(Canvas& canvas, const View& view, const Box& box, const Theme& theme);

}  // namespace treacle
