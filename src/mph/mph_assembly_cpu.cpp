#include "treacle/mph/mph_assembly.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/mph_neighbours.hpp"

#include <algorithm>
#include <vector>

namespace treacle {
namespace {

/// Column indices of row i, ascending: i and the fluid particles that V or C Lambda C^T can couple to it.
template <int D>
void rowPattern(const MphPairs<D>& pairs, std::uint32_t i, std::vector<std::uint32_t>& columns) {
  const double radius2 = couplingRadius2(pairs);
  columns.clear();
  for (ListSegment s : fluidSegments)
    forEachEntry(pairs, i, s, [&](std::uint32_t j, const Vec<D>& d) {
      if (norm2(d) <= radius2) columns.push_back(j);
    });
  std::sort(columns.begin(), columns.end());
}

/// Writes the blocks of one row. `slot`: per fluid particle its place in the row, or none.
template <bool Renormalised, int D>
class RowAssembler {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  RowAssembler(const MphPairs<D>& pairs, const GradientRows<D>& rows)
      : pairs_(pairs), rows_(rows), slot_(pairs.fluidCount, none) {}

  void write(std::uint32_t i, std::span<const std::uint32_t> columns, std::span<Block<D>> blocks,
             const Block<D>& ownBlock) {
    for (std::uint32_t k = 0; k < columns.size(); ++k) slot_[columns[k]] = k;
    std::fill(blocks.begin(), blocks.end(), Block<D>{});
    blocks[slot_[i]] += ownBlock;
    addViscosity(i, blocks);
    addPressure(i, blocks);
    for (std::uint32_t c : columns) slot_[c] = none;
  }

 private:
  void addViscosity(std::uint32_t i, std::span<Block<D>> blocks) {
    const double h2 = pairs_.terms.viscosityRadius * pairs_.terms.viscosityRadius;
    for (ListSegment s : fluidSegments)
      forEachEntry(pairs_, i, s, [&](std::uint32_t j, const Vec<D>& d) {
        const double r2 = norm2(d);
        if (r2 >= h2 || r2 == 0) return;
        const double mu = pairs_.viscosityOf(i, j);
        const double c = pairs_.terms.viscous(mu * pairs_.terms.viscousFactor, ExactDistance(r2));
        blocks[slot_[j]].addOuter(-c, d, d);
        blocks[slot_[i]].addOuter(c, d, d);
      });
  }

  /// Row i of C Lambda C^T: over the pressures k that particle i feels, their columns of C.
  void addPressure(std::uint32_t i, std::span<Block<D>> blocks) {
    Vec<D> own{};
    for (std::uint64_t m = rows_.rowStart[i]; m < rows_.rowStart[i + 1]; ++m) {
      own += rows_.value[m];
      addColumn(rows_.column[m], rows_.value[m], blocks);
    }
    addColumn(i, own, blocks);
  }

  /// blocks += lambda_k c_ik c_jk^T over the fluid particles j of column k; c_jk = -B_k g_kj, c_kk = B_k sum_j
  /// g_kj. `gik`: B_k^-1 c_ik.
  void addColumn(std::uint32_t k, const Vec<D>& gik, std::span<Block<D>> blocks) {
    const double lambda = pairs_.bulkViscosity(k);
    const Vec<D> cik = times(k, gik);
    Vec<D> own{};
    for (std::uint64_t m = rows_.rowStart[k]; m < rows_.rowStart[k + 1]; ++m) {
      own += rows_.value[m];
      addBlock(rows_.column[m], -lambda, cik, times(k, rows_.value[m]), blocks);
    }
    addBlock(k, lambda, cik, times(k, own), blocks);
  }

  /// B_k v
  Vec<D> times(std::uint32_t k, const Vec<D>& v) const { return Renormalised ? pairs_.corrected(k, v) : v; }

  void addBlock(std::uint32_t j, double factor, const Vec<D>& a, const Vec<D>& b, std::span<Block<D>> blocks) {
    // Walls have no column. A fluid particle without a slot is 2 h_p away to rounding, where the weights vanish.
    if (j < pairs_.fluidCount && slot_[j] != none) blocks[slot_[j]].addOuter(factor, a, b);
  }

  const MphPairs<D>& pairs_;
  const GradientRows<D>& rows_;
  std::vector<std::uint32_t> slot_;
};

/// body(begin, end) for shares of the rows that are worth memory of their own.
template <class F>
void forRowsInShares(std::uint32_t rows, F&& body) {
  constexpr std::uint32_t share = 256;
  parallelFor((rows + share - 1) / share, 2, [&](std::size_t s) {
    const auto begin = static_cast<std::uint32_t>(s) * share;
    body(begin, std::min(rows, begin + share));
  });
}

template <bool Renormalised, int D>
void writeRows(const MphPairs<D>& pairs, const WallTerms<D>& terms, const GradientRows<D>& rows, BlockCsr<D>& a) {
  forRowsInShares(pairs.fluidCount, [&](std::uint32_t begin, std::uint32_t end) {
    std::vector<std::uint32_t> columns;
    RowAssembler<Renormalised, D> assembler(pairs, rows);
    for (std::uint32_t i = begin; i < end; ++i) {
      rowPattern(pairs, i, columns);
      std::copy(columns.begin(), columns.end(), a.column.begin() + a.rowStart[i]);
      assembler.write(i, columns, a.value.span().subspan(a.rowStart[i], columns.size()), terms.block[i]);
    }
  });
}

}  // namespace

template <int D>
void assemble(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms, const GradientRows<D>& rows,
              BlockCsr<D>& a) {
  const std::uint32_t n = pairs.fluidCount;
  a.rowStart.resize(n + 1);
  a.rowStart[0] = 0;
  forRowsInShares(n, [&](std::uint32_t begin, std::uint32_t end) {
    std::vector<std::uint32_t> columns;
    for (std::uint32_t i = begin; i < end; ++i) {
      rowPattern(pairs, i, columns);
      a.rowStart[i + 1] = columns.size();
    }
  });
  for (std::uint32_t i = 0; i < n; ++i) a.rowStart[i + 1] += a.rowStart[i];
  a.column.resize(a.rowStart[n]);
  a.value.resize(a.rowStart[n]);

  withRenormalisation(pairs, [&]<bool Renormalised>() { writeRows<Renormalised>(pairs, terms, rows, a); });
}

template <int D>
void diagonalBlocks(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                    std::span<Block<D>> diagonal) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  const auto sumUp = [&]<bool Renormalised, bool Scaled>(const auto& mph) {
    forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
      const ViscosityLanes<D, Scaled> viscosity(pairs, range);
      Lanes block[D][D] = {};
      VecLanes<D> own = {};
      const auto add = [&](std::uint32_t j, bool wall) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = mph.gradient(pair.r);
        Lanes f = pairs.bulkViscosity(j) * g * g;  // lambda_j C_ij C_ij^T
        if constexpr (Renormalised) {
          const VecLanes<D> bd = corrected(pairs, j, pair.d);
          for (int r = 0; r < D; ++r)
            for (int k = 0; k < D; ++k) block[r][k] += f * bd[r] * bd[k];
          f = Lanes{};
        }
        if (!wall)  // the viscous part of walls stands in terms.block
          f += mph.viscous(viscosity.with(j), pair.r);
        for (int r = 0; r < D; ++r) {
          own[r] += g * pair.d[r];
          for (int k = 0; k < D; ++k) block[r][k] += f * pair.d[r] * pair.d[k];
        }
      };
      for (std::uint32_t j : list.segment(c, ListSegment::NearFluid)) add(j, false);
      for (std::uint32_t j : list.segment(c, ListSegment::FarFluid)) add(j, false);
      for (std::uint32_t j : list.segment(c, ListSegment::NearWall)) add(j, true);

      for (std::uint32_t lane = 0; lane < range.count; ++lane) {
        const std::uint32_t i = range.first + lane;
        Block<D> sum = terms.block[i];
        Vec<D> cii{};
        for (int r = 0; r < D; ++r) {
          cii[r] = own[r][lane];
          for (int k = 0; k < D; ++k) sum(r, k) += block[r][k][lane];
        }
        if constexpr (Renormalised) cii = pairs.corrected(i, cii);
        sum.addOuter(pairs.bulkViscosity(i), cii, cii);
        diagonal[i] = sum;
      }
    });
  };
  withScheme(pairs.terms, [&](const auto& mph) {
    withRenormalisation(pairs, [&]<bool Renormalised>() {
      pairs.viscosityScale ? sumUp.template operator()<Renormalised, true>(mph)
                           : sumUp.template operator()<Renormalised, false>(mph);
    });
  });
}

#define TREACLE_INSTANTIATE(D)                                                                              \
  template void assemble<D>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, const GradientRows<D>&, \
                            BlockCsr<D>&);                                                                  \
  template void diagonalBlocks<D>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, std::span<Block<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
