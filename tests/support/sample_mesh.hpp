#pragma once

#include "treacle/model/geometry/mesh.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace treacle::test {

/// A ball around the origin: an icosahedron whose faces are parted in four, `times` times.
inline Triangles ballMesh(double radius, int times) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  Triangles m;
  m.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  m.corners = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(m.vertices.size()));
      if (isNew) m.vertices.push_back(0.5 * (m.vertices[a] + m.vertices[b]));
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : m.corners) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& corners : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(corners);
    }
    m.corners = std::move(finer);
    for (Vec<3>& x : m.vertices) x *= 1 / norm(x);
  }
  for (Vec<3>& x : m.vertices) x *= radius / norm(x);
  return m;
}

/// Of twelve triangles.
inline Triangles boxMesh(const Vec<3>& min, const Vec<3>& max) {
  Triangles m;
  for (int k = 0; k < 8; ++k)
    m.vertices.push_back({k & 1 ? max[0] : min[0], k & 2 ? max[1] : min[1], k & 4 ? max[2] : min[2]});
  m.corners = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// A solid of revolution around z. `outline`: radius and height, from the axis below around the outside to the
/// axis above.
inline Triangles turnedMesh(const std::vector<Vec<2>>& outline, int segments) {
  Triangles m;
  const auto n = static_cast<std::uint32_t>(segments);
  for (const Vec<2>& x : outline)
    for (int k = 0; k < segments; ++k) {
      const double angle = 2 * std::acos(-1.0) * k / segments;
      m.vertices.push_back({x[0] * std::cos(angle), x[0] * std::sin(angle), x[1]});
    }
  for (std::uint32_t i = 0; i + 1 < outline.size(); ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = i * n + k, b = i * n + (k + 1) % n, c = b + n, d = a + n;
      if (outline[i][0] > 0) m.corners.push_back({a, b, outline[i + 1][0] > 0 ? c : d});
      if (outline[i + 1][0] > 0) m.corners.push_back({a, c, d});
    }
  return m;
}

inline void append(Triangles& m, const Triangles& other) {
  const auto first = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto corners : other.corners) {
    for (std::uint32_t& c : corners) c += first;
    m.corners.push_back(corners);
  }
}

inline Shape meshShape(const Triangles& triangles, FillKind fill = FillKind::Inside, double thickness = 0) {
  Shape shape;
  shape.kind = ShapeKind::Mesh;
  shape.file.path = "/sample.stl";
  shape.file.mesh.value = std::make_shared<const Mesh>(triangles);
  shape.fill = fill, shape.thickness = thickness;
  return shape;
}

/// As a binary STL.
inline std::string stlText(const Triangles& m) {
  std::string text(80, ' ');
  const auto put = [&](const auto& value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(m.corners.size()));
  for (const auto& corners : m.corners) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const std::uint32_t c : corners)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(m.vertices[c][k]));
    put(std::uint16_t{0});
  }
  return text;
}

}  // namespace treacle::test
