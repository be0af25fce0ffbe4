#include "overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace treacle {
namespace {

constexpr double clearDepth = 0.25;  // [spacings]; bodies that are rounded to the lattice overlap by less

bool subtracts(const Body& body, const Body& other) {
  return std::ranges::find(body.subtract, other.name) != body.subtract.end();
}

}  // namespace

template <int D>
Overlap<D>::Overlap(const Case& c)
    : case_(c),
      radius_(0.5 * c.spacing * (1 - 1e-6)),
      reach_(0.5 * std::sqrt(static_cast<double>(D)) * c.spacing * (1 + 1e-6)),
      depth_(clearDepth * c.spacing),
      regions_(c.bodies.size()),
      nozzles_(c.bodies.size()) {}

template <int D>
bool Overlap<D>::isInside(const Body& body, const Vec<D>& x) const {
  if (body.kind == BodyKind::Inflow || body.shape.kind == ShapeKind::Particles) return false;
  auto& region = regions_[static_cast<std::size_t>(&body - case_.bodies.data())];
  if (!region) region = std::make_unique<const BodyRegion<D>>(case_, body);
  return region->fillsAround(x, depth_);
}

template <int D>
bool Overlap<D>::isInNozzle(const Body& body, const Vec<D>& x) const {
  if (body.kind != BodyKind::Inflow) return false;
  auto& region = nozzles_[static_cast<std::size_t>(&body - case_.bodies.data())];
  if (!region) region = std::make_unique<const NozzleRegion<D>>(case_, body);
  return region->fillsAround(x, depth_);
}

template <int D>
bool Overlap<D>::isTaken(const Body& solid, const Vec<D>& at, const Body& earlier, const Vec<D>& earlierAt) const {
  if (&solid == &earlier || (solid.kind == BodyKind::Wall && earlier.kind == BodyKind::Wall)) return false;
  if (isInside(earlier, at)) return true;
  const bool nozzle = solid.kind == BodyKind::Inflow || earlier.kind == BodyKind::Inflow;
  return nozzle && (isInside(solid, earlierAt) || isInNozzle(earlier, at) || isInNozzle(solid, earlierAt));
}

template <int D>
bool Overlap<D>::sharePlace(const Body& fluid, const Vec<D>& fluidAt, const Body& wall,
                            const Vec<D>& wallAt) const {
  if (subtracts(fluid, wall) || subtracts(wall, fluid)) return false;
  return isInside(fluid, wallAt) || isInside(wall, fluidAt) ||
         (fluid.kind == BodyKind::Fluid && isInNozzle(wall, fluidAt));
}

template class Overlap<2>;
template class Overlap<3>;

}  // namespace treacle
