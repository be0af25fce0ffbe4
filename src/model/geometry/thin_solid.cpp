#include "thin_solid.hpp"

#include "facet_joint.hpp"
#include "solid.hpp"
#include "treacle/core/block.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/thickness.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// From a facet straight through the solid to where it ends.
struct WayThrough {
  double length = std::numeric_limits<double>::infinity();
  std::uint32_t end = ~0u;  // the facet there
};

/// The unit normals of a closed surface, outward whichever way its facets turn.
template <int D>
std::vector<Vec<D>> outwardNormals(const FacetTree<D>& tree) {
  const Vec<D> middle = 0.5 * (tree.min() + tree.max());
  std::vector<Vec<D>> normals(tree.size());
  double volume = 0;
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const Vec<D> normal = facetNormal<D>(tree.facet(k));
    volume += dot(tree.facet(k)[0] - middle, normal);
    normals[k] = normal * (1 / norm(normal));
  }
  if (volume < 0)
    for (Vec<D>& normal : normals) normal = -normal;
  return normals;
}

template <int D>
Vec<D> middleOf(const Facet<D>& facet) {
  Vec<D> sum{};
  for (const Vec<D>& corner : facet) sum += corner;
  return sum * (1.0 / D);
}

template <int D>
double sizeOf(const Facet<D>& facet) {
  return norm(facetNormal<D>(facet));
}

/// From a point of facet k. Ways longer than `limit` are not found.
template <int D>
WayThrough wayThrough(const FacetTree<D>& tree, const std::vector<Vec<D>>& normals, std::size_t k,
                      const Vec<D>& from, double limit) {
  const Vec<D> inward = -normals[k], to = from + inward * limit;
  const double slack = 1e-6 * limit;
  Vec<D> min = from, max = from;
  for (int m = 0; m < D; ++m) min[m] = std::min(from[m], to[m]), max[m] = std::max(from[m], to[m]);
  WayThrough way;
  tree.touching(min, max, [&](std::uint32_t other) {
    const double cosine = dot(inward, normals[other]);
    if (other == k || cosine < 1e-3) return;
    const double length = dot(tree.facet(other)[0] - from, normals[other]) / cosine;
    if (length < 0 || length > std::min(limit, way.length)) return;
    const Vec<D> end = from + inward * length;
    if (norm(nearestOn<D>(tree.facet(other), end) - end) <= slack) way = {length, other};
  });
  return way;
}

template <int D>
std::vector<WayThrough> waysThrough(const FacetTree<D>& tree, const std::vector<Vec<D>>& normals, double limit) {
  std::vector<WayThrough> ways(tree.size());
  parallelFor(tree.size(), 256, [&](std::size_t k) {
    ways[k] = wayThrough<D>(tree, normals, k, middleOf<D>(tree.facet(k)), limit);
  });
  return ways;
}

/// Facets in sets, each of them on one of two sides of its set.
class TwoSides {
 public:
  explicit TwoSides(std::size_t count) : parent_(count), turned_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  struct Place {
    std::uint32_t set;
    bool turned;
  };
  Place of(std::uint32_t k) {
    std::uint32_t root = k;
    bool turned = false;
    for (; parent_[root] != root; root = parent_[root]) turned = turned != turned_[root];
    const Place place{root, turned};
    while (parent_[k] != root) {
      const std::uint32_t next = parent_[k];
      const bool rest = turned != turned_[k];
      parent_[k] = root, turned_[k] = turned;
      k = next, turned = rest;
    }
    return place;
  }
  /// Whether that a and b are on the same side, or on opposite ones, agrees with what is known.
  bool join(std::uint32_t a, std::uint32_t b, bool opposite) {
    const Place first = of(a), second = of(b);
    const bool turned = (first.turned != second.turned) != opposite;
    if (first.set == second.set) return !turned;
    parent_[first.set] = second.set, turned_[first.set] = turned;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> turned_;  // against the parent
};

/// The middle of a thin solid. A facet that has the other side of the solid opposite is thin. Thin facets that
/// meet are on one side, those opposite each other on two. The others are the rim where they lie between the two
/// sides, and elsewhere of the side that they lie in: around a corner a side is longer outside than inside.
template <int D>
class ThinSolid {
 public:
  ThinSolid(const FacetTree<D>& boundary, double thickest)
      : tree_(boundary), thickest_(thickest), normals_(outwardNormals<D>(boundary)), sides_(boundary.size()) {}

  std::shared_ptr<const FacetTree<D>> middle(const RefuseThinSolid<D>& refuse) {
    if (!findNeighbours() || !findThinFacets()) return nullptr;
    joinSides(refuse);
    joinOthers();
    auto sheet = std::make_shared<const FacetTree<D>>(movedInward(smallerSide()));
    for (std::size_t k = 0; k < tree_.size(); ++k)
      for (const Vec<D>& corner : tree_.facet(k))
        if (sheet->nearest(corner, thickest_).facet == sheet->none)
          refuse("is too thick", "the thick part", corner);
    return sheet;
  }

 private:
  struct Pair {
    std::uint32_t a, b;
    FacetJoint<D> joint;
  };

  struct Corner {
    Block<D> squares{};
    Vec<D> right{};
    double size = 0;
    void add(const Vec<D>& normal, double area, double thickness) {
      squares.addOuter(area, normal, normal);
      right -= normal * (area * thickness / 2);
      size += area;
    }
  };

  /// Whether each two facets meet as those of a closed surface do.
  bool findNeighbours() {
    struct Meeting {
      std::uint32_t facets[2];
      int count = 0, forward = 0;
    };
    std::map<FacetJoint<D>, Meeting, JointOrder<D>> joints;
    for (std::uint32_t facet = 0; facet < tree_.size(); ++facet)
      for (std::size_t k = 0; k < D; ++k) {
        const auto [joint, forward] = jointOf<D>(tree_.facet(facet), k);
        Meeting& meeting = joints[joint];
        if (meeting.count == 2) return false;
        meeting.facets[meeting.count++] = facet, meeting.forward += forward;
      }
    for (const auto& [joint, meeting] : joints) {
      if (meeting.count != 2 || meeting.forward != 1) return false;
      neighbours_.push_back({meeting.facets[0], meeting.facets[1], joint});
    }
    return true;
  }

  /// Whether they are at least half of the surface.
  bool findThinFacets() {
    opposite_.resize(tree_.size());
    parallelFor(tree_.size(), 256, [&](std::size_t k) { opposite_[k] = lookedThrough(k); });
    double thin = 0, all = 0;
    for (std::size_t k = 0; k < tree_.size(); ++k) {
      const double size = sizeOf<D>(tree_.facet(k));
      all += size;
      if (isThin(k)) thin += size;
    }
    return thin >= 0.5 * all;
  }

  /// What is seen through the solid from the middle of a facet and from the way to each of its corners.
  struct Opposite {
    std::array<std::uint32_t, D + 1> facet;  // none: nothing, or none that is roughly parallel
    std::array<double, D> thickness{};       // of the solid at the corners
    int count = 0;
  };

  Opposite lookedThrough(std::size_t k) const {
    constexpr double parallel = -0.9, towardsCorner = 0.9;
    const Facet<D>& facet = tree_.facet(k);
    const Vec<D> middle = middleOf<D>(facet);
    Opposite seen;
    seen.facet.fill(tree_.none);
    std::array<double, D + 1> length{};
    double sum = 0;
    for (std::size_t m = 0; m <= D; ++m) {
      const Vec<D> from = m == D ? middle : middle + towardsCorner * (facet[m] - middle);
      const WayThrough way = wayThrough<D>(tree_, normals_, k, from, thickest_);
      if (way.end == tree_.none || dot(normals_[k], normals_[way.end]) > parallel) continue;
      seen.facet[m] = way.end, length[m] = way.length;
      sum += way.length, ++seen.count;
    }
    const double mean = seen.count > 0 ? sum / seen.count : 0;
    const double inMiddle = seen.facet[D] != tree_.none ? length[D] : mean;
    for (std::size_t m = 0; m < D; ++m)
      seen.thickness[m] = seen.facet[m] == tree_.none
                              ? inMiddle
                              : std::max(0.0, inMiddle + (length[m] - inMiddle) / towardsCorner);
    return seen;
  }

  bool isThin(std::size_t k) const { return opposite_[k].count >= 2; }

  /// Whether the two sides meet in a sharp edge without a rim: just beside it a way through from one ends on the
  /// other.
  bool isBlade(const Pair& p) const {
    constexpr double folded = -0.5;
    if (dot(normals_[p.a], normals_[p.b]) > folded) return false;
    const Vec<D> edge = middleOfJoint(p.joint);
    const Vec<D> beside = edge + 0.05 * (middleOf<D>(tree_.facet(p.a)) - edge);
    return wayThrough<D>(tree_, normals_, p.a, beside, thickest_).end == p.b;
  }

  static Vec<D> middleOfJoint(const FacetJoint<D>& joint) {
    Vec<D> sum{};
    for (const Vec<D>& end : joint) sum += end;
    return sum * (1.0 / joint.size());
  }

  void joinSides(const RefuseThinSolid<D>& refuse) {
    for (const Pair& p : neighbours_)
      if (isThin(p.a) && isThin(p.b) && !isBlade(p)) sides_.join(p.a, p.b, false);
    for (std::uint32_t k = 0; k < tree_.size(); ++k)
      for (const std::uint32_t other : opposite_[k].facet)
        if (other != tree_.none && isThin(k) && isThin(other) && !sides_.join(k, other, true))
          refuse("branches", "what branches off", middleOf<D>(tree_.facet(k)));
  }

  /// Patches of the other facets end at sharp corners.
  void joinOthers() {
    constexpr double smooth = 0.5;
    TwoSides patches(tree_.size());
    for (const Pair& p : neighbours_)
      if (!isThin(p.a) && !isThin(p.b) && dot(normals_[p.a], normals_[p.b]) > smooth)
        patches.join(p.a, p.b, false);
    struct Patch {
      std::optional<std::uint32_t> beside;  // a thin facet
      bool isRim = false;
      double thickness = 0;  // sum of `count` ones of facets beside it
      int count = 0;
    };
    std::map<std::uint32_t, Patch> found;
    for (const Pair& p : neighbours_) {
      if (isThin(p.a) == isThin(p.b)) continue;
      const auto [thin, other] = isThin(p.a) ? std::pair{p.a, p.b} : std::pair{p.b, p.a};
      Patch& patch = found[patches.of(other).set];
      if (patch.beside) {
        const auto first = sides_.of(*patch.beside), second = sides_.of(thin);
        patch.isRim = patch.isRim || (first.set == second.set && first.turned != second.turned);
      }
      patch.beside = thin;
      for (const double thickness : opposite_[thin].thickness) patch.thickness += thickness, ++patch.count;
    }
    for (const Pair& p : neighbours_) {
      if (isThin(p.a) == isThin(p.b)) continue;
      const auto [thin, other] = isThin(p.a) ? std::pair{p.a, p.b} : std::pair{p.b, p.a};
      if (!found[patches.of(other).set].isRim) sides_.join(thin, other, false);
    }
    isRim_.assign(tree_.size(), false);
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      if (isThin(k)) continue;
      const std::uint32_t set = patches.of(k).set;
      const auto patch = found.find(set);
      isRim_[k] = patch == found.end() || patch->second.isRim;
      if (isRim_[k]) continue;
      sides_.join(k, set, false);
      opposite_[k].thickness.fill(patch->second.thickness / patch->second.count);
    }
  }

  std::vector<bool> smallerSide() {
    std::map<std::uint32_t, double> excess;  // of the side that is turned, in size
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      if (isRim_[k]) continue;
      const auto place = sides_.of(k);
      excess[place.set] += (place.turned ? 1 : -1) * sizeOf<D>(tree_.facet(k));
    }
    std::vector<bool> kept(tree_.size());
    for (std::uint32_t k = 0; k < tree_.size(); ++k) {
      const auto place = sides_.of(k);
      kept[k] = !isRim_[k] && place.turned == (excess[place.set] <= 0);
    }
    return kept;
  }

  /// Each corner goes half of the thickness into the solid, seen from all of its facets, by least squares.
  Vec<D> wayInward(const Corner& corner) const {
    Block<D> squares = corner.squares;
    squares += Block<D>::diagonal(1e-6 * corner.size);
    return inverse(squares) * corner.right;
  }

  /// Without the facets at the end of the side that shrink to nothing: they are of a round rim. Where others do,
  /// in a corner narrower than the solid is thick, all stay where they are.
  std::vector<Facet<D>> movedInward(std::vector<bool> kept) const {
    for (;;) {
      std::map<Vec<D>, Corner, PointOrder<D>> corners;
      for (std::size_t k = 0; k < tree_.size(); ++k)
        if (kept[k])
          for (std::size_t m = 0; m < D; ++m)
            corners[tree_.facet(k)[m]].add(normals_[k], sizeOf<D>(tree_.facet(k)), opposite_[k].thickness[m]);
      std::vector<Facet<D>> moved, before;
      std::vector<bool> turned(tree_.size(), false);
      bool isSound = true;
      for (std::size_t k = 0; k < tree_.size(); ++k) {
        if (!kept[k]) continue;
        Facet<D> facet = tree_.facet(k);
        before.push_back(facet);
        for (Vec<D>& x : facet) x += wayInward(corners.at(x));
        moved.push_back(facet);
        const Vec<D> normal = facetNormal<D>(before.back());
        turned[k] = dot(facetNormal<D>(facet), normal) < 0.01 * norm2(normal);
        isSound = isSound && !turned[k];
      }
      if (isSound) return moved;
      bool isLess = false;
      for (const Pair& p : neighbours_) {
        if (kept[p.a] == kept[p.b]) continue;
        const std::uint32_t last = kept[p.a] ? p.a : p.b;
        if (turned[last]) kept[last] = false, isLess = true;
      }
      if (!isLess) return before;
    }
  }

  const FacetTree<D>& tree_;
  double thickest_;
  std::vector<Vec<D>> normals_;
  std::vector<Opposite> opposite_;
  std::vector<Pair> neighbours_;
  TwoSides sides_;
  std::vector<bool> isRim_;
};

template <int D>
ThinParts thinPartsOf(const Shape& shape, double limit) {
  const Similarity<D> similarity = similarityOf<D>(shape);
  const auto tree = facetsOf<D>(shape);
  const std::vector<WayThrough> ways = waysThrough<D>(*tree, outwardNormals<D>(*tree), limit / similarity.scale());
  std::vector<std::uint32_t> thin;
  double all = 0, part = 0;
  for (std::uint32_t k = 0; k < tree->size(); ++k) {
    const double size = sizeOf<D>(tree->facet(k));
    all += size;
    if (ways[k].end != tree->none) thin.push_back(k), part += size;
  }
  std::ranges::sort(thin, {}, [&](std::uint32_t k) { return ways[k].length; });
  double before = 0;
  for (const std::uint32_t k : thin)
    if ((before += sizeOf<D>(tree->facet(k))) >= 0.5 * part)
      return {part / all, ways[k].length * similarity.scale(),
              resized<3>(similarity.point(middleOf<D>(tree->facet(k))))};
  return {};
}

}  // namespace

ThinParts thinParts(const Shape& shape, int dimensions, double limit) {
  return dimensions == 2 ? thinPartsOf<2>(shape, limit) : thinPartsOf<3>(shape, limit);
}

template <int D>
std::shared_ptr<const FacetTree<D>> middleOfThinSolid(const FacetTree<D>& boundary, double thickest,
                                                      const RefuseThinSolid<D>& refuse) {
  return ThinSolid<D>(boundary, thickest).middle(refuse);
}

template std::shared_ptr<const FacetTree<2>> middleOfThinSolid<2>(const FacetTree<2>&, double,
                                                                  const RefuseThinSolid<2>&);
template std::shared_ptr<const FacetTree<3>> middleOfThinSolid<3>(const FacetTree<3>&, double,
                                                                  const RefuseThinSolid<3>&);

}  // namespace treacle
