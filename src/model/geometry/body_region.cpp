#include "body_region.hpp"

#include "all_around.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

template <int D>
bool isTrue(const Expression& expression, const Vec<D>& x) {
  const double value = expression(resized<3>(x));
  return std::isfinite(value) && value != 0;
}

}  // namespace

template <int D>
BodyRegion<D>::BodyRegion(const Case& c, const Body& body)
    : shape_(body.shape),
      similarity_(similarityOf<D>(body.shape)),
      subtracted_(subtractedRegions<D>(c, body)),
      slack_(1e-6 * c.spacing) {
  if (isSolid(shape_)) solid_ = std::make_unique<const Solid<D>>(shape_, c.interactionRadius(), c.spacing);
  if (!body.where.empty()) where_.emplace(body.where, D);
  const Extent box = boundingBox(shape_, D);
  const Vec<D> margin = Vec<D>::filled(slack_);
  min_ = solid_ ? solid_->min() : resized<D>(box.min) - margin;
  max_ = solid_ ? solid_->max() : resized<D>(box.max) + margin;
}

template <int D>
bool BodyRegion<D>::touches(const Vec<D>& min, const Vec<D>& max) const {
  for (int k = 0; k < D; ++k)
    if (max[k] < min_[k] || min[k] > max_[k]) return false;
  return true;
}

template <int D>
bool BodyRegion<D>::holds(const Vec<D>& x) const {
  if (shape_.kind == ShapeKind::Particles || !touches(x, x) || (where_ && !isTrue(*where_, x))) return false;
  const bool within =
      solid_ ? solid_->contains(x) : contains<D>(shape_, similarity_.pointBefore(x), slack_ / similarity_.scale());
  return within && std::ranges::none_of(subtracted_, [&](const BodyRegion& region) { return region.holds(x); });
}

template <int D>
bool BodyRegion<D>::fillsAround(const Vec<D>& x, double distance) const {
  return allAround(x, distance, [this](const Vec<D>& at) { return fills(at); });
}

template <int D>
std::vector<BodyRegion<D>> subtractedRegions(const Case& c, const Body& body) {
  std::vector<BodyRegion<D>> regions;
  for (const std::string& name : body.subtract)
    regions.emplace_back(c, *std::ranges::find(c.bodies, name, &Body::name));
  return regions;
}

template <int D>
BodyCondition<D>::BodyCondition(const Case& c, const Body& body) : subtracted_(subtractedRegions<D>(c, body)) {
  if (!body.where.empty()) where_.emplace(body.where, D);
}

template <int D>
bool BodyCondition<D>::holds(const Vec<D>& x) const {
  return (!where_ || isTrue(*where_, x)) &&
         std::ranges::none_of(subtracted_, [&](const BodyRegion<D>& region) { return region.holds(x); });
}

template <int D>
bool BodyCondition<D>::mayFail(const Vec<D>& min, const Vec<D>& max) const {
  return where_ ||
         std::ranges::any_of(subtracted_, [&](const BodyRegion<D>& region) { return region.touches(min, max); });
}

template class BodyRegion<2>;
template class BodyRegion<3>;
template class BodyCondition<2>;
template class BodyCondition<3>;
template std::vector<BodyRegion<2>> subtractedRegions<2>(const Case&, const Body&);
template std::vector<BodyRegion<3>> subtractedRegions<3>(const Case&, const Body&);

}  // namespace treacle
