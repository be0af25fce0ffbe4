#include "mesh_tally.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <tuple>

namespace treacle {
namespace {

using Corners = std::array<std::uint32_t, 3>;

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
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * count + 1), none), place(count);
  std::uint32_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec<3> x = t.vertices[k] + Vec<3>{};  // of -0 it makes 0
    std::size_t slot = hashOf(x) & (slots.size() - 1);
    while (slots[slot] != none && !(t.vertices[slots[slot]] == x)) slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] == none) slots[slot] = kept, t.vertices[kept++] = x;
    place[k] = slots[slot];
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
