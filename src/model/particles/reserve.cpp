#include "reserve.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/motion/opening.hpp"

#include <fmt/format.h>
#include <cmath>
#include <set>

namespace treacle {

template <int D>
void requireReserves(const Case& c, const Overlap<D>& overlap, std::vector<std::string>& notes) {
  constexpr int layers = OpeningForce<D>::depth + 1;  // with one that fluid leaves through
  for (const Opening& o : c.openings) {
    const OpeningFace<D> face(c, o);
    for (const Body& body : c.bodies) {
      if (!body.isWall() || body.shape.isThinSheet()) continue;
      std::size_t inside = 0;
      for (std::size_t column = 0; column < face.columns(); ++column)
        for (int k = 0; k < layers; ++k) inside += overlap.isInside(body, face.at(column, k + 0.5));
      if (inside == 0) continue;
      const std::size_t all = layers * face.columns();
      const std::string text = fmt::format(
          "opening '{}': {} of the {} places of its reserve are inside {} '{}'; expected a channel as wide as the "
          "face that goes on behind it for {} spacings, {}",
          o.name, inside, all, nameOf(body.kind), body.name, layers, lengthText(layers * c.spacing));
      if (2 * inside > all) throw InputError(text);
      notes.push_back(text);
    }
  }
}

template <int D>
void clearBehindReserves(const Case& c, std::vector<Filled<D>>& fluid, std::vector<std::string>& notes) {
  constexpr int parts = 4, gap = 6;  // of a spacing; without a particle
  for (const Opening& o : c.openings) {
    const OpeningForce<D> opening = OpeningFace<D>(c, o).place();
    const double from = opening.depth + 0.5;  // as in the steps (OutflowRegion)
    const auto partOf = [&](const Vec<D>& x) {
      return opening.isAcross(x, 0.5) ? std::floor(parts * (opening.behind(x) - from + 1e-6)) : -1;
    };
    std::set<double> filled;
    for (const Filled<D>& f : fluid)
      for (const Vec<D>& x : f.points.place)
        if (const double part = partOf(x); part >= 0) filled.insert(part);
    double last = -1;
    for (const double part : filled) {
      if (part > last + gap) break;
      last = part;
    }
    const std::size_t all = total(fluid);
    for (Filled<D>& f : fluid)
      f.points.filter([&](std::size_t k) {
        const double part = partOf(f.points.place[k]);
        return part < 0 || part > last;
      });
    if (const std::size_t left = all - total(fluid); left > 0)
      notes.push_back(
          fmt::format("opening '{}': {} of {} fluid particles left out, which are behind its reserve of {}; its "
                      "direction is to lead into the fluid",
                      o.name, left, all, lengthText(opening.depth * c.spacing)));
  }
}

template void requireReserves(const Case&, const Overlap<2>&, std::vector<std::string>&);
template void requireReserves(const Case&, const Overlap<3>&, std::vector<std::string>&);
template void clearBehindReserves(const Case&, std::vector<Filled<2>>&, std::vector<std::string>&);
template void clearBehindReserves(const Case&, std::vector<Filled<3>>&, std::vector<std::string>&);

}  // namespace treacle
