#include "facet_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace treacle {
namespace {

/// The share of the directions from x that facets far away cover, by their flux.
template <int D>
double coveredFromFar(const Vec<D>& flux, const Vec<D>& way, double distance) {
  const double sphere = D == 2 ? 2 * std::numbers::pi * distance : 4 * std::numbers::pi * distance * distance;
  return dot(flux, way) / (distance * sphere);
}

/// A sum of angles, by products of complex numbers: an arctangent takes longer than what it is of.
class AngleSum {
 public:
  /// `a`: cosine and sine times a length.
  void add(const Vec<2>& a) {
    if (!(a[0] > std::abs(a[1]) / 2)) {
      sum_ += std::atan2(a[1], a[0]);
      return;
    }
    const double tangent = a[1] / a[0];
    bound_ += std::abs(tangent);
    if (bound_ > 3) take(), bound_ = std::abs(tangent);
    product_ = {product_[0] - product_[1] * tangent, product_[1] + product_[0] * tangent};
  }
  double result() {
    take();
    return sum_;
  }

 private:
  void take() {
    sum_ += std::atan2(product_[1], product_[0]);
    product_ = {1, 0}, bound_ = 0;
  }

  double sum_ = 0;
  Vec<2> product_{1, 0};
  double bound_ = 0;  // of its angle, which pi must not reach
};

template <int D>
double angleBetween(const Vec<D>& a, const Vec<D>& b) {
  return std::acos(std::clamp(dot(a, b), -1.0, 1.0));
}

}  // namespace

template <int D>
struct FacetTree<D>::Building {
  const std::vector<Facet<D>>& facets;
  struct Entry {
    Vec<D> middle;
    std::uint32_t facet;
  };
  std::vector<Entry> entries;
};

template <int D>
FacetTree<D>::FacetTree(const std::vector<Facet<D>>& facets) {
  Building b{facets, {}};
  b.entries.reserve(facets.size());
  for (std::uint32_t k = 0; k < facets.size(); ++k)
    b.entries.push_back({std::accumulate(facets[k].begin(), facets[k].end(), Vec<D>{}) * (1.0 / D), k});
  nodes_.reserve(facets.size() / 2 + 1);
  facets_.reserve(facets.size()), original_.reserve(facets.size());
  build(b, 0, static_cast<std::uint32_t>(facets.size()));
  nodes_.shrink_to_fit();
}

template <int D>
std::uint32_t FacetTree<D>::build(Building& b, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  if (end - begin <= leafSize) {
    for (std::uint32_t k = begin; k < end; ++k) {
      facets_.push_back(b.facets[b.entries[k].facet]);
      original_.push_back(b.entries[k].facet);
    }
    nodes_[index] = leaf(begin, end);
    return index;
  }
  const auto from = b.entries.begin() + begin, to = b.entries.begin() + end, middle = from + (end - begin) / 2;
  Vec<D> low = from->middle, high = low;
  for (auto e = from; e != to; ++e)
    for (int m = 0; m < D; ++m) low[m] = std::min(low[m], e->middle[m]), high[m] = std::max(high[m], e->middle[m]);
  int axis = 0;
  for (int m = 1; m < D; ++m)
    if (high[m] - low[m] > high[axis] - low[axis]) axis = m;
  std::nth_element(from, middle, to, [&](const auto& i, const auto& j) {
    const double a = i.middle[axis], c = j.middle[axis];
    return a < c || (a == c && i.facet < j.facet);  // one order, whatever the library does with equal ones
  });
  const auto half = static_cast<std::uint32_t>(middle - b.entries.begin());
  build(b, begin, half);
  const std::uint32_t right = build(b, half, end);
  nodes_[index] = joined(nodes_[index + 1], nodes_[right]);
  nodes_[index].begin = begin, nodes_[index].end = end, nodes_[index].right = right;
  return index;
}

template <int D>
typename FacetTree<D>::Node FacetTree<D>::leaf(std::uint32_t begin, std::uint32_t end) const {
  Node node{};
  node.min = node.max = facets_[begin][0];
  node.begin = begin, node.end = end;
  for (std::uint32_t k = begin; k < end; ++k) {
    Vec<D> middle{};
    for (const Vec<D>& corner : facets_[k]) {
      middle += corner * (1.0 / D);
      for (int m = 0; m < D; ++m)
        node.min[m] = std::min(node.min[m], corner[m]), node.max[m] = std::max(node.max[m], corner[m]);
    }
    const Vec<D> normal = facetNormal<D>(facets_[k]);
    const double size = norm(normal);
    node.flux += normal, node.size += size, node.center += middle * size;
  }
  node.center *= 1 / node.size;
  finish(node);
  for (std::uint32_t k = begin; k < end && norm2(node.axis) > 0; ++k) {
    const Vec<D> normal = facetNormal<D>(facets_[k]);
    node.spread = std::max(node.spread, angleBetween(node.axis, normal * (1 / norm(normal))));
  }
  return node;
}

template <int D>
typename FacetTree<D>::Node FacetTree<D>::joined(const Node& a, const Node& b) {
  Node node{};
  for (int m = 0; m < D; ++m)
    node.min[m] = std::min(a.min[m], b.min[m]), node.max[m] = std::max(a.max[m], b.max[m]);
  node.flux = a.flux + b.flux, node.size = a.size + b.size;
  node.center = (a.center * a.size + b.center * b.size) * (1 / node.size);
  finish(node);
  if (norm2(node.axis) == 0) return node;
  for (const Node* child : {&a, &b})
    node.spread =
        std::max(node.spread,
                 norm2(child->axis) > 0 ? angleBetween(node.axis, child->axis) + child->spread : std::numbers::pi);
  return node;
}

/// What follows from the box, the flux and the size.
template <int D>
void FacetTree<D>::finish(Node& node) {
  Vec<D> farthest{};
  for (int m = 0; m < D; ++m) farthest[m] = std::max(node.max[m] - node.center[m], node.center[m] - node.min[m]);
  node.radius = norm(farthest);
  const double flux = norm(node.flux);
  if (flux > 1e-6 * node.size)
    node.axis = node.flux * (1 / flux);
  else
    node.spread = std::numbers::pi;
}

template <int D>
double FacetTree<D>::distance2(const Node& node, const Vec<D>& x) {
  double sum = 0;
  for (int m = 0; m < D; ++m) {
    const double d = std::max({node.min[m] - x[m], x[m] - node.max[m], 0.0});
    sum += d * d;
  }
  return sum;
}

/// Goes through the nodes from the root: into those that `enter` holds for, with `visit` of each facet of the
/// leaves among them.
template <int D>
template <class Enter, class Visit>
void FacetTree<D>::walk(Enter&& enter, Visit&& visit) const {
  std::uint32_t stack[64];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Node& node = nodes_[index];
    if (!enter(node)) continue;
    if (node.right != 0)
      stack[size++] = node.right, stack[size++] = index + 1;
    else
      for (std::uint32_t k = node.begin; k < node.end; ++k) visit(k);
  }
}

template <int D>
double FacetTree<D>::winding(const Vec<D>& x) const {
  constexpr double far = 2.5;  // radii: the flux is then right to some 0.01 of what the node covers
  double sum = 0;
  const auto enter = [&](const Node& node) {
    const Vec<D> way = node.center - x;
    const double d2 = norm2(way);
    const bool isFar = d2 > far * far * node.radius * node.radius;
    if (isFar) sum += coveredFromFar<D>(node.flux, way, std::sqrt(d2));
    return !isFar;
  };
  AngleSum angles;
  walk(enter, [&](std::uint32_t k) { angles.add(coveredAngle<D>(facets_[k], x)); });
  return sum + angles.result() / (2 * std::numbers::pi);
}

template <int D>
typename FacetTree<D>::Near FacetTree<D>::nearest(const Vec<D>& x, double limit) const {
  Near best;
  double best2 = limit * limit;
  struct Entry {
    std::uint32_t node;
    double distance2;
  } stack[64];
  int size = 0;
  stack[size++] = {0, distance2(nodes_[0], x)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.distance2 < best2)) continue;
    const Node& node = nodes_[entry.node];
    if (node.right != 0) {
      Entry a{entry.node + 1, distance2(nodes_[entry.node + 1], x)},
          b{node.right, distance2(nodes_[node.right], x)};
      if (a.distance2 < b.distance2) std::swap(a, b);
      stack[size++] = a, stack[size++] = b;  // the nearer one is next
      continue;
    }
    for (std::uint32_t k = node.begin; k < node.end; ++k) {
      const Vec<D> point = nearestOn<D>(facets_[k], x);
      const double d2 = norm2(point - x);
      if (d2 < best2) best2 = d2, best.point = point, best.facet = k;
    }
  }
  if (best.facet != none) best.distance = std::sqrt(best2);
  return best;
}

template <int D>
void FacetTree<D>::near(const Vec<D>& x, double reach, const Vec<D>& beside,
                        const std::function<void(const Near&)>& f) const {
  constexpr double sixty = std::numbers::pi / 3;
  const bool all = norm2(beside) == 0;
  const auto enter = [&](const Node& node) {
    if (distance2(node, x) > reach * reach) return false;
    return all || node.spread >= sixty || angleBetween(beside, node.axis) + node.spread >= sixty;
  };
  walk(enter, [&](std::uint32_t k) {
    const Vec<D> point = nearestOn<D>(facets_[k], x);
    if (const double distance = norm(point - x); distance <= reach) f({distance, point, k});
  });
}

template <int D>
void FacetTree<D>::touching(const Vec<D>& min, const Vec<D>& max,
                            const std::function<void(std::uint32_t)>& f) const {
  const auto touches = [&](const Vec<D>& low, const Vec<D>& high) {
    for (int m = 0; m < D; ++m)
      if (low[m] > max[m] || high[m] < min[m]) return false;
    return true;
  };
  walk([&](const Node& node) { return touches(node.min, node.max); },
       [&](std::uint32_t k) {
         Vec<D> low = facets_[k][0], high = low;
         for (const Vec<D>& corner : facets_[k])
           for (int m = 0; m < D; ++m)
             low[m] = std::min(low[m], corner[m]), high[m] = std::max(high[m], corner[m]);
         if (touches(low, high)) f(k);
       });
}

template class FacetTree<2>;
template class FacetTree<3>;

}  // namespace treacle
