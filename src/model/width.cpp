#include "treacle/model/width.hpp"

#include "treacle/model/checks.hpp"

namespace treacle {
namespace {

double widened(double x, const Width& w) {
  if (x >= w.to) return x + (w.factor - 1) * (w.to - w.from);
  return x > w.from ? w.from + w.factor * (x - w.from) : x;
}

}  // namespace

void applyWidth(Case& c, const Width& width) {
  requireValid(width, c);
  if (width.factor == 1) return;  // to the bit
  const int k = static_cast<int>(width.axis);
  const auto widen = [&](Vec<3>& x) { x[k] = widened(x[k], width); };
  widen(c.domain.min), widen(c.domain.max);
  for (Body& body : c.bodies) {
    for (Vec<3> Shape::*x : {&Shape::min, &Shape::max, &Shape::center, &Shape::start, &Shape::end})
      widen(body.shape.*x);
    if (body.rotation) widen(body.rotation->center);
  }
}

}  // namespace treacle
