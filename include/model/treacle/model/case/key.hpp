#pragma once

#include "treacle/model/case/names.hpp"

#include <concepts>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace treacle {

/// What a number, or the number of entries of a list, may be.
struct Bound {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;             // without these two
  std::string_view reason = "";  // what speaks against others, for messages

  /// Not for what is not finite.
  bool holds(double x) const;
};

/// A key of a case file.
struct Key {
  std::string_view name;
  std::string_view about;      // what it is: a sentence without its full stop
  bool required = false;       // else there is a default, what the member is at first
  std::string_view unit = "";  // of its numbers
  Bound bound{};
};

/// What is expected of a key, e.g. "a positive number [s]", "a whole number of at least 1", "an array of 2 finite
/// numbers [m]".
std::string expectedNumber(const Key& key, bool orAuto = false, bool orExpression = false);
std::string expectedNumbers(const Key& key);
std::string expectedFunction(const Key& key);
std::string expectedInteger(const Key& key);
std::string expectedVector(const Key& key, int dimensions, bool orExpressions = false);
std::string expectedPoints(const Key& key);
std::string expectedEntries(const Key& key);

/// "expected a positive number [s], found 0".
std::string mismatch(const Key& key, const std::string& expected, const std::string& found);

/// The words of an enumeration for the values that fit.
template <class E, class Fits>
std::vector<std::string_view> wordsThat(Fits&& fits) {
  std::vector<std::string_view> words;
  for (const Named<E>& n : namesOf<E>)
    if (fits(n.value)) words.push_back(n.name);
  return words;
}

namespace keys {

inline constexpr bool required = true, optional = false;
inline constexpr Bound positive{.least = 0, .open = true}, notNegative{.least = 0}, disorder{0, 0.45};
// Beyond these a step or a solve would take as good as for ever.
inline constexpr Bound radius{.least = 0, .most = 20, .open = true}, iterations{1, 1e6}, sweeps{1, 1000},
    degree{0, 1000}, stepTolerance{1e-6, 0.5}, flowIndex{.least = 0, .most = 5, .open = true};
inline constexpr Bound mobility{0, 1}, extensibility{.least = 0, .most = 10, .open = true};
inline constexpr Bound reactionOrder{0, 5}, conversion{0, 1}, gelFactor{1, 1e9}, solidFactor{1, 1e9};
// Beyond it the power of a fast shear would overflow; fluids have 0.1 to 5.
inline constexpr Bound yasuda{.least = 0, .most = 20, .open = true};
inline constexpr Bound regularisation{
    .least = 0, .open = true, .reason = "a yield stress without it would make a fluid at rest infinitely viscous"};
inline constexpr struct ExpressionTag {
} expression;
/// A text that need not be there.
inline constexpr struct FormulaTag {
} formula;
inline constexpr struct MaterialTag {
} material;
inline constexpr struct FileTag {
} file;
inline constexpr struct OrAutoTag {
} orAuto;
struct AllFit {
  constexpr bool operator()(auto) const { return true; }
};

/// A T to be read into, or one that stays as it is.
template <class M, class T>
concept Like = std::same_as<std::remove_const_t<M>, T>;

}  // namespace keys
}  // namespace treacle
