#include "treacle/model/case/width.hpp"

#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/checks.hpp"

#include <fmt/format.h>
#include <string>
#include <string_view>

namespace treacle {
namespace {

double widened(double x, const Width& w) {
  if (x >= w.to) return x + (w.factor - 1) * (w.to - w.from);
  return x > w.from ? w.from + w.factor * (x - w.from) : x;
}

/// What is turned, or comes from a file, cannot be made wider at some coordinates.
void requireCoordinates(const Body& body) {
  const auto fail = [&](std::string_view key, std::string_view what) {
    throw CaseError({"body", body.name, std::string(key)},
                    fmt::format("found {}, which no width can change; expected a width.factor of 1", what));
  };
  if (body.shape.transform) fail("transform", "a transform");
  if (body.shape.kind == ShapeKind::Mesh || body.shape.kind == ShapeKind::Particles) fail("file", "a file");
}

}  // namespace

void applyWidth(Case& c, const Width& width) {
  requireValid(width, c);
  if (width.factor == 1) return;  // to the bit
  for (const Body& body : c.bodies) requireCoordinates(body);
  const int k = static_cast<int>(width.axis);
  const auto widen = [&](Vec<3>& x) { x[k] = widened(x[k], width); };
  widen(c.domain.min), widen(c.domain.max);
  for (Body& body : c.bodies) {
    for (Vec<3> Shape::*x : {&Shape::min, &Shape::max, &Shape::center, &Shape::start, &Shape::end})
      widen(body.shape.*x);
    for (Vec<2>& x : body.shape.points)
      if (k < 2) x[k] = widened(x[k], width);
    if (k == 2)
      body.shape.bottom = widened(body.shape.bottom, width), body.shape.top = widened(body.shape.top, width);
    if (body.rotation) widen(body.rotation->center);
  }
}

}  // namespace treacle
