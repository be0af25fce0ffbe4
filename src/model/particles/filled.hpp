#pragma once

#include "body_points.hpp"

#include <vector>

namespace treacle {

/// A body and its points.
template <int D>
struct Filled {
  const Body* body;
  BodyPoints<D> points;
};

template <int D>
std::size_t total(const std::vector<Filled<D>>& filled) {
  std::size_t count = 0;
  for (const Filled<D>& f : filled) count += f.points.size();
  return count;
}

}  // namespace treacle
