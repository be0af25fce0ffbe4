#pragma once

#include "treacle/linear/block_csr.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// One level of the V-cycle on buckets, in the backend's memory.
template <int D, class T>
struct BucketLevel {
  BlockCsrView<D, T> a;
  const Vec<D, T>* inverseDiagonal;
  const std::uint32_t* members;  // first member (particle or finer bucket) of each bucket, and the end
  const std::uint32_t* parent;   // the bucket of each member
};

/// Right-hand side, iterate, and where a sweep writes, of `columns` vectors, one after the other: a cycle has one,
/// what turns levels into a matrix many.
template <int D, class T>
struct BucketVectors {
  Vec<D, T>*b, *x, *next;
  std::uint32_t columns = 1;
};

/// What a sweep adds to the iterate first: P e of the next coarser level.
template <int D, class T>
struct BucketCorrection {
  const BucketLevel<D, T>& level;
  const Vec<D, T>* e;
};

// The operations that a V-cycle consists of [K23 sect. 3.2]; one kernel each.

/// The bucket of each member.
template <class Backend>
void findParents(Context<Backend>&, std::span<const std::uint32_t> members, std::span<std::uint32_t> parent);

/// b = R r over particles that are unknowns (`inverse` is not zero), x = D^-1 b, the first sweep from zero.
template <int D, class T, class Backend>
void bucketRestrict(Context<Backend>&, const BucketLevel<D, T>& level, std::span<const Vec<D, T>> inverse,
                    std::span<const Vec<D>> r, const BucketVectors<D, T>& v);

/// b = the unit vectors from `first` on, one per column; x = D^-1 b.
template <int D, class T, class Backend>
void bucketUnits(Context<Backend>&, const BucketLevel<D, T>& level, std::uint32_t first,
                 const BucketVectors<D, T>& v);

/// next = y + D^-1 (b - A y) [K23 eq. (42)], y = x or, with a correction, x + P e; x may be changed.
template <int D, class T, class Backend>
void bucketSweep(Context<Backend>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                 const BucketCorrection<D, T>* correction = nullptr);

/// coarse b = R (b - A x), and the first sweep there, coarse x = D^-1 b.
template <int D, class T, class Backend>
void bucketRestrictResidual(Context<Backend>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                            const BucketLevel<D, T>& coarse, const BucketVectors<D, T>& coarseV);

/// z = diag(inverse) r + P x per particle; zero where the inverse is.
template <int D, class T, class Backend>
void bucketProlong(Context<Backend>&, const BucketLevel<D, T>& level, const Vec<D, T>* x,
                   std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);

/// M = (M + M^T) / 2 of a square matrix of n rows.
template <class T, class Backend>
void symmetrise(Context<Backend>&, std::uint32_t n, T* matrix);

/// The same matrix in another precision.
template <int D, class T, class Backend>
void convert(Context<Backend>&, const BlockCsr<D, double, Backend>& from, BlockCsr<D, T, Backend>& to);

/// Galerkin operator of the next coarser level by summation, A^{r+1} = R A^r P [K23 eq. (38)]. `members`: first
/// fine row of each coarse one, and the end. On a device a row may have up to 3^D coarse columns (D = 1: 27), as
/// adjacent buckets do; more: RunError.
template <int D, class T, class Backend>
void coarsen(Context<Backend>&, const BlockCsr<D, T, Backend>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T, Backend>& coarse);

#define TREACLE_BUCKET_CYCLE(D, T, Backend)                                                                     \
  template void bucketRestrict(Context<Backend>&, const BucketLevel<D, T>&, std::span<const Vec<D, T>>,         \
                               std::span<const Vec<D>>, const BucketVectors<D, T>&);                            \
  template void bucketUnits(Context<Backend>&, const BucketLevel<D, T>&, std::uint32_t,                         \
                            const BucketVectors<D, T>&);                                                        \
  template void bucketSweep(Context<Backend>&, const BucketLevel<D, T>&, const BucketVectors<D, T>&,            \
                            const BucketCorrection<D, T>*);                                                     \
  template void bucketRestrictResidual(Context<Backend>&, const BucketLevel<D, T>&, const BucketVectors<D, T>&, \
                                       const BucketLevel<D, T>&, const BucketVectors<D, T>&);

}  // namespace treacle
