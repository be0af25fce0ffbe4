#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/block.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/linear/chebyshev.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <bit>
#include <cstdint>

namespace treacle {

/// What the projected multigrid does with each sum over neighbours, the same on all backends. One call per
/// particle, store.put(k, sum, m) with its class m, or store.put(k, sum, store.own(k)) with what else is needed
/// of it; nothing here reads another particle, so a sum may be taken from `correction` while it is overwritten
/// elsewhere only where the text says so.

/// Per class (MphPairs::classOf), which is the material where fluids are Newtonian, in the precision of the
/// preconditioner. Walls next to gaps have a share of lambda.
template <class T>
struct ProjectionTable {
  T weight[ViscosityClasses::most];         // w: about the inverse of the diagonal of rho/dt I + V [m3 s/kg]
  T inverseLambda[ViscosityClasses::most];  // 1/lambda [1/(Pa s)]
  T shift[ViscosityClasses::most];          // pressureShift / lambda
  BulkShare share;

  /// 1/lambda and the shift of particle k of class m.
  TREACLE_HD T inverseLambdaOf(std::size_t k, std::uint8_t m) const {
    return inverseLambda[m] / static_cast<T>(share.of(k));
  }
  TREACLE_HD T shiftOf(std::size_t k, std::uint8_t m) const { return shift[m] / static_cast<T>(share.of(k)); }
};

/// S' = pressureShift Lambda^-1 + C^T W C stands for the Schur complement Lambda^-1 + C^T (rho/dt I + V)^-1 C.
/// Where pressures vary slowly, the inverse is far larger than its diagonal W, so less than Lambda^-1 stands
/// against C^T W C; anything from 0.1 to 0.3 gives the same number of iterations.
inline constexpr double pressureShift = 0.18;
/// The same for the slowly varying pressures of the background grids, where more would make the number of
/// iterations grow with the size; anything from 0.0025 to 0.02 does.
inline constexpr double gridPressureShift = 0.01;

/// The viscosity of a full lattice whose V has the mean diagonal that a diagonal block of rho/dt I + V leaves for
/// it, `resistance` being that of the lattice for 1 Pa s [1/m2]; positive, for classes go by its logarithm [Pa s].
template <int D, class T>
TREACLE_HD double resistingViscosity(const Block<D, T>& block, double inertia, double resistance) {
  double trace = 0;
  for (int k = 0; k < D; ++k) trace += static_cast<double>(block(k, k));
  return fmax((trace / D - inertia) / resistance, 1e-30);
}

/// Quantities that neighbours gather in every product. On a device in single precision, where C has no B, they
/// stand beside the position (NearProducts::fixedPosition): what is fetched at once holds both.
template <class T, class Backend>
struct ScalarField {
  T* at;
  TREACLE_HD T& operator[](std::size_t k) const { return at[k]; }
};
/// In two dimensions words 0 and 1 are the position; in three positions have 16 bits (ParticleProducts), word 0
/// and the lower half of word 1 hold them.
struct alignas(16) PlacedScalar {
  std::uint32_t word[3];
  float value;
};
template <>
struct ScalarField<float, Cuda> {
  float* at;
  std::uint32_t stride;  // 1, or 4 for the values of PlacedScalars
  TREACLE_HD float& operator[](std::size_t k) const { return at[stride * k]; }
};

template <int D, class T, class Backend>
struct VectorField {
  Gathered<D, T>* at;
  TREACLE_HD void set(std::size_t i, const Vec<D, T>& v) const { at[i] = v; }
};
template <int D>
struct PlacedVector;
template <>
struct alignas(16) PlacedVector<2> {
  std::int32_t position[2];
  float value[2];

  TREACLE_HD void set(const Vec<2, float>& v) {
    value[0] = v[0];
    value[1] = v[1];
  }
};
/// Three dimensions fit, too, where positions have 16 bits each (ParticleProducts) and numbers 26: word 0 has two
/// positions, the low six bits of the others the third one.
template <>
struct alignas(16) PlacedVector<3> {
  std::uint32_t word[4];
  static constexpr std::uint32_t low = 63;

  TREACLE_HD void set(const Vec<3, float>& v) {
    for (int k = 0; k < 3; ++k) word[k + 1] = (std::bit_cast<std::uint32_t>(v[k]) & ~low) | (word[k + 1] & low);
  }
};
template <int D>
struct VectorField<D, float, Cuda> {
  Gathered<D, float>* at;
  PlacedVector<D>* placed;  // either
  TREACLE_HD void set(std::size_t i, const Vec<D, float>& v) const {
    if (placed)
      placed[i].set(v);
    else
      at[i] = v;
  }
};

/// The three vectors of a Chebyshev smoother: residual, last correction z, iterate x.
template <class V, class Correction = V*>
struct SmootherVectors {
  V* residual;
  Correction correction;
  V* solution;
};
template <class T, class Backend>
using PressureVectors = SmootherVectors<T, ScalarField<T, Backend>>;

/// b = C^T u, less Lambda^-1 p where the iterate holds p; then the smoother's first step from zero.
template <class T, class Backend>
struct StartPressure {
  ProjectionTable<T> table;
  const std::uint8_t* material;
  const T* inverseDiagonal;
  const T* lambdaMax;
  ChebyshevStep<T> step;
  PressureVectors<T, Backend> v;
  bool holdsPressure;

  TREACLE_HD std::uint8_t own(std::size_t k) const { return material[k]; }
  TREACLE_HD void put(std::size_t k, T divergence, std::uint8_t m) const {
    T b = divergence;
    if (holdsPressure) b -= table.inverseLambdaOf(k, m) * v.solution[k];
    v.residual[k] = b;
    v.solution[k] = v.correction[k] = step.gain / *lambdaMax * inverseDiagonal[k] * b;
  }
};

/// What follows residual -= S' correction: nothing, since the residual was wanted for the coarse grid; the next
/// correction; or, in the last step, the iterate in the correction's place, because that is what is gathered next.
enum class StepKind { Residual, Next, Last };

/// residual -= S' correction, from the divergence of W C correction, and what follows.
template <class T, class Backend, StepKind Kind>
struct PressureStep {
  ProjectionTable<T> table;
  const std::uint8_t* material;
  const T* inverseDiagonal;
  const T* lambdaMax;
  ChebyshevStep<T> step;
  PressureVectors<T, Backend> v;
  ScalarField<T, Backend> next;  // another one than the correction, which neighbours may still gather

  /// What else the step needs of a particle: a device fetches it while the neighbours are on their way.
  struct Own {
    T residual, correction, solution, inverseDiagonal, lambdaMax, shift;
  };
  TREACLE_HD Own own(std::size_t k, std::uint8_t m) const {
    if constexpr (Kind == StepKind::Residual)
      return {v.residual[k], v.correction[k], 0, 0, 1, table.shiftOf(k, m)};
    return {v.residual[k], v.correction[k], v.solution[k], inverseDiagonal[k], *lambdaMax, table.shiftOf(k, m)};
  }
  TREACLE_HD Own own(std::size_t k) const { return own(k, material[k]); }

  TREACLE_HD void put(std::size_t k, T divergence, std::uint8_t m) const { put(k, divergence, own(k, m)); }
  TREACLE_HD void put(std::size_t k, T divergence, const Own& o) const {
    const T r = o.residual - (divergence + o.shift * o.correction);
    v.residual[k] = r;
    if constexpr (Kind != StepKind::Residual) {
      const T change = step.previous * o.correction + step.gain / o.lambdaMax * o.inverseDiagonal * r;
      const T x = o.solution + change;
      next[k] = Kind == StepKind::Next ? change : x;
      v.solution[k] = x;
    }
  }
};

/// y = S' x, from the divergence of W C x.
template <class T, class Backend>
struct StorePressure {
  ProjectionTable<T> table;
  const std::uint8_t* material;
  ScalarField<T, Backend> x;
  T* y;

  TREACLE_HD std::uint8_t own(std::size_t k) const { return material[k]; }
  TREACLE_HD void put(std::size_t k, T divergence, std::uint8_t m) const {
    y[k] = divergence + table.shiftOf(k, m) * x[k];
  }
};

/// y = W C q
template <int D, class T, class Backend>
struct StoreWeighted {
  ProjectionTable<T> table;
  const std::uint8_t* material;
  VectorField<D, T, Backend> y;

  TREACLE_HD std::uint8_t own(std::size_t i) const { return material[i]; }
  TREACLE_HD void put(std::size_t i, const Vec<D, T>& gradient, std::uint8_t m) const {
    y.set(i, table.weight[m] * gradient);
  }
};

/// Largest eigenvalue of the block-Jacobi scaled rho/dt I + V: a sum of positive pair terms is at most twice its
/// block diagonal, because |a - b|^2 <= 2 |a|^2 + 2 |b|^2.
inline constexpr double viscousLambdaMax = 2;

/// residual = r - C p, and the velocity smoother's first step from zero.
template <int D, class T>
struct StartVelocity {
  const Vec<D>* r;
  const Block<D, T>* inverseDiagonal;
  T gain;  // of the first step, divided by viscousLambdaMax
  SmootherVectors<Gathered<D, T>> v;

  TREACLE_HD std::uint8_t own(std::size_t) const { return 0; }
  TREACLE_HD void put(std::size_t i, const Vec<D, T>& gradient, std::uint8_t) const {
    Vec<D, T> b;
    for (int k = 0; k < D; ++k) b[k] = static_cast<T>(r[i][k]) - gradient[k];
    v.residual[i] = b;
    v.solution[i] = v.correction[i] = gain * (inverseDiagonal[i] * b);
  }
};

/// residual -= K0 correction; then, unless ResidualOnly, the next correction, into another vector: the old one is
/// still being gathered.
template <int D, class T, bool ResidualOnly>
struct VelocityStep {
  const Block<D, T>* inverseDiagonal;
  T previous, gain;  // gain divided by viscousLambdaMax
  SmootherVectors<Gathered<D, T>> v;
  Gathered<D, T>* next;

  TREACLE_HD std::uint8_t own(std::size_t) const { return 0; }
  TREACLE_HD void put(std::size_t i, const Vec<D, T>& product, std::uint8_t) const {
    const Vec<D, T> r = v.residual[i] - product;
    v.residual[i] = r;
    if constexpr (!ResidualOnly) {
      const Vec<D, T> z = previous * v.correction[i] + gain * (inverseDiagonal[i] * r);
      next[i] = z;
      v.solution[i] += z;
    }
  }
};

/// z = y - W C q: the preconditioned residual.
template <int D, class T>
struct FinishVelocity {
  ProjectionTable<T> table;
  const std::uint8_t* material;
  const Gathered<D, T>* y;
  Vec<D>* z;

  TREACLE_HD std::uint8_t own(std::size_t i) const { return material[i]; }
  TREACLE_HD void put(std::size_t i, const Vec<D, T>& gradient, std::uint8_t m) const {
    const T w = table.weight[m];
    for (int k = 0; k < D; ++k) z[i][k] = y[i][k] - w * gradient[k];
  }
};

}  // namespace treacle

/// Everything that a sum is stored by, for explicit instantiation.
#define TREACLE_FOR_EACH_STORE(D, T, Backend)                       \
  TREACLE_GRADIENT(D, T, StoreWeighted<D, T, Backend>)              \
  TREACLE_GRADIENT(D, T, StartVelocity<D, T>)                       \
  TREACLE_GRADIENT(D, T, FinishVelocity<D, T>)                      \
  TREACLE_DIVERGENCE(D, T, StartPressure<T, Backend>)               \
  TREACLE_DIVERGENCE(D, T, StorePressure<T, Backend>)               \
  TREACLE_SCHUR(D, T, PressureStep<T, Backend, StepKind::Residual>) \
  TREACLE_SCHUR(D, T, PressureStep<T, Backend, StepKind::Next>)     \
  TREACLE_SCHUR(D, T, PressureStep<T, Backend, StepKind::Last>)     \
  TREACLE_SCHUR(D, T, StorePressure<T, Backend>)                    \
  TREACLE_VISCOUS(D, T, VelocityStep<D, T, false>)                  \
  TREACLE_VISCOUS(D, T, VelocityStep<D, T, true>)
