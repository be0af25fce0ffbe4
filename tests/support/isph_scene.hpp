#pragma once

#include "support/scene.hpp"
#include "treacle/isph/isph_sums.hpp"
#include "treacle/linear/lanczos_scalars.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace treacle::test {

/// Particles of ISPH after the sort, with their neighbours, densities and free surface.
template <int D>
struct IsphScene {
  Case c;
  Particles<D> particles;
  Context<Cpu> context;
  IsphPairs<D> pairs;  // looks at the members around it
  CellRanges<> ranges;
  SortWorkspace<> workspace;
  NeighbourRows<> fluidOfFluid, wallsOfFluid, fluidOfWalls;
  Buffer<double> density;
  Buffer<Vec<D>> deficit;
  Buffer<std::uint8_t> surface;
  Buffer<SymmetricBlock<D, float>> renormalisation, acrossWalls;
  Buffer<float> missing;

  IsphScene(const Case& theCase, Particles<D> state);

  /// B', after each DensityTerm.
  void findAcrossWalls() {
    if (pairs.wallSurface) sumBesideWalls(context, pairs, AcrossWallsTerm<D>{});
  }
  std::uint32_t n() const { return particles.fluidCount; }
  std::uint32_t surfaceCount() const {
    return n() - static_cast<std::uint32_t>(std::count(surface.begin(), surface.end(), Place::Inside));
  }

 private:
  NeighbourRowsView find(RowKind kind, NeighbourRows<>& rows);
};

/// At rest, of the first material and body.
template <int D>
Particles<D> particlesAt(const std::vector<Vec<D>>& fluid, const std::vector<Vec<D>>& wall = {});

/// The points of a lattice of spacing l with one at `first`; the first axis runs fastest.
template <int D>
std::vector<Vec<D>> latticeAt(const Vec<D>& first, const Vec<D, int>& count, double l);

/// Water with a spacing of 1 cm in an open domain of `size` spacings from the origin on.
Case waterCase(int dimensions, const Vec<3>& size);

/// A jittered body of two fluids of unequal density and viscosity, moving at random, on a floor that moves, too
/// (or without it); it lies across periodic ends.
template <int D>
IsphScene<D> makeIsphScene(Walls walls = Walls::Floor, double jitter = 0.1, unsigned seed = 1);

/// Surfaces for all walls, in no order: one face above each particle, tilted, and for some a second one beside it.
template <int D>
void giveSurfaces(const Case& c, Particles<D>& particles);

/// More than enough fluid for every way in which kernels share work, on a floor, free of symmetries.
template <int D>
IsphScene<D> makeLargeIsphScene();

/// Regions of fluid of all shapes, with gaps between them, some across a periodic end. `surface` is set by chance,
/// so that some regions have none.
template <int D>
IsphScene<D> makeRegions(unsigned seed);

/// Random numbers in (-1, 1), the same for the same seed.
std::vector<double> randomNumbers(std::size_t n, unsigned seed);
template <int D>
std::vector<Vec<D>> randomVelocities(std::size_t n, unsigned seed);

/// A matrix of pairs and what it is made of, not packed.
template <int D, class T>
struct IsphTestSystem {
  Buffer<T> coefficient, inverseNear;
  Buffer<double> diagonal;
  Buffer<IsphMoments<D>> moments;
  IsphMatrix<T> a;

  template <class Row>
  IsphTestSystem(IsphScene<D>& s, const Row& row)
      : coefficient(s.pairs.fluidEntries), inverseNear(s.n()), diagonal(s.n()), moments(s.n()) {
    IsphMatrixParts<D, T> parts{};
    parts.coefficient = coefficient;
    parts.unit = row.largest(s.pairs) / 255;
    parts.diagonal = diagonal;
    parts.inverseNear = inverseNear;
    parts.moments = moments;
    fillIsphMatrix(s.context, s.pairs, row, parts);
    a.rows = s.n();
    a.start = s.pairs.fluidOfFluid.start;
    a.column = s.pairs.fluidOfFluid.column;
    a.coefficient = coefficient.data();
    a.unit = parts.unit;
    a.diagonal = diagonal.data();
    a.inverseNear = inverseNear.data();
  }
  IsphTestSystem(const IsphTestSystem&) = delete;
};

template <class T>
Matrix dense(const IsphMatrix<T>& a);

}  // namespace treacle::test
