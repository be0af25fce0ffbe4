#include "treacle/model/motion/opening.hpp"

#include "nozzle_lattice.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Functions of time begin with the case.
double meanOf(const std::optional<TimeFunction>& f, double from, double to) {
  if (!f) return 0;
  const double start = std::max(from, 0.0);
  return !f->isConstant() && to > start ? f->integral(start, to) / (to - start) : f->at(start);
}

}  // namespace

template <int D>
OpeningFace<D>::OpeningFace(const Case& c, const Opening& opening)
    : pressure_(opening.pressure), flowRate_(opening.flowRate) {
  const Nozzle& face = opening.face;
  place_.center = resized<D>(face.center);
  place_.direction = resized<D>(face.direction);
  place_.direction = place_.direction * (1 / norm(place_.direction));
  place_.spacing = c.spacing;
  if (c.method.kind == MethodKind::Isph) place_.rises = place_.depth - 1;
  const auto axes = axesAcross<D>(face, place_.direction);
  for (std::size_t k = 0; k < D - 1; ++k) place_.axes[k] = axes[k];
  if (face.kind == NozzleKind::Disc && D == 3) {
    place_.radius = face.radius;
  } else {
    place_.half[0] = face.kind == NozzleKind::Disc ? face.radius : face.width / 2;
    if constexpr (D == 3) place_.half[1] = face.height / 2;
  }
  columns_ = placesAcross<D - 1>(face, c.spacing);
  if (columns_.empty())
    throw InputError(fmt::format(
        "opening '{}': no particle has room in its face; it must be as wide as one spacing", opening.name));
  Across high = low_ = columns_[0];
  for (const Across& a : columns_)
    for (int k = 0; k < D - 1; ++k) low_[k] = std::min(low_[k], a[k]), high[k] = std::max(high[k], a[k]);
  std::size_t count = 1;
  for (int k = 0; k < D - 1; ++k) {
    low_[k] -= 1.5;
    cells_[static_cast<std::size_t>(k)] = static_cast<int>(high[k] - low_[k]) + 3;
    count *= static_cast<std::size_t>(cells_[static_cast<std::size_t>(k)]);
  }
  near_.resize(count);
  for (std::uint32_t column = 0; column < columns_.size(); ++column)
    for (int i = -1; i <= 1; ++i)
      for (int j = D == 3 ? -1 : 0; j <= (D == 3 ? 1 : 0); ++j) {
        Across a = columns_[column];
        a[0] += i;
        if constexpr (D == 3) a[1] += j;
        near_[cellOf(a)].push_back(column);
      }
}

template <int D>
OpeningForce<D> OpeningFace<D>::force(double from, double to) const {
  OpeningForce<D> force = place_;
  force.pressure = meanOf(pressure_, from, to);
  return force;
}

template <int D>
double OpeningFace<D>::flowRate(double from, double to) const {
  return meanOf(flowRate_, from, to);
}

template <int D>
Vec<D> OpeningFace<D>::at(std::size_t column, double behind) const {
  Vec<D> x = place_.center - behind * place_.spacing * place_.direction;
  for (int k = 0; k < D - 1; ++k) x = x + (columns_[column][k] * place_.spacing) * place_.axes[k];
  return x;
}

template <int D>
auto OpeningFace<D>::acrossOf(const Vec<D>& x) const -> Across {
  Across a;
  for (int k = 0; k < D - 1; ++k) a[k] = dot(x - place_.center, place_.axes[k]) / place_.spacing;
  return a;
}

template <int D>
std::span<const std::uint32_t> OpeningFace<D>::candidates(const Vec<D>& x) const {
  const Across a = acrossOf(x);
  for (int k = 0; k < D - 1; ++k)
    if (!(a[k] >= low_[k] && a[k] < low_[k] + cells_[static_cast<std::size_t>(k)])) return {};
  return near_[cellOf(a)];
}

template <int D>
std::size_t OpeningFace<D>::cellOf(const Across& a) const {
  std::size_t cell = 0;
  for (int k = D - 2; k >= 0; --k)
    cell = cell * static_cast<std::size_t>(cells_[static_cast<std::size_t>(k)]) +
           static_cast<std::size_t>(std::floor(a[k] - low_[k]));
  return cell;
}

template class OpeningFace<2>;
template class OpeningFace<3>;

}  // namespace treacle
