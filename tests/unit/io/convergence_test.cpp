#include "treacle/io/convergence.hpp"

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture.hpp"

#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace treacle::test {
namespace {

std::vector<ConvergenceCurve> curves() {
  return {{"cg, none, double", "iteration limit", {1, 0.5, 2e-3}, 0, 0.125},
          {"say \"cg\"", "converged", {0.1, 1e-7}, 0.25, 1e-3}};
}

/// Pixels of a picture that are near a colour, and the rows that they span.
struct Found {
  int count = 0, top = 1 << 20, bottom = -1, width = 0, height = 0;

  Found(const std::filesystem::path& path, int red, int green, int blue, int below) {
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
        cairo_image_surface_create_from_png(path.c_str()), &cairo_surface_destroy);
    EXPECT_EQ(cairo_surface_status(surface.get()), CAIRO_STATUS_SUCCESS);
    width = cairo_image_surface_get_width(surface.get()), height = cairo_image_surface_get_height(surface.get());
    for (int y = 0; y < std::min(height, below); ++y)
      for (int x = 0; x < width; ++x) {
        const unsigned char* pixel = cairo_image_surface_get_data(surface.get()) +
                                     y * cairo_image_surface_get_stride(surface.get()) + 4 * x;
        if (std::abs(pixel[2] - red) > 5 || std::abs(pixel[1] - green) > 5 || std::abs(pixel[0] - blue) > 5)
          continue;
        ++count, top = std::min(top, y), bottom = std::max(bottom, y);
      }
  }
};

TEST(Convergence, TablesHaveAFixedFormat) {
  TemporaryDirectory directory;
  writeConvergence(directory / "a.csv", curves());
  EXPECT_EQ(content(directory / "a.csv"),
            "solver,iteration,relative_residual\n"
            "\"cg, none, double\",0,1\n\"cg, none, double\",1,0.5\n\"cg, none, double\",2,0.002\n"
            "\"say \"\"cg\"\"\",0,0.1\n\"say \"\"cg\"\"\",1,1e-07\n");
  writeSolvers(directory / "b.csv", curves());
  EXPECT_EQ(
      content(directory / "b.csv"),
      "solver,outcome,iterations,relative_residual,setup_s,solve_s\n"
      "\"cg, none, double\",iteration limit,2,0.002,0,0.125\n\"say \"\"cg\"\"\",converged,1,1e-07,0.25,0.001\n");
}

TEST(Convergence, PictureHasEveryCurveOnALogarithmicAxis) {
  TemporaryDirectory directory;
  const auto path = directory / "a.png";
  drawConvergence(path, curves(), "Test", "step 1");
  const int axes = 540;  // what is below is the legend
  const Found blue(path, 33, 92, 153, axes), orange(path, 217, 107, 20, axes);
  EXPECT_EQ(blue.width, 1200);
  EXPECT_GT(blue.count, 500);
  EXPECT_GT(orange.count, 500);
  // Seven decades over 425 pixels from row 105 on: 1 to 2e-3, and 0.1 to 1e-7.
  EXPECT_NEAR(blue.top, 105, 6);
  EXPECT_NEAR(blue.bottom, 105 - 425 / 7. * std::log10(2e-3), 6);
  EXPECT_NEAR(orange.top, 105 + 425 / 7., 6);
  EXPECT_NEAR(orange.bottom, 105 + 425, 6);
  // One line of the legend per solver.
  const std::vector<ConvergenceCurve> one{curves()[0]};
  drawConvergence(path, one);
  EXPECT_EQ(Found(path, 0, 0, 0, axes).height, blue.height - 29);
}

TEST(Convergence, PictureDoesWithoutWhatALogarithmCannotShow) {
  TemporaryDirectory directory;
  const auto path = directory / "a.png";
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& residuals :
       {std::vector<double>{}, {nan}, {0}, {1}, {1, nan}, {1, 0}, {INFINITY, 1e-300}, {3, 3}}) {
    drawConvergence(path, {{"none", "not finite", residuals, 0, 0}});
    EXPECT_EQ(Found(path, 0, 0, 0, 1).width, 1200);
  }
  drawConvergence(path, {{"none", "iteration limit", std::vector<double>(20000, 0.5), 0, 0}});
  EXPECT_THROW(drawConvergence(path, {}), InputError);
}

}  // namespace
}  // namespace treacle::test
