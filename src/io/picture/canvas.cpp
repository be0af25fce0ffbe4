#include "canvas.hpp"

#include "treacle/core/error.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <numbers>

#ifdef __SANITIZE_ADDRESS__
// Fontconfig keeps its patterns by encoded pointers, which the leak checker cannot follow.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

namespace treacle {

namespace {

std::uint32_t mixed(std::uint32_t below, Rgb color, double coverage) {
  const auto channel = [&](int shift, double value) {
    const double old = (below >> shift) & 0xff;
    const double sum = old + coverage * (255 * std::clamp(value, 0.0, 1.0) - old);
    return static_cast<std::uint32_t>(sum + 0.5) << shift;
  };
  return channel(16, color.red) | channel(8, color.green) | channel(0, color.blue);
}

struct PngSink {
  AtomicFile file;
  std::exception_ptr error;
};

/// Exceptions must not pass through Cairo's C frames.
cairo_status_t takeBytes(void* closure, const unsigned char* data, unsigned int length) {
  PngSink& sink = *static_cast<PngSink*>(closure);
  try {
    sink.file.write(data, length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    sink.error = std::current_exception();
    return CAIRO_STATUS_WRITE_ERROR;
  }
}

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
  const cairo_status_t status = cairo_status(context_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw RunError(fmt::format("picture of {} x {} pixels: {}", width, height, cairo_status_to_string(status)));
  rectangle({0, 0}, {double(width), double(height)}, {1, 1, 1});
}

void Canvas::line(const std::vector<Point>& points, Rgb color, double lineWidth, double opacity) {
  cairo_t* cr = context_.get();
  cairo_new_path(cr);
  for (const Point& p : points) cairo_line_to(cr, p.x, p.y);
  cairo_set_source_rgba(cr, color.red, color.green, color.blue, opacity);
  cairo_set_line_width(cr, lineWidth);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cr);
}

void Canvas::rectangle(Point topLeft, Point size, Rgb color) {
  cairo_rectangle(context_.get(), topLeft.x, topLeft.y, size.x, size.y);
  cairo_set_source_rgb(context_.get(), color.red, color.green, color.blue);
  cairo_fill(context_.get());
}

void Canvas::frame(Point topLeft, Point size, Rgb color, double lineWidth) {
  const double right = topLeft.x + size.x, bottom = topLeft.y + size.y;
  line({topLeft, {right, topLeft.y}, {right, bottom}, {topLeft.x, bottom}, topLeft}, color, lineWidth);
}

void Canvas::font(double size, bool bold) {
  cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_.get(), size);
}

double Canvas::textWidth(const std::string& text, double size) {
  font(size, false);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Point at, const std::string& text, double size, Align align, Rgb color, bool bold, bool turned) {
  cairo_t* cr = context_.get();
  font(size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  const double share = align == Align::Left ? 0 : align == Align::Center ? 0.5 : 1;
  cairo_save(cr);
  cairo_translate(cr, at.x, at.y);
  if (turned) cairo_rotate(cr, -std::numbers::pi / 2);
  // Capitals and digits are about 0.73 of the size high; the line is centred on them whatever letters it holds.
  cairo_move_to(cr, -share * extents.x_advance, 0.365 * size);
  cairo_set_source_rgb(cr, color.red, color.green, color.blue);
  cairo_show_text(cr, text.c_str());
  cairo_restore(cr);
}

void Canvas::disc(Point center, double radius, Rgb color, double relief) {
  // Row by row; a pixel is covered by how far its centre is inside the edge. That also holds for discs of a pixel.
  const auto firstPixel = [](double v, int limit) { return int(std::clamp(std::floor(v), 0.0, double(limit))); };
  const int x0 = firstPixel(center.x - radius - 0.5, width_), x1 = firstPixel(center.x + radius + 1.5, width_);
  const int y0 = firstPixel(center.y - radius - 0.5, height_), y1 = firstPixel(center.y + radius + 1.5, height_);
  if (x0 >= x1 || y0 >= y1) return;
  cairo_surface_flush(surface_.get());
  unsigned char* bytes = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  for (int y = y0; y < y1; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(bytes + std::ptrdiff_t(y) * stride);
    for (int x = x0; x < x1; ++x) {
      const double dx = x + 0.5 - center.x, dy = y + 0.5 - center.y;
      const double coverage = std::clamp(radius + 0.5 - std::sqrt(dx * dx + dy * dy), 0.0, 1.0);
      if (coverage <= 0) continue;
      const double light = 1 - relief * (0.18 + 0.35 * (dx + dy) / (radius + 0.5));
      row[x] = mixed(row[x], color.scaled(light), coverage);
    }
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::writePng(const std::filesystem::path& path) {
  PngSink sink{AtomicFile(path), nullptr};
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface_.get(), takeBytes, &sink);
  if (sink.error) std::rethrow_exception(sink.error);
  if (status != CAIRO_STATUS_SUCCESS)
    throw RunError(fmt::format("cannot write {}: {}", path.string(), cairo_status_to_string(status)));
  sink.file.commit();
}

}  // namespace treacle
