#include "case_width.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

struct Width {
  int axis = 0;
  double from = 0, to = 0;  // [m]
  double factor = 1;

  double at(double x) const {
    if (x >= to) return x + (factor - 1) * (to - from);
    return x > from ? from + factor * (x - from) : x;
  }

  void stretch(Vec<3>& x) const { x[axis] = at(x[axis]); }
};

int readAxis(const Section& s, int dimensions) {
  constexpr std::string_view axes[] = {"x", "y", "z"};
  const std::vector<std::string_view> words(axes, axes + dimensions);
  const std::string word = s.string("axis");
  for (int k = 0; k < dimensions; ++k)
    if (word == axes[k]) return k;
  throw s.error("axis", fmt::format("expected {}, found '{}'", listOf(words), word));
}

}  // namespace

void applyWidth(const Section& top, Case& c) {
  if (!top.has("width")) return;
  const Section s = top.section("width", "[width]", {"axis", "from", "to", "factor"});
  Width width;
  width.axis = readAxis(s, c.dimensions);
  width.from = s.number("from", Bound::Any, "m");
  width.to = s.number("to", Bound::Any, "m");
  if (!(width.from < width.to))
    throw s.error("to", fmt::format("expected more than from = {}, found {}", width.from, width.to));
  width.factor = s.number("factor", Bound::Positive, "", width.factor);
  if (width.factor == 1) return;  // to the bit
  width.stretch(c.domain.min), width.stretch(c.domain.max);
  for (Body& body : c.bodies) {
    for (Vec<3> Shape::*x : {&Shape::min, &Shape::max, &Shape::center, &Shape::start, &Shape::end})
      width.stretch(body.shape.*x);
    if (body.rotation) width.stretch(body.rotation->center);
  }
}

}  // namespace treacle
