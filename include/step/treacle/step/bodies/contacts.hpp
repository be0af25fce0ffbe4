#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/touching_cells.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace treacle {

/// Where a rigid body touches another body, or may do so in a step.
template <int D>
struct Contact {
  Vec<D> place{};        // of a particle of the rigid body [m]
  Vec<D> normal{};       // from the other body to this one, of length 1
  double gap = 0;        // between their surfaces; negative where they overlap [m]
  std::uint32_t id = 0;  // of the particle
  std::uint8_t body = 0, other = 0;
};

/// What contacts are found from: the active walls of a sorted state; memory of the backend.
template <int D>
struct ContactSearch {
  CellGrid<D> grid;
  CellRangesView cells;
  const Vec<D>* position;         // of all particles [m]
  const std::uint8_t* body;       // likewise
  const std::uint32_t* id;        // likewise
  const WallSurface<D>* surface;  // of the active walls, as they are now; null: not known
  std::uint32_t wallBegin;
  BodySet rigid;
  double spacing;  // l [m]

  /// Whether particle i of a wall is of a rigid body and near another body, with the place where the two are
  /// nearest. A pair of particles stands for what their surfaces are there, planes: the bodies are apart by the
  /// largest distance along one of the normals, as convex bodies are.
  TREACLE_HD bool find(std::uint32_t i, Contact<D>& contact) const {
    if (!rigid.has(body[i])) return false;
    const Vec<D> x = position[i];
    bool found = false;
    forEachAdjacentCell(grid, grid.cellOf(x), [&](const Vec<D, int>& cell) {
      const std::size_t at = grid.linear(cell);
      for (std::uint32_t j = cells.wallBegin[at]; j < cells.wallEnd[at]; ++j) {
        if (body[j] == body[i]) continue;
        const Vec<D> away = -grid.difference(x, position[j]);  // from j to i
        if (norm2(away) > reach * reach * spacing * spacing) continue;
        const Contact<D> pair = between(i, j, away);
        const bool nearer = !found || pair.gap < contact.gap || (pair.gap == contact.gap && id[j] < contact.id);
        if (pair.gap > widest * spacing || !nearer) continue;
        found = true;
        contact = pair;
        contact.id = id[j];  // until all are looked at, so that the order does not matter
      }
    });
    contact.id = id[i];
    return found;
  }

 private:
  static constexpr double reach = 2.5;   // of particles of two surfaces half a spacing deep that near [l]
  static constexpr double widest = 1.0;  // no step leads farther [l]

  /// How far a body reaches along a direction beyond its particle i: to its surfaces there, which are no farther
  /// than their planes; half a spacing where they are not known.
  TREACLE_HD double depth(std::uint32_t i, const Vec<D>& direction) const {
    double most = -1;
    if (surface)
      for (const Vec<D, float>& face : surface[i - wallBegin].face) {
        const Vec<D> toFace{converted<double>(face)};
        if (norm2(toFace) > 0) most = std::fmax(most, dot(toFace, direction));
      }
    return most < 0 ? 0.5 * spacing : most;
  }

  TREACLE_HD Contact<D> between(std::uint32_t i, std::uint32_t j, const Vec<D>& away) const {
    Contact<D> c;
    c.place = position[i], c.body = body[i], c.other = body[j];
    c.gap = -reach * spacing;
    bool known = false;
    const auto tryNormal = [&](const Vec<D>& n) {
      const double gap = dot(n, away) - depth(j, n) - depth(i, -1.0 * n);
      if (known && gap <= c.gap) return;
      known = true, c.gap = gap, c.normal = n;
    };
    if (surface)
      for (const std::uint32_t k : {i, j})
        for (const Vec<D, float>& face : surface[k - wallBegin].face) {
          const Vec<D> toFace{converted<double>(face)};
          const double length = norm(toFace);
          if (length > 0) tryNormal(((k == j ? 1 : -1) / length) * toFace);
        }
    if (!known) tryNormal((1 / norm(away)) * away);
    return c;
  }
};

/// The contacts of own particles [begin, end), in their order. Errors: std::bad_alloc.
template <int D, class Backend>
std::vector<Contact<D>> findContacts(Context<Backend>&, const ContactSearch<D>& search, std::uint32_t begin,
                                     std::uint32_t end);

}  // namespace treacle
