#include "fill_field.hpp"

#include "case/block_key.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace treacle {
namespace {

constexpr int nodes = FillField::blockNodes;
constexpr int nodesInAll = nodes * nodes * nodes;
constexpr double splineReach = 2;  // [spacings]

/// Radius of the ball that a particle fills at least, by the share at its place: one alone has 0.30, in a row
/// 0.44, in a layer 0.67, at a corner of a lattice 0.58. Triangles cut so much off a small ball that one of the
/// volume of a particle, which has 0.62, must be larger [spacings].
float ballRadius(double share, double node) {
  constexpr double lonely = 0.45, among = 0.52;
  return static_cast<float>((0.53 + 0.45 * node) * std::clamp((among - share) / (among - lonely), 0.0, 1.0));
}

/// How far nodes are from the corners of their grid cells. Nothing that is placed well, a lattice or a wall, meets
/// them exactly then: crossings at nodes make slivers.
constexpr double offset = 0.37;

/// B-spline of third order; the argument in spacings.
double spline(double x) {
  x = std::abs(x);
  if (x < 1) return 2.0 / 3 - x * x * (1 - x / 2);
  const double rest = std::max(splineReach - x, 0.0);
  return rest * rest * rest / 6;
}

/// What particles make of the nodes of a block.
struct BlockSums {
  std::array<float, nodesInAll> share{};  // how much of them is filled
  std::array<float, nodesInAll> ball{};   // 1/2 at the surface of the nearest ball, more inside

  /// A particle at this place, from the first node on, with a ball of this radius [spacings]. False: it is too far
  /// away.
  bool add(const Vec<3, float>& at, float radius, double node) {
    std::array<std::array<float, nodes>, 3> weight, square;
    const double reach = splineReach / node;
    for (std::size_t k = 0; k < 3; ++k) {
      const float place = at[static_cast<int>(k)];
      if (!(place > -reach && place < nodes - 1 + reach)) return false;
      for (std::size_t n = 0; n < nodes; ++n) {
        const double x = (static_cast<double>(n) - place) * node;
        weight[k][n] = static_cast<float>(spline(x)), square[k][n] = static_cast<float>(x * x);
      }
    }
    for (std::size_t x = 0; x < nodes; ++x)
      for (std::size_t y = 0; y < nodes; ++y) {
        const float w = weight[0][x] * weight[1][y], d = square[0][x] + square[1][y];
        if (w == 0) continue;
        const std::size_t row = (x * nodes + y) * nodes;
        for (std::size_t z = 0; z < nodes; ++z) share[row + z] += w * weight[2][z];
        if (radius == 0) continue;
        for (std::size_t z = 0; z < nodes; ++z)
          ball[row + z] = std::max(ball[row + z], radius + 0.5F - std::sqrt(d + square[2][z]));
      }
    return true;
  }
};

}  // namespace

FillField::FillField(const std::vector<Vec<3>>& position, double spacing, double node)
    : spacing_(spacing), node_(node), reach_(splineReach / node) {
  sort(position);
  choose();
}

void FillField::sort(const std::vector<Vec<3>>& position) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(position.size());
  const double perNode = 1 / (spacing_ * node_);
  const auto nodesOf = [&](const Vec<3>& x, std::size_t k) { return x[static_cast<int>(k)] * perNode - offset; };
  for (std::size_t i = 0; i < position.size(); ++i) {
    Block block{};
    bool isNear = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = std::floor(nodesOf(position[i], k) / nodes);
      isNear = isNear && std::abs(at) < mostBlocks;
      if (isNear) block[k] = static_cast<int>(at);
    }
    if (isNear) order.emplace_back(keyOf(block), static_cast<std::uint32_t>(i));
  }
  leftOut_ = position.size() - order.size();
  std::sort(order.begin(), order.end());
  // Nodes are counted from the first one, since meshes are in single precision.
  if (!order.empty()) origin_ = blockOf(order.front().first);
  points_.reserve(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto [absolute, particle] = order[i];
    Block block = blockOf(absolute);
    Point point{{}, 0, particle};
    for (std::size_t k = 0; k < 3; ++k) {
      point.nodes[static_cast<int>(k)] =
          static_cast<float>(nodesOf(position[particle], k) - nodes * double(block[k]));
      block[k] -= origin_[k];
    }
    if (i == 0 || absolute != order[i - 1].first) {
      keys_.push_back(keyOf(block));
      begin_.push_back(static_cast<std::uint32_t>(i));
    }
    points_.push_back(point);
  }
  begin_.push_back(static_cast<std::uint32_t>(points_.size()));
}

std::size_t FillField::find(const Block& block) const {
  const std::uint64_t key = keyOf(block);
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
  return found != keys_.end() && *found == key ? static_cast<std::size_t>(found - keys_.begin()) : keys_.size();
}

/// Whether each eighth of it has half the particles of a lattice.
bool FillField::isFull(std::size_t block) const {
  std::array<double, 8> count{};
  for (std::uint32_t i = begin_[block]; i < begin_[block + 1]; ++i) {
    std::size_t part = 0;
    for (int k = 0; k < 3; ++k) part = 2 * part + (points_[i].nodes[k] < nodes / 2 ? 0 : 1);
    ++count[part];
  }
  return *std::ranges::min_element(count) >= std::pow(nodes / 2 * node_, 3) / 2;
}

void FillField::choose() {
  std::vector<char> full(keys_.size() + 1, 0), deep(keys_.size(), 0);
  parallelFor(keys_.size(), parallelGrain, [&](std::size_t b) { full[b] = isFull(b); });
  parallelFor(keys_.size(), parallelGrain, [&](std::size_t b) {
    bool all = true;
    forEachNeighbour(blockOf(keys_[b]), [&](const Block& n) { all = all && full[find(n)]; });
    deep[b] = all;
  });
  findBalls(deep);
  std::vector<std::uint64_t> near;
  for (std::size_t b = 0; b < keys_.size(); ++b) {
    if (deep[b])
      inside_.push_back(blockOf(keys_[b]));
    else
      forEachNeighbour(blockOf(keys_[b]), [&](const Block& n) { near.push_back(keyOf(n)); });
  }
  std::ranges::sort(near);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const std::uint64_t key : near) {
    const std::size_t b = find(blockOf(key));
    if (b == keys_.size() || !deep[b]) computed_.push_back(blockOf(key));
  }
}

void FillField::findBalls(const std::vector<char>& deep) {
  parallelForDynamic(keys_.size(), 2, 16, [&](std::size_t b) {
    if (deep[b]) return;
    const Block block = blockOf(keys_[b]);
    for (std::uint32_t i = begin_[b]; i < begin_[b + 1]; ++i) {
      Vec<3> at = converted<double>(points_[i].nodes);
      for (int k = 0; k < 3; ++k) at[k] += nodes * double(block[static_cast<std::size_t>(k)]);
      double share = 0;
      forEachAround(at, [&](std::uint32_t, double weight) { share += weight; });
      points_[i].ball = ballRadius(share, node_);
    }
  });
}

bool FillField::values(const Block& block, float* out) const {
  BlockSums sums;
  bool any = false;
  forEachNeighbour(block, [&](const Block& from) {
    const std::size_t b = find(from);
    if (b == keys_.size()) return;
    Vec<3, float> shift{};
    for (std::size_t k = 0; k < 3; ++k)
      shift[static_cast<int>(k)] = static_cast<float>(nodes * (from[k] - block[k]));
    for (std::uint32_t i = begin_[b]; i < begin_[b + 1]; ++i)
      any = sums.add(points_[i].nodes + shift, points_[i].ball, node_) || any;
  });
  for (std::size_t k = 0; k < nodesInAll; ++k) out[k] = outside - std::max(sums.share[k], sums.ball[k]);
  return any;
}

Vec<3> FillField::place(const Vec<3>& at) const {
  Vec<3> x{};
  for (int k = 0; k < 3; ++k)
    x[k] = (at[k] + offset + nodes * double(origin_[static_cast<std::size_t>(k)])) * node_ * spacing_;
  return x;
}

void FillField::forEachAround(const Vec<3>& at, const std::function<void(std::uint32_t, double)>& f) const {
  Block first, last;
  for (std::size_t k = 0; k < 3; ++k) {
    first[k] = static_cast<int>(std::floor((at[static_cast<int>(k)] - reach_) / nodes));
    last[k] = static_cast<int>(std::floor((at[static_cast<int>(k)] + reach_) / nodes));
  }
  for (int x = first[0]; x <= last[0]; ++x)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int z = first[2]; z <= last[2]; ++z) {
        const std::size_t b = find({x, y, z});
        if (b == keys_.size()) continue;
        const Vec<3> inBlock = at - static_cast<double>(nodes) * Vec<3>{double(x), double(y), double(z)};
        for (std::uint32_t i = begin_[b]; i < begin_[b + 1]; ++i) {
          double weight = 1;
          for (int k = 0; k < 3 && weight > 0; ++k) weight *= spline((points_[i].nodes[k] - inBlock[k]) * node_);
          if (weight > 0) f(points_[i].particle, weight);
        }
      }
}

}  // namespace treacle
