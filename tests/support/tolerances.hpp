#pragma once

namespace treacle::test {

/// Bounds on relative, norm-wise differences; the same for all tests (docs/design.md).
inline constexpr double kernelTolerance = 10 * 2.220446049250313e-16;  // one sum against the same sum
inline constexpr double operatorTolerance = 1e-12;                     // products and assembled matrices
inline constexpr double singleTolerance = 1e-6;                        // single-precision preconditioners

}  // namespace treacle::test
