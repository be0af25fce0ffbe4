#include "cut_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace treacle {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr double beyond = 1.1;  // reaches: no direction at the rim is the best one

template <int D>
Vec<D> unit(const Vec<D>& a) {
  return a * (1 / norm(a));
}

/// Spread evenly: around a circle, or on a spiral over the sphere.
template <int D>
std::vector<Vec<D>> evenDirections(int count) {
  std::vector<Vec<D>> directions;
  for (int k = 0; k < count; ++k) {
    if constexpr (D == 2) {
      const double angle = 2 * std::numbers::pi * k / count;
      directions.push_back({std::cos(angle), std::sin(angle)});
    } else {
      const double z = 1 - (2 * k + 1.0) / count, across = std::sqrt(1 - z * z);
      const double angle = 2 * std::numbers::pi * k / std::numbers::phi;
      directions.push_back({across * std::cos(angle), across * std::sin(angle), z});
    }
  }
  return directions;
}

/// Unit vectors normal to a direction and to each other.
template <int D>
std::vector<Vec<D>> normalsOf(const Vec<D>& d) {
  if constexpr (D == 2) {
    return {{-d[1], d[0]}};
  } else {
    const Vec<3> other = std::abs(d[0]) < 0.6 ? Vec<3>{1, 0, 0} : Vec<3>{0, 1, 0};
    const Vec<3> first = unit(cross(d, other));
    return {first, cross(d, first)};
  }
}

}  // namespace

/// Straight lines from one point.
template <int D>
class CutSearch<D>::Ray {
 public:
  Ray(const CutSearch& search, const Vec<D>& x, const NearWalls<D>& walls) : s_(search), x_(x), walls_(walls) {}

  bool inside(const Vec<D>& d, double t) const { return walls_.contain(x_ + d * t); }
  bool leftFor(const Vec<D>& d, double t) const { return !inside(d, t) && !inside(d, t + s_.margin_); }

  /// Between a distance inside the walls and one outside of them.
  double bisect(const Vec<D>& d, double in, double out, double tolerance) const {
    while (out - in > tolerance) {
      const double middle = (in + out) / 2;
      (inside(d, middle) ? in : out) = middle;
    }
    return out;
  }

  /// The first exit up to a distance, or none.
  double first(const Vec<D>& d, double limit, double tolerance) const {
    const double step = s_.spacing_ / 4;
    for (double t = 0; t < limit; t += step)
      if (const double next = std::min(t + step, limit); leftFor(d, next)) return bisect(d, t, next, tolerance);
    return none;
  }

  /// The exit close to a distance, or none.
  double close(const Vec<D>& d, double distance) const {
    for (const double width : {0.05, 0.4}) {
      const double in = distance * (1 - width), out = distance * (1 + width);
      if (inside(d, in) && !inside(d, out)) return bisect(d, in, out, fine());
    }
    return none;
  }

  double fine() const { return 1e-9 * s_.spacing_; }

  /// Follows the normals of the surface to where it is met at right angles. Whether there is such a place.
  bool meetNormally(Exit& exit) const {
    constexpr double angle = 0.03;
    double share = 1;
    Vec<D> before{};
    for (int k = 0; k < 40; ++k) {
      const Vec<D> normal = normalAt(exit, angle);
      if (norm2(normal) == 0) return false;
      const Vec<D> miss = normal - exit.way;
      if (norm(miss) < 2e-6) return true;
      // Where the surface bends, the whole way to the normal is too far, or too short: the last one tells.
      if (norm2(before) > 0) {
        const double gain = dot(before - miss, before) / (share * norm2(before));
        share = gain > 0 ? std::clamp(1 / gain, 0.05, 2.0) : 1;
      }
      for (;; share /= 2) {
        if (share < 1e-3) return false;
        const Vec<D> way = unit(exit.way + miss * share);
        const double distance = close(way, exit.distance);
        if (!(distance <= exit.distance + 2 * fine())) continue;
        exit = {way, distance};
        break;
      }
      before = miss;
    }
    return true;
  }

  /// For corners: tries the ways around, nearer and nearer ones.
  void meetSoonest(Exit& exit) const {
    double turn = 0;
    for (double angle = 0.1; angle > 1e-4; angle /= 2) {
      for (int k = 0; k < 40; ++k, turn += 0.7)
        if (!trySooner(exit, angle, turn)) break;
    }
  }

 private:
  /// Outward, from the points where ways on both sides meet the surface; zero: they do not.
  Vec<D> normalAt(const Exit& exit, double angle) const {
    std::vector<Vec<D>> chords;
    for (const Vec<D>& e : normalsOf(exit.way)) {
      const Vec<D> a = unit(exit.way + e * angle), b = unit(exit.way - e * angle);
      const double ta = close(a, exit.distance), tb = close(b, exit.distance);
      if (ta == none || tb == none) return {};
      chords.push_back(a * ta - b * tb);
    }
    Vec<D> normal;
    if constexpr (D == 2)
      normal = {chords[0][1], -chords[0][0]};
    else
      normal = cross(chords[0], chords[1]);
    if (norm2(normal) == 0) return {};
    return unit(dot(normal, exit.way) < 0 ? -normal : normal);
  }

  bool trySooner(Exit& exit, double angle, double turn) const {
    const std::vector<Vec<D>> e = normalsOf(exit.way);
    constexpr int tries = D == 2 ? 2 : 6;
    for (int k = 0; k < tries; ++k) {
      const double phi = turn + 2 * std::numbers::pi * k / tries;
      Vec<D> aside = e[0] * (k == 0 ? 1.0 : -1.0);
      if constexpr (D == 3) aside = e[0] * std::cos(phi) + e[1] * std::sin(phi);
      const Vec<D> way = unit(exit.way + aside * angle);
      const double sooner = exit.distance * (1 - 1e-6);
      if (!leftFor(way, sooner)) continue;
      exit = {way, first(way, sooner, fine())};
      return true;
    }
    return false;
  }

  const CutSearch& s_;
  const Vec<D>& x_;
  const NearWalls<D>& walls_;
};

template <int D>
CutSearch<D>::CutSearch(double spacing, double reach, double margin)
    : spacing_(spacing), reach_(reach), margin_(margin), directions_(evenDirections<D>(D == 2 ? 48 : 200)) {
  constexpr double neighbours = D == 2 ? 0.2 : 0.4;
  around_.resize(directions_.size());
  for (std::size_t a = 0; a < directions_.size(); ++a)
    for (std::size_t b = 0; b < directions_.size(); ++b)
      if (a != b && norm(directions_[a] - directions_[b]) < neighbours) around_[a].push_back(static_cast<int>(b));
}

template <int D>
bool CutSearch<D>::mayLeave(const Vec<D>& x, const Vec<D>& d, const NearWalls<D>& walls) const {
  for (const WallPart<D>* part : walls.parts) {
    if (!part->cut()) continue;
    if (!part->solid()) return true;
    // An image that excludes all around, as one does that sticks out of a periodic domain, leaves no surface.
    bool before = part->excludes(x);
    for (double t = spacing_ / 4; t < beyond * reach_ + spacing_ / 4; t += spacing_ / 4) {
      const bool now = part->excludes(x + d * t);
      if (now && !before) return true;
      before = now;
    }
  }
  return false;
}

template <int D>
bool CutSearch<D>::mayFind(const Vec<D>& x, const NearWalls<D>& walls) const {
  return std::ranges::any_of(directions_, [&](const Vec<D>& d) { return mayLeave(x, d, walls); });
}

/// The directions whose exits are cut ones, and nearer than those of the directions around them.
template <int D>
std::vector<typename CutSearch<D>::Start> CutSearch<D>::starts(const Vec<D>& x, const NearWalls<D>& walls) const {
  const Ray ray(*this, x, walls);
  std::vector<double> distance(directions_.size());
  for (std::size_t k = 0; k < directions_.size(); ++k) {
    const Vec<D>& d = directions_[k];
    distance[k] = mayLeave(x, d, walls) ? ray.first(d, beyond * reach_, spacing_ / 50) : none;
    if (distance[k] != none && !walls.cutAt(x + d * (distance[k] + margin_))) distance[k] = none;
  }
  std::vector<Start> starts;
  for (int k = 0; k < static_cast<int>(directions_.size()); ++k) {
    const auto key = [&](int i) { return std::pair(distance[static_cast<std::size_t>(i)], i); };
    if (key(k).first == none) continue;
    if (std::ranges::all_of(around_[static_cast<std::size_t>(k)], [&](int i) { return key(k) < key(i); }))
      starts.push_back({k, key(k).first});
  }
  std::ranges::sort(starts, {}, &Start::distance);
  constexpr std::size_t most = 8;
  if (starts.size() > most) starts.resize(most);
  return starts;
}

template <int D>
void CutSearch<D>::find(const Vec<D>& x, const NearWalls<D>& walls, std::vector<Exit>& found) const {
  for (const Start& start : starts(x, walls)) {
    Vec<D> d = directions_[static_cast<std::size_t>(start.direction)];
    // From a particle on the surface all ways out are of the same length: they are looked for from further inside.
    Vec<D> from = x;
    if (const double close = 0.05 * spacing_; start.distance < close) {
      Vec<D> out{};
      for (const Vec<D>& way : directions_)
        if (!walls.contain(x + way * (2 * close))) out += way;
      const Vec<D> inwards = norm(out) > 0.1 ? unit(-out) : Vec<D>{};
      if (norm2(inwards) > 0 && walls.contain(x + inwards * (0.25 * spacing_)))
        from = x + inwards * (0.25 * spacing_), d = -inwards;
    }
    const Ray ray(*this, from, walls);
    Exit exit{d, ray.first(d, 1.2 * reach_, ray.fine())};
    if (exit.distance == none) continue;
    if (!ray.meetNormally(exit)) {
      ray.meetSoonest(exit);
      ray.meetNormally(exit);
    }
    const Vec<D> point = from + exit.way * exit.distance;
    if (from == x)
      found.push_back(exit);
    else
      found.push_back({exit.way, std::max(0.0, dot(point - x, exit.way))});
  }
}

template class CutSearch<2>;
template class CutSearch<3>;

}  // namespace treacle
