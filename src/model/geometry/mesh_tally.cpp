#include "mesh_tally.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace treacle {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr double weldReach = 1e-6;  // of the size of a mesh

std::uint64_t hashOf(const Vec<3>& x) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ std::bit_cast<std::uint64_t>(x[k])) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

/// Entries in one list, those with the same key behind each other: `first[key]` is the place of the first.
template <class Entry>
struct Buckets {
  std::vector<std::uint32_t> first;
  std::vector<Entry> entries;

  /// each(put) calls put(key, entry) for all of them, and does so twice.
  template <class Each>
  Buckets(std::size_t keys, Each&& each) : first(keys + 2) {
    each([&](std::uint32_t key, const Entry&) { ++first[key + 2]; });
    for (std::size_t k = 2; k < first.size(); ++k) first[k] += first[k - 1];
    entries.resize(first.back());
    each([&](std::uint32_t key, const Entry& entry) { entries[first[key + 1]++] = entry; });
  }
};

/// With the smallest corner first.
Corners turned(Corners c) {
  std::rotate(c.begin(), std::ranges::min_element(c), c.end());
  return c;
}

}  // namespace

void weld(Triangles& t) {
  constexpr std::uint32_t none = ~0u;
  const std::size_t count = t.vertices.size();
  if (count == 0) return;
  Vec<3> min = t.vertices[0], max = min;
  for (const Vec<3>& x : t.vertices)
    for (int k = 0; k < 3; ++k) min[k] = std::min(min[k], x[k]), max[k] = std::max(max[k], x[k]);
  const double reach = weldReach * norm(max - min), edge = 16 * reach;
  // Vertices that are kept are in lists of the cells of a grid, whose edge is that.
  const auto cellOf = [&](const Vec<3>& x) {
    Vec<3> cell{};
    if (edge > 0)
      for (int k = 0; k < 3; ++k) cell[k] = std::floor((x[k] - min[k]) / edge);
    return cell;
  };
  std::vector<std::uint32_t> lists(std::bit_ceil(2 * count + 1), none), next(count, none), place(count);
  const auto listOf = [&](const Vec<3>& cell) -> std::uint32_t& {
    return lists[hashOf(cell) & (lists.size() - 1)];
  };
  const auto isNear = [&](const Vec<3>& a, const Vec<3>& b) {
    return a == b ||
           (std::abs(a[0] - b[0]) <= reach && std::abs(a[1] - b[1]) <= reach && std::abs(a[2] - b[2]) <= reach);
  };
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < count; ++v) {
    const Vec<3> x = t.vertices[v] + Vec<3>{};  // of -0 it makes 0
    const Vec<3> low = cellOf(x - Vec<3>::filled(reach)), high = cellOf(x + Vec<3>::filled(reach));
    std::uint32_t same = none;
    for (double i = low[0]; i <= high[0]; ++i)
      for (double j = low[1]; j <= high[1]; ++j)
        for (double k = low[2]; k <= high[2]; ++k)
          for (std::uint32_t other = listOf({i, j, k}); other != none; other = next[other])
            if (isNear(t.vertices[other], x)) same = std::min(same, other);
    if (same == none) {
      std::uint32_t& list = listOf(cellOf(x));
      next[kept] = std::exchange(list, kept);
      same = kept;
      t.vertices[kept++] = x;
    }
    place[v] = same;
  }
  t.vertices.resize(kept);
  for (Corners& c : t.corners)
    for (std::uint32_t& v : c) v = place[v];
}

std::vector<std::uint32_t> repeated(const Triangles& t) {
  struct Entry {
    std::uint32_t second, third, triangle;
  };
  Buckets<Entry> buckets(t.vertices.size(), [&](auto&& put) {
    for (std::uint32_t k = 0; k < t.corners.size(); ++k) {
      const Corners c = turned(t.corners[k]);
      put(c[0], Entry{c[1], c[2], k});
    }
  });
  std::vector<std::uint32_t> found;
  for (std::size_t v = 0; v < t.vertices.size(); ++v) {
    const auto begin = buckets.entries.begin() + buckets.first[v],
               end = buckets.entries.begin() + buckets.first[v + 1];
    std::sort(begin, end, [](const Entry& a, const Entry& b) {
      return std::tie(a.second, a.third, a.triangle) < std::tie(b.second, b.third, b.triangle);
    });
    for (auto e = begin; e != end; ++e)
      if (e != begin && e->second == (e - 1)->second && e->third == (e - 1)->third) found.push_back(e->triangle);
  }
  std::ranges::sort(found);
  return found;
}

void tallyEdges(const Triangles& t, MeshFacts& facts) {
  struct Entry {
    std::uint32_t other;
    std::int32_t way;  // 1: from the smaller index to the larger one
  };
  Buckets<Entry> buckets(t.vertices.size(), [&](auto&& put) {
    for (const Corners& c : t.corners)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = c[k], b = c[(k + 1) % 3];
        if (a != b) put(std::min(a, b), Entry{std::max(a, b), a < b ? 1 : -1});
      }
  });
  for (std::uint32_t v = 0; v < t.vertices.size(); ++v) {
    const auto begin = buckets.entries.begin() + buckets.first[v],
               end = buckets.entries.begin() + buckets.first[v + 1];
    std::sort(begin, end, [](const Entry& a, const Entry& b) { return a.other < b.other; });
    for (auto e = begin; e != end;) {
      const std::uint32_t other = e->other;
      int uses = 0, ways = 0;
      for (; e != end && e->other == other; ++e) ++uses, ways += e->way;
      if (ways == 0) continue;
      const Vec<3> middle = 0.5 * (t.vertices[v] + t.vertices[other]);
      if (uses % 2 != 0) {
        if (facts.openEdges++ == 0) facts.opening = middle;
      } else if (facts.turnedEdges++ == 0) {
        facts.turned = middle;
      }
    }
  }
}

}  // namespace treacle
