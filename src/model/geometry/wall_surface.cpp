#include "treacle/model/geometry/wall_surface.hpp"

#include "cut_search.hpp"
#include "face_corner.hpp"
#include "solid.hpp"
#include "thin_sheet.hpp"
#include "treacle/core/work_in_hand.hpp"
#include "treacle/model/geometry/wall_sight.hpp"
#include "treacle/model/particles/particles.hpp"
#include "wall_part.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <memory>

namespace treacle {
namespace {

/// A point that may be the nearest one of a surface.
template <int D>
struct Candidate {
  Vec<D> way;       // from the particle [m]
  Vec<D> out;       // unit vector from the point into what must not be wall
  double distance;  // [m]
  bool behind;      // only as the second face
  bool clear;       // all on the way to it is of the part, where the particle and its condition are
  int count;        // of the faces that meet in the point; 0: found by search, and tested there
  const WallPart<D>* part[D];
  Vec<D> normal[D];  // of these faces
};

template <int D>
using Solids = std::vector<std::unique_ptr<const Solid<D>>>;

template <int D>
Solids<D> wallSolids(const Case& c) {
  Solids<D> solids(c.bodies.size());
  for (std::size_t b = 0; b < c.bodies.size(); ++b)
    if (const Body& body = c.bodies[b]; body.isWall() && isSolid(body.shape))
      solids[b] = std::make_unique<const Solid<D>>(body.shape, c.interactionRadius(), c.spacing);
  return solids;
}

template <int D>
class SurfaceFinder {
 public:
  /// `solids`: of each body that is a polygon or mesh; they must outlive the finder.
  SurfaceFinder(const Case& c, const Solids<D>& solids)
      : spacing_(c.spacing), reach_(c.viscosityRadius()), search_(c.spacing, reach_, margin()), solids_(solids) {
    for (std::size_t b = 0; b < c.bodies.size(); ++b)
      if (c.bodies[b].shape.isThinSheet()) sheets_.emplace(b, ThinSheet<D>(c, c.bodies[b]));
    for (const Body& body : c.bodies) {
      const bool cut = isSolidWall(body) && !BodyCondition<D>::isEmpty(body);
      conditions_.push_back(cut ? std::make_unique<BodyCondition<D>>(c, body) : nullptr);
    }
    for (std::size_t b = 0; b < c.bodies.size(); ++b)
      if (isSolidWall(c.bodies[b])) addImages(c.domain, c.bodies[b], b);
    around_.resize(c.bodies.size());
    const Vec<D> far = Vec<D>::filled(reach_ + margin());
    for (std::size_t b = 0; b < c.bodies.size(); ++b) {
      if (!isSolidWall(c.bodies[b])) continue;
      const WallPart<D> own(c.bodies[b], {}, nullptr, solids_[b].get(), spacing_);
      for (const Part& part : parts_)
        if ((part.body == b || moveAlike(c.bodies[b], c.bodies[part.body])) &&
            part.wall.touches(own.min() - far, own.max() + far))
          around_[b].push_back(&part.wall);
    }
  }

  WallSurface<D> at(const Vec<D>& x, std::size_t body) {
    if (const auto sheet = sheets_.find(body); sheet != sheets_.end()) return ofSheet(sheet->second, x);
    const Vec<D> far = Vec<D>::filled(reach_);
    near_.parts.clear();
    for (const WallPart<D>* part : around_[body])
      if (part->touches(x - far, x + far)) near_.parts.push_back(part);
    candidates_.clear();
    addPoints(x);
    if (near_.parts.size() > 1) addCorners(x);
    if (near_.cutIn(x - far, x + far) && search_.mayFind(x, near_)) addExits(x);
    return chosen(x);
  }

 private:
  struct Part {
    std::size_t body;
    WallPart<D> wall;
  };
  struct NearFace {
    const WallPart<D>* part;
    const Face<D>* face;
  };

  static bool isSolidWall(const Body& body) { return body.isWall() && !body.shape.isThinSheet(); }

  WallSurface<D> ofSheet(const ThinSheet<D>& sheet, const Vec<D>& x) const {
    const auto place = sheet.at(x, 2 * reach_);
    WallSurface<D> surface{};
    if (place.side != sides::None)
      surface.face[0] = converted<float>(place.normal * std::max(place.distance, margin()));
    return surface;
  }

  /// What is nearer than this counts as touching [m].
  double margin() const { return 1e-3 * spacing_; }

  void addImages(const Domain& domain, const Body& body, std::size_t b) {
    Vec<D> low{}, shift{};
    for (int k = 0; k < D; ++k) low[k] = domain.periodic[static_cast<std::size_t>(k)] ? -1 : 0;
    Vec<D> image = low;
    for (int k = 0; k < D;) {
      for (int m = 0; m < D; ++m) shift[m] = image[m] * (domain.max[m] - domain.min[m]);
      parts_.push_back({b, WallPart<D>(body, shift, conditions_[b].get(), solids_[b].get(), spacing_)});
      for (k = 0; k < D; ++k) {
        if (++image[k] <= -low[k]) break;
        image[k] = low[k];
      }
    }
  }

  /// The points of faces at right angles above the particle.
  void addPoints(const Vec<D>& x) {
    faces_.clear();
    const bool several = near_.parts.size() > 1;
    for (const WallPart<D>* part : near_.parts) {
      const auto add = [&](double distance, const Vec<D>& n, bool behind, bool clear) {
        if (distance <= reach_) candidates_.push_back({n * distance, n, distance, behind, clear, 1, {part}, {n}});
      };
      if (part->solid()) {
        ways_.clear();
        part->solid()->ways(x - part->shift(), reach_, several, ways_);
        for (const auto& way : ways_) add(way.distance, way.out, false, way.clear && !part->cut());
        if (!several) continue;
      }
      for (const Face<D>& face : part->faces()) {
        const auto [height, normal] = face.at(x);
        if (std::abs(height) <= reach_) faces_.push_back({part, &face});
        if (part->solid()) continue;
        // Rounding may put a particle of the surface outside.
        if (height <= 1e-5 * spacing_) add(std::max(0.0, -height), normal, false, part->convex());
        // A thin rod has fluid behind its axis, too.
        if (const auto behind = face.behind(x)) add(behind->distance, behind->normal, true, part->convex());
      }
    }
  }

  /// The points where faces of different walls meet. In a concave corner none of them need have a point at right
  /// angles above the particle that is not covered by the others.
  void addCorners(const Vec<D>& x) {
    for (std::size_t a = 0; a < faces_.size(); ++a)
      for (std::size_t b = a + 1; b < faces_.size(); ++b) {
        if (faces_[a].part == faces_[b].part) continue;
        addCorner<2>(x, {faces_[a], faces_[b]});
        if constexpr (D == 3)
          for (std::size_t c = b + 1; c < faces_.size(); ++c)
            if (faces_[c].part != faces_[a].part && faces_[c].part != faces_[b].part)
              addCorner<3>(x, {faces_[a], faces_[b], faces_[c]});
      }
  }

  template <int N>
  void addCorner(const Vec<D>& x, const std::array<NearFace, N>& faces) {
    std::array<const Face<D>*, N> bare;
    std::ranges::transform(faces, bare.begin(), &NearFace::face);
    corners_.clear();
    findCorners<D, N>(x, bare, reach_, spacing_, corners_);
    for (const FaceCorner<D>& corner : corners_) {
      Candidate<D> candidate{corner.way, corner.out, norm(corner.way), false, false, N, {}, {}};
      for (std::size_t i = 0; i < N; ++i)
        candidate.part[i] = faces[i].part, candidate.normal[i] = corner.normal[i];
      candidates_.push_back(candidate);
    }
  }

  void addExits(const Vec<D>& x) {
    exits_.clear();
    search_.find(x, near_, exits_);
    for (const auto& exit : exits_)
      if (exit.distance <= reach_)
        candidates_.push_back({exit.way * exit.distance, exit.way, exit.distance, false, false, 0, {}, {}});
  }

  /// Whether the walls end in a point, and reach from the particle to it.
  bool valid(const Vec<D>& x, const Candidate<D>& a) const {
    const Vec<D> point = x + a.way;
    for (int i = 0; i < a.count; ++i)
      if (!a.part[i]->contains(point - a.normal[i] * margin())) return false;
    if (a.count > 0 && near_.contain(point + a.out * margin())) return false;
    if (a.clear && a.part[0]->contains(x)) return true;
    const double pieces = std::ceil(4 * a.distance / spacing_);
    for (int k = 1; k < pieces; ++k)
      if (!near_.contain(x + a.way * (k / pieces))) return false;
    return true;
  }

  WallSurface<D> chosen(const Vec<D>& x) {
    // Formulas are more exact than a search: of two that find the same point they are to be the first.
    const auto rank = [&](const Candidate<D>& a) { return a.distance + (a.count == 0 ? margin() : 0); };
    std::ranges::sort(candidates_, {}, rank);
    WallSurface<D> surface{};
    Vec<D> first{};
    for (const Candidate<D>& a : candidates_) {
      const bool second = norm2(first) > 0;
      if (a.behind && !second) continue;
      // A particle on the surface has no distance to it; its direction is enough.
      const bool near = a.distance < margin();
      const Vec<D> direction = near ? a.out : a.way * (1 / a.distance);
      if (second && dot(direction, first) > 0.5 + 1e-6) continue;
      if (!valid(x, a)) continue;
      const Vec<D> way = near ? a.out * margin() : a.way;
      for (int k = 0; k < D; ++k) surface.face[second ? 1 : 0][k] = static_cast<float>(way[k]);
      if (second) break;
      first = direction;
    }
    return surface;
  }

  double spacing_, reach_;  // [m]
  CutSearch<D> search_;
  const Solids<D>& solids_;
  std::map<std::size_t, ThinSheet<D>> sheets_;  // by body
  std::vector<std::unique_ptr<BodyCondition<D>>> conditions_;
  std::vector<Part> parts_;
  std::vector<std::vector<const WallPart<D>*>> around_;  // of each body: what its particles can see
  // These belong to the particle at hand.
  NearWalls<D> near_;
  std::vector<typename Solid<D>::Way> ways_;
  std::vector<NearFace> faces_;
  std::vector<FaceCorner<D>> corners_;
  std::vector<Candidate<D>> candidates_;
  std::vector<typename CutSearch<D>::Exit> exits_;
};

}  // namespace

template <int D>
std::vector<WallSurface<D>> createWallSurfaces(const Case& c, std::span<const Vec<D>> position,
                                               std::span<const std::uint8_t> body,
                                               std::vector<std::string>& notes) {
  std::vector<WallSurface<D>> surfaces(position.size());
  // One finder for each thread: neither expressions nor what a finder keeps are for several at once.
  constexpr std::size_t share = 1000;
  const std::size_t most = 1 + position.size() / share;
  const int threads =
      static_cast<int>(std::min<std::size_t>(most, static_cast<std::size_t>(omp_get_max_threads())));
  const Solids<D> solids = wallSolids<D>(c);
  std::deque<SurfaceFinder<D>> finders;
  for (int k = 0; k < threads; ++k) finders.emplace_back(c, solids);
  constexpr std::size_t some = 64;
  WorkInHand work("finding the surfaces of walls", position.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (std::size_t begin = 0; begin < position.size(); begin += some) {
    const std::size_t end = std::min(begin + some, position.size());
    for (std::size_t k = begin; k < end; ++k)
      surfaces[k] = finders[static_cast<std::size_t>(omp_get_thread_num())].at(position[k], body[k]);
    work.add(end - begin);
  }

  noteBlindWalls(c, wallSight<D>(c, body, surfaces), notes);
  return surfaces;
}

template std::vector<WallSurface<2>> createWallSurfaces<2>(const Case&, std::span<const Vec<2>>,
                                                           std::span<const std::uint8_t>,
                                                           std::vector<std::string>&);
template std::vector<WallSurface<3>> createWallSurfaces<3>(const Case&, std::span<const Vec<3>>,
                                                           std::span<const std::uint8_t>,
                                                           std::vector<std::string>&);

}  // namespace treacle
