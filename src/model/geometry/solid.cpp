#include "solid.hpp"

#include "polygon.hpp"
#include "treacle/model/geometry/mesh.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace treacle {
namespace {

std::atomic<std::uint64_t> solids{0};

/// Of length one, along no side that a case is likely to have.
template <int D>
Vec<D> asideDirection() {
  const Vec<D> v = resized<D>(Vec<3>{1, 0.38471, 0.21137});
  return v * (1 / norm(v));
}

}  // namespace

template <int D>
std::shared_ptr<const FacetTree<D>> facetsOf(const Shape& s) {
  if constexpr (D == 3)
    if (s.kind == ShapeKind::Mesh) return {s.file.mesh.value, &s.file.mesh.value->tree()};
  return std::make_shared<const FacetTree<D>>(s.kind == ShapeKind::Polyline ? polylineFacets<D>(s)
                                                                            : polygonFacets<D>(s));
}

template <int D>
Solid<D>::Solid(const Shape& s, double needed, double spacing)
    : similarity_(similarityOf<D>(s)),
      tree_(facetsOf<D>(s)),
      fill_(s.fill),
      closed_(s.kind != ShapeKind::Mesh || s.file.mesh.value->facts().closed()),
      sign_(s.flip ? -1 : 1),
      thickness_((s.thickness > 0 ? s.thickness : needed) / similarity_.scale()),
      slack_(1e-6 * spacing / similarity_.scale()),
      spacing_(spacing / similarity_.scale()),
      number_(++solids) {
  Shape layered = s;
  layered.thickness = thickness_ * similarity_.scale();
  const Extent box = boundingBox(layered, D);
  const Vec<D> margin = Vec<D>::filled(1e-6 * spacing);
  min_ = resized<D>(box.min) - margin, max_ = resized<D>(box.max) + margin;
}

template <int D>
typename Solid<D>::Answer Solid<D>::filled(const Vec<D>& x) const {
  const Vec<D> local = similarity_.pointBefore(x);
  const auto answer = [&](bool within, double sure) { return Answer{within, sure * similarity_.scale()}; };
  // Farther away nothing need be known: in the middle of a ball all of its facets would be looked at.
  const double limit = thickness_ + 16 * spacing_, d = std::min(tree_->nearest(local, limit).distance, limit);
  if (fill_ == FillKind::Sheet) return answer(d <= thickness_ / 2 + slack_, std::abs(d - thickness_ / 2 - slack_));
  const bool layer = fill_ != FillKind::Inside;
  const double end = thickness_ + slack_;
  if (layer && d > end) return answer(false, d - end);
  const double w = windingAt(local, d);
  double sure = sureDistance(d, w);
  const bool within = (w >= 0.5) != (fill_ == FillKind::Outside);
  if (layer && within) sure = std::min(sure, end - d);
  return answer(within, sure);
}

/// The surface itself belongs to one of the two sides of it, that of a point just aside of it: of two solids that
/// share a part of their surfaces to one.
template <int D>
double Solid<D>::windingAt(const Vec<D>& local, double distance) const {
  const bool onSurface = distance <= 2 * slack_;
  return sign_ * tree_->winding(onSurface ? local + asideDirection<D>() * slack_ : local);
}

/// Beside holes winding numbers change with the place. They are harmonic: where they are within 1.5 of their
/// middle in a ball of radius d, none changes by more than 1.5 D r / (d - r) on a way of r.
template <int D>
double Solid<D>::sureDistance(double d, double w) const {
  const double off = std::abs(w - 0.5);
  return closed_ ? d - slack_ : (d - slack_) * off / (off + 1.5 * D);
}

template <int D>
typename Solid<D>::Surroundings Solid<D>::around(const Vec<D>& local) const {
  struct Ball {
    std::uint64_t solid = 0;
    Vec<D> middle{};
    double square = 0;  // of the radius in which `within` holds
    Surroundings known{};
  };
  constexpr std::size_t balls = 64;
  thread_local std::array<Ball, balls> memory;
  thread_local std::size_t next = 0;
  for (std::size_t k = 1; k <= balls; ++k) {
    const Ball& ball = memory[(next + balls - k) % balls];  // the last one first
    if (ball.solid != number_) continue;
    if (const double r2 = norm2(local - ball.middle); r2 < ball.square) {
      const double r = std::sqrt(r2);
      return {ball.known.within, ball.known.least - r, ball.known.most + r};
    }
  }
  const double limit = thickness_ + 16 * spacing_;
  const Near near = tree_->nearest(local, limit);
  const double w = windingAt(local, near.distance);
  const Surroundings known{w >= 0.5, std::min(near.distance, limit), near.distance};
  if (const double sure = sureDistance(known.least, w) - slack_; sure > 0)
    memory[next] = {number_, local, sure * sure, known}, next = (next + 1) % balls;
  return known;
}

template <int D>
bool Solid<D>::contains(const Vec<D>& x) const {
  for (int k = 0; k < D; ++k)
    if (x[k] < min_[k] || x[k] > max_[k]) return false;
  const Vec<D> local = similarity_.pointBefore(x);
  switch (fill_) {
    case FillKind::Inside:
    case FillKind::Shell:
      break;
    case FillKind::Outside: {
      const Surroundings known = around(local);
      const double end = thickness_ + slack_;
      if (known.within || known.least > end) return false;
      return known.most <= end || tree_->nearest(local, end).facet != tree_->none;
    }
    case FillKind::Sheet:
      return tree_->nearest(local, thickness_ / 2 + slack_).facet != tree_->none;
    case FillKind::ThinSheet:
      return false;
  }
  return inside(local);
}

/// From a point to its nearest one, a unit vector; from a point of the boundary outward.
template <int D>
Vec<D> Solid<D>::direction(const Vec<D>& local, const Near& near) const {
  if (near.distance > 10 * slack_) return (near.point - local) * (1 / near.distance);
  const Vec<D> normal = facetNormal<D>(tree_->facet(near.facet)) * sign_;
  return normal * ((fill_ == FillKind::Outside ? -1 : 1) / norm(normal));
}

template <int D>
typename Solid<D>::At Solid<D>::at(int face, const Vec<D>& x) const {
  const Vec<D> local = similarity_.pointBefore(x);
  const Near near = tree_->nearest(local);
  Vec<D> towards = direction(local, near);
  const auto result = [&](double height, const Vec<D>& normal) {
    return At{height * similarity_.scale(), similarity_.direction(normal)};
  };
  if (fill_ == FillKind::Sheet) return result(near.distance - thickness_ / 2, -towards);
  const bool onSurface = near.distance <= 10 * slack_;
  const bool within = onSurface || inside(local) != (fill_ == FillKind::Outside);
  const double height = within ? -near.distance : near.distance;
  if (!within) towards = -towards;
  if (face == 0) return result(height, towards);
  return result(-height - thickness_, -towards);
}

template <int D>
void Solid<D>::ways(const Vec<D>& x, double reach, bool all, std::vector<Way>& found) const {
  const Vec<D> local = similarity_.pointBefore(x);
  const Near near = tree_->nearest(local);
  const Vec<D> first = direction(local, near);
  const std::size_t begin = found.size();
  const auto add = [&](const Vec<D>& out, double distance, bool clear) {
    found.push_back({out, std::max(0.0, distance), clear});
  };
  if (fill_ == FillKind::Sheet) {
    add(-first, thickness_ / 2 - near.distance, true), add(first, thickness_ / 2 + near.distance, true);
  } else {
    add(first, near.distance, true);
    if (fill_ == FillKind::Outside) add(-first, thickness_ - near.distance, false);
    otherWays(local, reach / similarity_.scale(), first, all, found);
  }
  for (std::size_t k = begin; k < found.size(); ++k)
    found[k].out = similarity_.direction(found[k].out), found[k].distance *= similarity_.scale();
  std::erase_if(found, [&](const Way& way) { return way.distance > reach; });
}

template <int D>
void Solid<D>::otherWays(const Vec<D>& local, double reach, const Vec<D>& first, bool all,
                         std::vector<Way>& found) const {
  constexpr double sixty = 0.5 + 1e-6;  // its cosine, with rounding
  std::vector<Near> nears;
  const double facing = sign_ * (fill_ == FillKind::Outside ? -1 : 1);
  tree_->near(local, reach, all ? Vec<D>{} : first * facing, [&](const Near& near) {
    if (near.distance <= 10 * slack_) return;
    if (dot(near.point - local, first) <= (all ? 0.999 : sixty) * near.distance) nears.push_back(near);
  });
  std::ranges::sort(nears, {}, &Near::distance);
  const std::size_t most = all ? 6 : 3;
  std::size_t tests = all ? 64 : 32, taken = 0;
  const Vec<D>* before = nullptr;
  for (const Near& near : nears) {
    if (before && norm(near.point - *before) < 1e-3 * spacing_) continue;
    before = &near.point;
    // It is nearer than the points around it if none of them is nearer to a point on the way just before it: so
    // close that no other side of an edge is there.
    const Vec<D> out = (near.point - local) * (1 / near.distance);
    const double step = std::min(near.distance / 2, 2e-5 * spacing_);
    if (tree_->nearest(near.point - out * step, step * (1 - 1e-3)).facet == tree_->none) {
      found.push_back({out, near.distance, false});
      if (++taken == most) return;
    }
    if (--tests == 0) return;
  }
}

template std::shared_ptr<const FacetTree<2>> facetsOf<2>(const Shape&);
template std::shared_ptr<const FacetTree<3>> facetsOf<3>(const Shape&);
template class Solid<2>;
template class Solid<3>;

}  // namespace treacle
