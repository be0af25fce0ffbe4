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
void findParents(Context<Cpu>&, std::span<const std::uint32_t> members, std::span<std::uint32_t> parent);
void findParents(Context<Cuda>&, std::span<const std::uint32_t> members, std::span<std::uint32_t> parent);

/// b = R r over particles that are unknowns (`inverse` is not zero), x = D^-1 b, the first sweep from zero.
template <int D, class T>
void bucketRestrict(Context<Cpu>&, const BucketLevel<D, T>& level, std::span<const Vec<D, T>> inverse,
                    std::span<const Vec<D>> r, const BucketVectors<D, T>& v);
template <int D, class T>
void bucketRestrict(Context<Cuda>&, const BucketLevel<D, T>& level, std::span<const Vec<D, T>> inverse,
                    std::span<const Vec<D>> r, const BucketVectors<D, T>& v);

/// b = the unit vectors from `first` on, one per column; x = D^-1 b.
template <int D, class T>
void bucketUnits(Context<Cpu>&, const BucketLevel<D, T>& level, std::uint32_t first, const BucketVectors<D, T>& v);
template <int D, class T>
void bucketUnits(Context<Cuda>&, const BucketLevel<D, T>& level, std::uint32_t first,
                 const BucketVectors<D, T>& v);

/// next = y + D^-1 (b - A y) [K23 eq. (42)], y = x or, with a correction, x + P e; x may be changed.
template <int D, class T>
void bucketSweep(Context<Cpu>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                 const BucketCorrection<D, T>* correction = nullptr);
template <int D, class T>
void bucketSweep(Context<Cuda>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                 const BucketCorrection<D, T>* correction = nullptr);

/// coarse b = R (b - A x), and the first sweep there, coarse x = D^-1 b.
template <int D, class T>
void bucketRestrictResidual(Context<Cpu>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                            const BucketLevel<D, T>& coarse, const BucketVectors<D, T>& coarseV);
template <int D, class T>
void bucketRestrictResidual(Context<Cuda>&, const BucketLevel<D, T>& level, const BucketVectors<D, T>& v,
                            const BucketLevel<D, T>& coarse, const BucketVectors<D, T>& coarseV);

/// z = diag(inverse) r + P x per particle; zero where the inverse is.
template <int D, class T>
void bucketProlong(Context<Cpu>&, const BucketLevel<D, T>& level, const Vec<D, T>* x,
                   std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);
template <int D, class T>
void bucketProlong(Context<Cuda>&, const BucketLevel<D, T>& level, const Vec<D, T>* x,
                   std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r, std::span<Vec<D>> z);

/// M = (M + M^T) / 2 of a square matrix of n rows.
template <class T>
void symmetrise(Context<Cpu>&, std::uint32_t n, T* matrix);
template <class T>
void symmetrise(Context<Cuda>&, std::uint32_t n, T* matrix);

/// The same matrix in another precision.
template <int D, class T>
void convert(Context<Cpu>&, const BlockCsr<D>& from, BlockCsr<D, T>& to);
template <int D, class T>
void convert(Context<Cuda>&, const BlockCsr<D, double, Cuda>& from, BlockCsr<D, T, Cuda>& to);

/// Galerkin operator of the next coarser level by summation, A^{r+1} = R A^r P [K23 eq. (38)]. `members`: first
/// fine row of each coarse one, and the end.
template <int D, class T>
void coarsen(Context<Cpu>&, const BlockCsr<D, T>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T>& coarse);
/// On the device a row may have up to 3^D coarse columns (D = 1: 27), as adjacent buckets do; more: RunError.
template <int D, class T>
void coarsen(Context<Cuda>&, const BlockCsr<D, T, Cuda>& fine, std::span<const std::uint32_t> members,
             BlockCsr<D, T, Cuda>& coarse);

}  // namespace treacle
