#include "treacle/isph/isph_sums.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {
namespace {

template <int D, class Term>
void sumAround(const IsphPairs<D>& pairs, std::uint32_t i, const Term& term) {
  const Vec<D> x = pairs.position[i];
  double sum[Term::values] = {};
  pairs.fluidOfFluid.forEachPlace(i, [&](std::uint64_t k) {
    const std::uint32_t j = pairs.fluidOfFluid.column[k];
    const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
    term.fluid(pairs, i, j, d, Distance(d), sum);
  });
  pairs.wallsOfFluid.forEachPlace(i, [&](std::uint64_t k) {
    const std::uint32_t j = pairs.wallsOfFluid.column[k];
    const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
    term.wall(pairs, i, j, d, Distance(d), sum);
  });
  term.store(pairs, i, sum);
}

}  // namespace

template <int D, class Term, class Backend>
void sumOnFluid(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term) {
  parallelFor(pairs.ownFluid(), parallelGrain,
              [&](std::size_t i) { sumAround(pairs, static_cast<std::uint32_t>(i), term); });
}

template <int D, class Term, class Backend>
void sumBesideWalls(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term) {
  parallelFor(pairs.ownFluid(), parallelGrain, [&](std::size_t row) {
    const auto i = static_cast<std::uint32_t>(row);
    if (pairs.wallsOfFluid.isEmpty(i))
      term.storeAway(pairs, i);
    else
      sumAround(pairs, i, term);
  });
}

template <int D, class Term, class Backend>
void sumOnWalls(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term) {
  parallelFor(pairs.fluidOfWalls.count, parallelGrain, [&](std::size_t row) {
    const std::uint32_t i = pairs.fluidOfWalls.first + static_cast<std::uint32_t>(row);
    double sum[Term::values] = {};
    pairs.fluidOfWalls.forEachPlace(static_cast<std::uint32_t>(row), [&](std::uint64_t k) {
      const std::uint32_t j = pairs.fluidOfWalls.column[k];
      const Vec<D> d = pairs.grid.difference(pairs.position[i], pairs.position[j]);
      term.fluid(pairs, i, j, d, Distance(d), sum);
    });
    term.store(pairs, i, sum);
  });
}

template <int D, class T, class Row, class Backend>
void fillIsphMatrix(Context<Backend>&, const IsphPairs<D>& pairs, const Row& row,
                    const IsphMatrixParts<D, T>& parts) {
  const IsphMatrixRow<D, T, Row> filler{pairs, row, parts};
  const std::uint64_t farBegin = pairs.fluidOfFluid.start[pairs.fluidOfFluid.count];
  parallelFor(pairs.ownFluid(), parallelGrain, [&](std::size_t index) {
    const auto i = static_cast<std::uint32_t>(index);
    double sum[filler.values] = {};
    pairs.fluidOfFluid.forEachPlace(i, [&](std::uint64_t k) {
      filler.entry(i, pairs.position[i], k, k < farBegin, sum,
                   [&](std::uint32_t, double c) { return parts.put(k, c); });
    });
    pairs.wallsOfFluid.forEachPlace(i, [&](std::uint64_t k) { filler.wall(i, pairs.position[i], k, sum); });
    filler.finish(i, sum);
  });
}

TREACLE_ISPH_SUMS(2, Cpu)
TREACLE_ISPH_SUMS(3, Cpu)

}  // namespace treacle
