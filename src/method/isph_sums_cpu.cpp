#include "treacle/method/isph_sums.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D, class Term>
void sumOnFluid(Context<Cpu>&, const IsphPairs<D>& pairs, const Term& term) {
  parallelFor(pairs.fluidCount, parallelGrain, [&](std::size_t row) {
    const auto i = static_cast<std::uint32_t>(row);
    const Vec<D> x = pairs.position[i];
    double sum[Term::values] = {};
    pairs.fluidRows.forEachPlace(i, [&](std::uint64_t k) {
      const std::uint32_t j = pairs.fluidRows.column[k];
      const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
      term.fluid(pairs, i, j, d, Distance(d), sum);
    });
    pairs.wallRows.forEachPlace(i, [&](std::uint64_t k) {
      const std::uint32_t j = pairs.wallRows.column[k];
      const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
      term.wall(pairs, i, j, d, Distance(d), sum);
    });
    term.store(pairs, i, sum);
  });
}

template <int D, class Term>
void sumOnWalls(Context<Cpu>&, const IsphPairs<D>& pairs, const Term& term) {
  parallelFor(pairs.wallsOwn.count, parallelGrain, [&](std::size_t row) {
    const std::uint32_t i = pairs.wallsOwn.first + static_cast<std::uint32_t>(row);
    double sum[Term::values] = {};
    pairs.wallsOwn.forEachPlace(static_cast<std::uint32_t>(row), [&](std::uint64_t k) {
      const std::uint32_t j = pairs.wallsOwn.column[k];
      const Vec<D> d = pairs.grid.difference(pairs.position[i], pairs.position[j]);
      term.fluid(pairs, i, j, d, Distance(d), sum);
    });
    term.store(pairs, i, sum);
  });
}

template <int D, class T, class Row>
void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>& pairs, const Row& row, const PairMatrixParts<D, T>& parts) {
  const PairMatrixRow<D, T, Row> filler{pairs, row, parts};
  parallelFor(pairs.fluidCount, parallelGrain, [&](std::size_t index) {
    const auto i = static_cast<std::uint32_t>(index);
    double sum[filler.values] = {};
    pairs.fluidRows.forEachPlace(i, [&](std::uint64_t k) { filler.entry(i, pairs.position[i], k, sum); });
    pairs.wallRows.forEachPlace(i, [&](std::uint64_t k) { filler.wall(i, pairs.position[i], k, sum); });
    filler.finish(i, sum);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&, const DensityTerm<D>&);        \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&, const PredictorTerm<D>&);      \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&,                                \
                           const BothTerms<DensityTerm<D>, PredictorTerm<D>>&);               \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&, const ViscousSourceTerm<D>&);  \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&, const PressureSourceTerm<D>&); \
  template void sumOnFluid(Context<Cpu>&, const IsphPairs<D>&, const CorrectorTerm<D>&);      \
  template void sumOnWalls(Context<Cpu>&, const IsphPairs<D>&, const WallPressureTerm<D>&);   \
  template void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>&, const PressureRow<D>&,     \
                               const PairMatrixParts<D, double>&);                            \
  template void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>&, const PressureRow<D>&,     \
                               const PairMatrixParts<D, float>&);                             \
  template void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>&, const ViscousRow<D>&,      \
                               const PairMatrixParts<D, double>&);                            \
  template void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>&, const ViscousRow<D>&,      \
                               const PairMatrixParts<D, float>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
