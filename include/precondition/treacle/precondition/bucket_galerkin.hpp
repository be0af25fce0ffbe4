#pragma once

#include "treacle/linear/block_csr.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/search/buckets.hpp"

namespace treacle {

/// A^0 = R A P [K23 eq. (35)] on the occupied search cells, from pair sums; A itself is not needed. Only adjacent
/// cells couple, because the cell edge is at least max(h_v, 2 h_p). `columns`: workspace, 2^D vectors per
/// particle. Where processes share the simulation: a process's part of A^0, of which all parts are the sum; the
/// levels have buckets of ghosts, too (SharedBuckets::local), and rows of own buckets have all their columns.
template <int D>
void bucketGalerkin(Context<Cpu>&, const MphPairs<D>&, const CellRanges<>&, const BucketLevels<>&,
                    const WallTerms<D>&, Buffer<Vec<D>>& columns, BlockCsr<D>& a0);
template <int D>
void bucketGalerkin(Context<Cuda>&, const MphPairs<D>&, const CellRanges<Cuda>&, const BucketLevels<Cuda>&,
                    const WallTerms<D>&, Buffer<Vec<D>, Cuda>& columns, BlockCsr<D, double, Cuda>& a0);

}  // namespace treacle
