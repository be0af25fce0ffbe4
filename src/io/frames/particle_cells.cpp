#include "particle_cells.hpp"

#include "picture/box.hpp"

#include <cmath>

namespace treacle {

ParticleCells::ParticleCells(const Frame& fluid, const Frame& walls, std::span<const Vec<3>> others,
                             const Domain& domain, double edge)
    : dimensions_(fluid.dimensions), edge_(edge) {
  // Two cells around each particle's own one, wherever in it the particle lies.
  const Box box = boundsOf(fluid.position, 3 * edge);
  min_ = box.min, max_ = box.max;
  points_.reserve(fluid.position.size() + walls.position.size());
  for (std::size_t i = 0; i < fluid.position.size(); ++i) add(fluid.position[i], static_cast<std::uint32_t>(i));
  addImages(domain);
  // The fluid's own box need not reach the end of the domain beyond which these are.
  for (const Vec<3>& x : walls.position) addWithImages(x, domain);
  for (const Vec<3>& x : others) addWithImages(x, domain);
  std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.key < b.key; });
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (keys_.empty() || points_[i].key != keys_.back())
      keys_.push_back(points_[i].key), begin_.push_back(static_cast<std::uint32_t>(i));
  begin_.push_back(static_cast<std::uint32_t>(points_.size()));
}

void ParticleCells::add(const Vec<3>& position, std::uint32_t index) {
  for (int k = 0; k < dimensions_; ++k)
    if (position[k] < min_[k] || position[k] > max_[k]) return;
  points_.push_back({keyOf(position), position, index});
}

/// Axis by axis, so that images have images of their own across edges and corners.
void ParticleCells::addImages(const Domain& domain) {
  const double margin = 3 * edge_;
  for (int k = 0; k < dimensions_; ++k) {
    if (!domain.periodic[static_cast<std::size_t>(k)]) continue;
    const double period = domain.max[k] - domain.min[k];
    for (std::size_t i = 0, count = points_.size(); i < count; ++i) {
      Vec<3> x = points_[i].position;
      const double at = x[k];
      if (at < domain.min[k] + margin) x[k] = at + period, add(x, image);
      if (at > domain.max[k] - margin) x[k] = at - period, add(x, image);
    }
  }
}

void ParticleCells::addWithImages(Vec<3> x, const Domain& domain, int axis) {
  if (axis == dimensions_) return add(x, wall);
  addWithImages(x, domain, axis + 1);
  if (!domain.periodic[static_cast<std::size_t>(axis)]) return;
  const double at = x[axis], period = domain.max[axis] - domain.min[axis];
  for (const double shift : {-period, period}) {
    x[axis] = at + shift;
    addWithImages(x, domain, axis + 1);
  }
}

std::int64_t ParticleCells::keyOf(const Vec<3>& x) const {
  std::int64_t key = 0;
  for (int k = dimensions_ - 1; k >= 0; --k) {
    const double cell = (x[k] - min_[k]) / edge_;
    // Farther than the bits reach particles share a cell, which costs time only.
    key = key * row + (cell > 0 ? static_cast<std::int64_t>(std::min(cell, row - 4.0)) : 0);
  }
  return key;
}

Vec<3> ParticleCells::middle(std::size_t cell) const {
  Vec<3> x{};
  std::int64_t key = keys_[cell];
  for (int k = 0; k < dimensions_; ++k, key /= row)
    x[k] = min_[k] + (static_cast<double>(key % row) + 0.5) * edge_;
  return x;
}

}  // namespace treacle
