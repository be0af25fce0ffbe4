#include "treacle/model/geometry/mesh.hpp"

#include "facet_tree.hpp"
#include "mesh_tally.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

Facet<3> facetOf(const Triangles& t, std::size_t k) {
  return {t.vertices[t.corners[k][0]], t.vertices[t.corners[k][1]], t.vertices[t.corners[k][2]]};
}

/// Whether a triangle is so thin that its normal is nothing but rounding.
bool isFlat(const Facet<3>& f) {
  const double longest = std::max({norm2(f[1] - f[0]), norm2(f[2] - f[1]), norm2(f[0] - f[2])});
  return !(norm(facetNormal<3>(f)) > 1e-14 * longest);
}

/// Whether the straight line from a to b goes through a triangle, its rim not included.
bool pierces(const Vec<3>& a, const Vec<3>& b, const Facet<3>& f) {
  const auto volume = [](const Vec<3>& p, const Vec<3>& q, const Vec<3>& r, const Vec<3>& s) {
    return dot(cross(q - p, r - p), s - p);
  };
  const double above = volume(f[0], f[1], f[2], a), below = volume(f[0], f[1], f[2], b);
  if (!(above * below < 0)) return false;
  const double u = volume(a, b, f[0], f[1]), v = volume(a, b, f[1], f[2]), w = volume(a, b, f[2], f[0]);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

bool cross(const Facet<3>& a, const Facet<3>& b) {
  for (const Vec<3>& p : a)
    for (const Vec<3>& q : b)
      if (p == q) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

}  // namespace

Mesh::Mesh(Triangles t) {
  weld(t);
  const auto faceOf = [&](std::size_t k) {
    return t.face.empty() ? static_cast<std::uint32_t>(k + 1) : t.face[k];
  };
  const std::vector<std::uint32_t> twice = repeated(t);
  facts_.twice = twice.size();
  if (!twice.empty()) facts_.firstTwice = faceOf(twice.front());
  std::size_t kept = 0, next = 0;
  if (t.face.empty())
    for (std::size_t k = 0; k < t.corners.size(); ++k) t.face.push_back(static_cast<std::uint32_t>(k + 1));
  for (std::size_t k = 0; k < t.corners.size(); ++k) {
    if (next < twice.size() && twice[next] == k) {
      ++next;
      continue;
    }
    t.corners[kept] = t.corners[k], t.face[kept++] = t.face[k];
  }
  t.corners.resize(kept), t.face.resize(kept);
  tallyEdges(t, facts_);  // with the flat ones, which close gaps between others

  std::vector<Facet<3>> facets;
  std::vector<std::uint32_t> face;
  facets.reserve(kept), face.reserve(kept);
  for (std::size_t k = 0; k < kept; ++k) {
    const Facet<3> f = facetOf(t, k);
    if (isFlat(f)) {
      if (facts_.flat++ == 0) facts_.firstFlat = t.face[k];
      continue;
    }
    facets.push_back(f), face.push_back(t.face[k]);
  }
  facts_.triangles = facets.size();
  if (facets.empty()) return;
  t = {};
  tree_ = std::make_unique<const FacetTree<3>>(facets);
  facts_.min = tree_->min(), facts_.max = tree_->max();
  const Vec<3> middle = 0.5 * (facts_.min + facts_.max);
  for (const Facet<3>& f : facets) {
    const Vec<3> normal = facetNormal<3>(f);
    facts_.area += norm(normal);
    facts_.volume += dot(f[0] - middle, normal) / 3;
  }
  face_.resize(face.size());
  for (std::size_t k = 0; k < face.size(); ++k) face_[k] = face[tree_->original(k)];
}

Mesh::~Mesh() = default;

MeshCrossings Mesh::findCrossings() const {
  constexpr std::size_t chunk = 1024;
  const std::size_t count = tree_ ? tree_->size() : 0, chunks = (count + chunk - 1) / chunk;
  std::vector<MeshCrossings> of(chunks);
  parallelForDynamic(chunks, 2, 1, [&](std::size_t c) {
    for (std::size_t k = c * chunk; k < std::min(count, (c + 1) * chunk); ++k) {
      const Facet<3>& f = tree_->facet(k);
      Vec<3> min = f[0], max = f[0];
      for (const Vec<3>& corner : f)
        for (int m = 0; m < 3; ++m) min[m] = std::min(min[m], corner[m]), max[m] = std::max(max[m], corner[m]);
      tree_->touching(min, max, [&](std::uint32_t other) {
        if (other <= k || !cross(f, tree_->facet(other))) return;
        if (of[c].pairs++ == 0) of[c].first = face_[k], of[c].second = face_[other], of[c].place = f[0];
      });
    }
  });
  MeshCrossings all;
  for (const MeshCrossings& part : of) {
    if (part.pairs == 0) continue;
    const std::size_t pairs = all.pairs + part.pairs;
    if (all.pairs == 0) all = part;
    all.pairs = pairs;
  }
  return all;
}

}  // namespace treacle
