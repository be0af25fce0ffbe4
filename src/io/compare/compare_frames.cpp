#include "picture/box.hpp"
#include "relative.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace treacle {
namespace {

/// Indices in the order of the ids.
std::vector<std::size_t> idOrder(const Frame& frame) {
  std::vector<std::size_t> order(frame.id.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto before = [&](std::size_t k, std::size_t l) { return frame.id[k] < frame.id[l]; };
  if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
  return order;
}

/// Two frames and which of their particles are the same.
struct MatchedFrames {
  const Frame &a, &b;
  std::vector<std::size_t> orderA, orderB;

  MatchedFrames(const Frame& first, const Frame& second) : a(first), b(second) {
    if (a.dimensions != b.dimensions)
      throw InputError(fmt::format("{} and {} dimensions", a.dimensions, b.dimensions));
    if (a.id.size() != a.position.size() || b.id.size() != b.position.size())
      throw InputError("particles have no ids; expected 'id' in output.fields of both runs");
    if (a.id.size() != b.id.size())
      throw InputError(fmt::format("{} and {} fluid particles", a.id.size(), b.id.size()));
    orderA = idOrder(a), orderB = idOrder(b);
    for (std::size_t k = 0; k < orderA.size(); ++k) {
      const auto idA = a.id[orderA[k]], idB = b.id[orderB[k]];
      if (idA != idB) throw InputError(fmt::format("particle {} is in only one of them", std::min(idA, idB)));
      if (k > 0 && idA == a.id[orderA[k - 1]]) throw InputError(fmt::format("two particles have the id {}", idA));
    }
  }

  /// distance(i, j): between the values of particle i of a and particle j of b; size(j): of that of b.
  template <class Distance, class Size>
  FieldDifference difference(Distance distance, Size size) const {
    FieldDifference d;
    double squares = 0, reference = 0;
    for (std::size_t k = 0; k < orderA.size(); ++k) {
      const double x = distance(orderA[k], orderB[k]), y = size(orderB[k]);
      d.maximum = std::max(d.maximum, x);
      squares += x * x;
      reference += y * y;
    }
    if (!std::isfinite(squares)) d.maximum = squares;  // std::max passes over what is not a number
    if (!orderA.empty()) d.rms = std::sqrt(squares / static_cast<double>(orderA.size()));
    d.relative = relativeTo(std::sqrt(reference), std::sqrt(squares));
    return d;
  }

  std::optional<FieldDifference> scalar(std::vector<double> Frame::*field) const {
    const auto &x = a.*field, &y = b.*field;
    if (x.size() != a.id.size() || y.size() != b.id.size()) return std::nullopt;
    return difference([&](std::size_t i, std::size_t j) { return std::abs(x[i] - y[j]); },
                      [&](std::size_t j) { return y[j]; });
  }

  std::optional<FieldDifference> velocity() const {
    if (a.velocity.size() != a.id.size() || b.velocity.size() != b.id.size()) return std::nullopt;
    return difference([&](std::size_t i, std::size_t j) { return norm(a.velocity[i] - b.velocity[j]); },
                      [&](std::size_t j) { return norm(b.velocity[j]); });
  }

  FieldDifference position(const Case& reference) const {
    const Domain& domain = reference.domain;
    const auto distance = [&](std::size_t i, std::size_t j) {
      Vec<3> d = a.position[i] - b.position[j];
      for (int k = 0; k < a.dimensions; ++k) {
        const double length = domain.max[k] - domain.min[k];
        if (domain.periodic[k]) d[k] -= length * std::round(d[k] / length);
      }
      return norm(d);
    };
    FieldDifference d = difference(distance, [](std::size_t) { return 0.0; });
    d.relative = relativeTo(boundsOf(b.position, reference.spacing / 2).longestSide(), d.rms);
    return d;
  }
};

}  // namespace

FrameDifference compareFrames(const Frame& a, const Frame& b, const Case& reference) {
  const MatchedFrames frames(a, b);
  FrameDifference d;
  d.time = b.time;
  d.fields = {frames.position(reference), frames.velocity(), frames.scalar(&Frame::pressure),
              frames.scalar(&Frame::numberDensity), frames.scalar(&Frame::nearestDistance)};
  return d;
}

}  // namespace treacle
