#include "treacle/io/picture/picture.hpp"

#include "limited_files.hpp"
#include "picture/color_map.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

using namespace treacle;
using namespace treacle::test;
namespace fs = std::filesystem;

namespace {

/// A picture read back.
class Png {
 public:
  explicit Png(const fs::path& path)
      : surface_(cairo_image_surface_create_from_png(path.c_str()), &cairo_surface_destroy) {
    EXPECT_EQ(cairo_surface_status(surface_.get()), CAIRO_STATUS_SUCCESS) << path;
  }
  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }

  std::array<int, 3> at(int x, int y) const {
    const unsigned char* row =
        cairo_image_surface_get_data(surface_.get()) + y * cairo_image_surface_get_stride(surface_.get());
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, row + 4 * x, 4);
    return {int(pixel >> 16 & 0xff), int(pixel >> 8 & 0xff), int(pixel & 0xff)};
  }

  /// Pixels left of the colour bar (x < limit) within 3 of the colour.
  int count(Rgb color, int limit) const {
    const std::array<double, 3> wanted{255 * color.red, 255 * color.green, 255 * color.blue};
    int found = 0;
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < limit; ++x) {
        const auto pixel = at(x, y);
        bool same = true;
        for (std::size_t k = 0; k < 3; ++k) same = same && std::abs(pixel[k] - wanted[k]) <= 3;
        found += same;
      }
    return found;
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
};

constexpr double pictureSpacing = 1e-3;  // [m]
constexpr Rgb wallGrey{0.80, 0.80, 0.82};

/// Lattice of particles on [from, to), all with the speed of their half: left 0, right 1 m/s.
Frame block(int dimensions, Vec<3> from, Vec<3> to) {
  Frame frame;
  frame.dimensions = dimensions;
  const auto cells = [&](int k) {
    return k < dimensions ? int(std::lround((to[k] - from[k]) / pictureSpacing)) : 1;
  };
  for (int c = 0; c < cells(2); ++c)
    for (int b = 0; b < cells(1); ++b)
      for (int a = 0; a < cells(0); ++a) {
        Vec<3> x = from;
        const std::array<int, 3> cell{a, b, c};
        for (int k = 0; k < dimensions; ++k) x[k] += (cell[static_cast<std::size_t>(k)] + 0.5) * pictureSpacing;
        frame.position.push_back(x);
        frame.velocity.push_back({0, a < cells(0) / 2 ? 0.0 : 1.0, 0});
        frame.pressure.push_back(-5 + 10 * (a % 2));
      }
  return frame;
}

PictureOptions options() {
  PictureOptions o;
  o.spacing = pictureSpacing;
  o.title = "Test";
  return o;
}

}  // namespace

TEST(Picture, PlaneHasTheColoursAtTheirPlaces) {
  TemporaryDirectory directory;
  // Fluid 20 x 10 above a floor of 20 x 4 spacings.
  drawFrame(directory / "a.png", block(2, {0, 0, 0}, {0.02, 0.01, 0}), block(2, {0, -0.004, 0}, {0.02, 0, 0}),
            options());
  const Png png(directory / "a.png");
  EXPECT_EQ(png.width(), 1200);
  // Same scale both ways: 1200 less the margins, times 14 / 20, and the margins above and below.
  const double scale = (1200 - 100 - 190) / 20.0;  // [px per spacing]
  EXPECT_NEAR(png.height(), 70 + 14 * scale + 85, 1);
  const auto pixel = [&](double x, double y) { return png.at(int(100 + x * scale), int(70 + (10 - y) * scale)); };
  const auto expectColor = [](std::array<int, 3> found, Rgb wanted) {
    EXPECT_NEAR(found[0], 255 * wanted.red, 1.5);
    EXPECT_NEAR(found[1], 255 * wanted.green, 1.5);
    EXPECT_NEAR(found[2], 255 * wanted.blue, 1.5);
  };
  expectColor(pixel(0.5, 0.5), viridis(0));
  expectColor(pixel(9.5, 9.5), viridis(0));
  expectColor(pixel(10.5, 0.5), viridis(1));
  expectColor(pixel(19.5, 9.5), viridis(1));
  expectColor(pixel(3.5, -1.5), wallGrey);
  expectColor(pixel(5.02, 5.02), {1, 1, 1});  // between four discs
}

TEST(Picture, CoversTheAreaOfTheParticles) {
  TemporaryDirectory directory;
  // So many that a disc is about a pixel: the fluid must look solid.
  Frame fluid = block(2, {0, 0, 0}, {0.5, 0.5, 0});
  PictureOptions o = options();
  o.width = 600;
  drawFrame(directory / "a.png", fluid, {}, o);
  const Png png(directory / "a.png");
  const double side = 600 - 290 * 0.5;  // [px]
  EXPECT_GT(png.count(viridis(0), 520), 0.97 * side * side / 2);
  EXPECT_GT(png.count(viridis(1), 520), 0.96 * side * side / 2);
}

TEST(Picture, SpaceShowsFluidInFrontOfWalls) {
  TemporaryDirectory directory;
  const Frame fluid = block(3, {0, 0, 0}, {0.02, 0.02, 0.02});
  const Frame floor = block(3, {-0.01, -0.01, -0.004}, {0.03, 0.03, 0});
  // A wall between the fluid and the viewer, who is at large x, small y, large z.
  const Frame hiding = block(3, {-0.01, -0.014, 0}, {0.03, -0.01, 0.03});
  Frame walls = floor;
  walls.position.insert(walls.position.end(), hiding.position.begin(), hiding.position.end());

  const auto fluidPixels = [&](const Frame& w) {
    PictureOptions o = options();
    o.gravity = {0, 0, -9.81};
    drawFrame(directory / "a.png", fluid, w, o);
    const Png png(directory / "a.png");
    EXPECT_EQ(png.width(), 1200);
    int colored = 0;
    for (int y = 75; y < png.height(); ++y)
      for (int x = 100; x < 900; ++x) {
        const auto [r, g, b] = png.at(x, y);
        colored += std::max({r, g, b}) - std::min({r, g, b}) > 25;
      }
    return colored;
  };
  const int withFloor = fluidPixels(floor);
  EXPECT_GT(withFloor, 50000);
  EXPECT_GT(fluidPixels(walls), 0.6 * withFloor);  // smaller scale, but not hidden
}

TEST(Picture, PressureAndRange) {
  TemporaryDirectory directory;
  const Frame fluid = block(2, {0, 0, 0}, {0.01, 0.01, 0});
  PictureOptions o = options();
  o.field = PictureField::Pressure;
  drawFrame(directory / "a.png", fluid, {}, o);
  EXPECT_GT(Png(directory / "a.png").count(viridis(0), 900), 100000);
  EXPECT_GT(Png(directory / "a.png").count(viridis(1), 900), 100000);
  o.minimum = -15;
  o.maximum = 5;
  drawFrame(directory / "b.png", fluid, {}, o);
  EXPECT_EQ(Png(directory / "b.png").count(viridis(0), 900), 0);
  EXPECT_GT(Png(directory / "b.png").count(viridis(0.5), 900), 100000);
}

TEST(Picture, OddFramesAreDrawn) {
  TemporaryDirectory directory;
  Frame resting = block(2, {0, 0, 0}, {0.01, 0.01, 0});
  for (auto& u : resting.velocity) u = {};
  EXPECT_NO_THROW(drawFrame(directory / "rest.png", resting, {}, options()));

  Frame broken = block(3, {0, 0, 0}, {0.01, 0.01, 0.01});
  broken.position[3][1] = std::numeric_limits<double>::quiet_NaN();
  broken.velocity[4][0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(drawFrame(directory / "broken.png", broken, {}, options()), 1u);
  broken.position[5][0] = 1e300;
  broken.pressure[0] = -1e308, broken.pressure[1] = 1e308, broken.pressure[2] = 5e-324;
  PictureOptions pressure = options();
  pressure.field = PictureField::Pressure;
  EXPECT_EQ(drawFrame(directory / "broken.png", broken, broken, pressure), 4u);

  Frame single = block(3, {0, 0, 0}, {0.001, 0.001, 0.001});
  EXPECT_NO_THROW(drawFrame(directory / "single.png", single, {}, options()));
  EXPECT_NO_THROW(drawFrame(directory / "tall.png", block(2, {0, 0, 0}, {0.001, 0.3, 0}), {}, options()));
  EXPECT_LT(Png(directory / "tall.png").height(), 1300);
  EXPECT_NO_THROW(drawFrame(directory / "flat.png", block(2, {0, 0, 0}, {0.3, 0.001, 0}), {}, options()));
  EXPECT_GT(Png(directory / "flat.png").height(), 300);
}

TEST(Picture, BadRequests) {
  TemporaryDirectory directory;
  Frame fluid = block(2, {0, 0, 0}, {0.01, 0.01, 0});
  const auto path = directory / "a.png";
  const auto messageFor = [&](const PictureOptions& o) {
    return messageOf<InputError>([&] { drawFrame(path, fluid, {}, o); });
  };
  PictureOptions o = options();
  o.field = PictureField::NumberDensity;
  EXPECT_NE(messageFor(o).find("number_density"), std::string::npos);
  o.field = PictureField::NearestDistance;
  EXPECT_NE(messageFor(o).find("nearest_distance"), std::string::npos);
  o = options();
  o.spacing = 0;
  EXPECT_NE(messageFor(o).find("spacing"), std::string::npos);
  o = options();
  o.width = 10;
  EXPECT_NE(messageFor(o).find("width"), std::string::npos);
  EXPECT_THROW(drawFrame(path, Frame{}, Frame{}, options()), InputError);
  EXPECT_FALSE(fs::exists(path));
}

TEST(Picture, FullDiskLeavesNoFile) {
  TemporaryDirectory directory;
  const Frame fluid = block(2, {0, 0, 0}, {0.02, 0.02, 0});
  EXPECT_TRUE(withFileLimit(2000, [&] {
    const std::string message = messageOf<RunError>([&] { drawFrame(directory / "a.png", fluid, {}, options()); });
    return message.find("File too large") != message.npos;
  }));
  EXPECT_TRUE(fs::is_empty(directory.path()));
}
