#pragma once

#include "treacle/core/vec.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace treacle {

/// An array of NumPy's that owns the values: of one dimension.
template <class T>
nanobind::object arrayOf(std::vector<T> values) {
  auto* kept = new std::vector<T>(std::move(values));
  const nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(kept->data(), {kept->size()}, owner));
}
/// An array that has a row for each vector.
inline nanobind::object arrayOf(std::vector<Vec<3>> values, std::size_t components) {
  auto* kept = new std::vector<double>(values.size() * components);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t k = 0; k < components; ++k) (*kept)[i * components + k] = values[i][static_cast<int>(k)];
  const nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nanobind::cast(
      nanobind::ndarray<nanobind::numpy, double>(kept->data(), {values.size(), components}, owner));
}

}  // namespace treacle
