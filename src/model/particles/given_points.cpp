#include "given_points.hpp"

#include "treacle/model/geometry/point_grid.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <fmt/format.h>

namespace treacle {

template <int D>
BodyPoints<D> givenPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                          const std::function<bool(const Vec<D>&)>& keep) {
  const std::vector<Vec<3>>& places = body.shape.file.particles.value->position;
  const Similarity<D> similarity = similarityOf<D>(body.shape);
  PointGrid<D> grid(c.domain, 0.5 * c.spacing * (1 - 1e-6), places.size());
  BodyPoints<D> points;
  std::size_t left = 0;
  for (std::uint32_t k = 0; k < places.size(); ++k) {
    const Vec<D> x = similarity.point(resized<D>(places[k]));
    if (!keep(x)) continue;  // first of all: it refuses what is not in the domain
    if (grid.find(x) != PointGrid<D>::none) {
      ++left;
      continue;
    }
    grid.add(x, 0);
    points.place.push_back(x), points.given.push_back(k);
  }
  if (left > 0)
    notes.push_back(
        fmt::format("body '{}': {} of the {} particles of {} left out, closer than half a spacing to an "
                    "earlier one",
                    body.name, left, places.size(), body.shape.file.path));
  return points;
}

template BodyPoints<2> givenPoints<2>(const Case&, const Body&, std::vector<std::string>&,
                                      const std::function<bool(const Vec<2>&)>&);
template BodyPoints<3> givenPoints<3>(const Case&, const Body&, std::vector<std::string>&,
                                      const std::function<bool(const Vec<3>&)>&);

}  // namespace treacle
