#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/vec.hpp"

#include <algorithm>
#include <cstdint>

namespace treacle {

/// Whether a solve takes a quarter more iterations than the best one so far, which `fewest` keeps; 0: none yet.
inline bool takesLonger(std::int32_t iterations, std::int32_t& fewest) {
  const std::int32_t before = fewest == 0 ? iterations : fewest;
  fewest = std::min(before, iterations);
  return iterations >= before + std::max(2, before / 4);
}

/// When the modes of a solver are to be taken anew: after so many solves, or when one takes a quarter more
/// iterations than the best since the last time. The first solve of a run, from rest and without a guess, is not
/// like the others.
struct ModeAge {
  static constexpr std::int32_t longest = 50, shortest = 10;  // solves with the same modes

  std::int32_t due = 1;     // solves until then; negative: there are some worth taking
  std::int32_t fewest = 0;  // iterations that one of the solves since the last time took; 0: not known

  bool isDue() const { return due <= 0; }
  bool areWorthTaking() const { return due < 0; }
  void foundWorthTaking() { due = -1; }
  void taken() { *this = {longest, 0}; }
  /// After a solve with the present modes, or without any.
  void solved(std::int32_t iterations) {
    --due;
    if (takesLonger(iterations, fewest) && due <= longest - shortest) due = 0;
  }

  bool operator==(const ModeAge&) const = default;
};

/// The largest eigenvalue that the pressure smoother is scaled by. Over ten steps it grew by 5 % at most in the
/// dam breaks, and what it is estimated with leaves 10 %; an estimate takes as long as a third of an iteration's
/// products.
struct KeptEigenvalue {
  static constexpr std::int32_t longest = 10;  // solves with the same value

  double value = 0;         // 0: not known
  std::int32_t due = 0;     // solves until it is estimated anew
  std::int32_t fewest = 0;  // iterations that a solve took, of all since one took longer; 0: not known

  bool isKnown() const { return value > 0 && due > 0; }
  void estimated(double largest) { *this = {largest, longest, fewest}; }
  /// After a solve: one that takes more iterations than others may have outgrown the value. When fluid meets a
  /// wall the value may grow in each of several steps.
  void solved(std::int32_t iterations) {
    --due;
    if (takesLonger(iterations, fewest)) due = 0, fewest = iterations;
  }

  bool operator==(const KeptEigenvalue&) const = default;
};

/// Displacements that the preconditioner of MPH-I's solver does badly at, and that its solves are deflated by.
/// They change slowly with the flow, so they are carried along by its particles.
template <int D, class Backend = Cpu>
struct SolverModes {
  Buffer<Vec<D, float>, Backend> vectors;  // of the fluid, one mode after the other; none: not deflated
  ModeAge age;
  KeptEigenvalue pressure;

  /// All but the vectors, which are a field of the particles.
  template <class Other>
  void copyNumbers(const SolverModes<D, Other>& from) {
    age = from.age;
    pressure = from.pressure;
  }
  /// Without any, as at the start of a run.
  void drop() {
    vectors = {};
    age = {};
  }
};

}  // namespace treacle
