#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace treacle {

/// How an element g B d of C, a vector, stands in a word of 32 or 64 bits: as whole numbers of a unit. Opposite
/// vectors have opposite numbers, so that C and C^T are each other's transpose whatever is rounded. The last of
/// three numbers in 32 bits has a bit less than the others, and counts twice the unit.
template <int D, class Word>
struct ElementBits {
  static constexpr bool wide = sizeof(Word) == 8;
  static constexpr int bits = wide ? 21 : D == 2 ? 16 : 11;
  static constexpr bool lastIsShort = !wide && D == 3;
  static constexpr int lastBits = lastIsShort ? bits - 1 : bits;
  static constexpr double lastUnit = lastIsShort ? 2 : 1;
  static constexpr double largest = (1 << (bits - 1)) - 2;  // magnitude in units

  static constexpr int bitsOf(int k) { return k == D - 1 ? lastBits : bits; }
  static constexpr double unitOf(int k) { return k == D - 1 ? lastUnit : 1; }
};

/// Of a vector in units, rounded; numbers have half of their range added.
template <int D, class Word>
TREACLE_HD inline Word packElement(const Vec<D, float>& v) {
  using Bits = ElementBits<D, Word>;
  Word word = 0;
  for (int k = 0; k < D; ++k) {
    const int number = static_cast<int>(rintf(v[k] * static_cast<float>(1 / Bits::unitOf(k))));
    word |= static_cast<Word>(static_cast<unsigned>(number + (1 << (Bits::bitsOf(k) - 1)))) << Bits::bits * k;
  }
  return word;
}

/// Its numbers, the last in a unit of its own. One among the low bits of 2^23 is 2^23 and that number.
template <int D, class Word>
TREACLE_HD inline Vec<D, float> unpackElement(Word word) {
  using Bits = ElementBits<D, Word>;
  constexpr unsigned magic = 0x4b000000;
  Vec<D, float> v;
  for (int k = 0; k < D; ++k) {
    const auto number = static_cast<unsigned>(word >> Bits::bits * k) & ((1u << Bits::bitsOf(k)) - 1);
    v[k] = std::bit_cast<float>(number | magic) - static_cast<float>((1 << 23) + (1 << (Bits::bitsOf(k) - 1)));
  }
  return v;
}

/// What was summed up of such numbers, or is to meet them, all in one unit.
template <int D, class Word>
TREACLE_HD inline Vec<D, float> inUnits(Vec<D, float> v) {
  v[D - 1] *= static_cast<float>(ElementBits<D, Word>::lastUnit);
  return v;
}

/// No element of C is larger: B has no eigenvalue above 1, or 1 / leastSlipMoment where fluid slips [1/m].
template <int D>
double largestElement(const MphPairs<D>& pairs);

/// In stiffer systems (ProjectionConstants) 32 bits are too few: pressures that C hardly sees would drown in what
/// the elements are rounded by. With 1.6e4 in three dimensions 64 iterations instead of 21, with 500 residuals
/// twice as large.
template <int D>
inline constexpr double mostPackedStiffness = D == 2 ? 1e5 : 250;

}  // namespace treacle
