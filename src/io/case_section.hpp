#pragma once

#include "suggestion.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/names.hpp"

#include <toml++/toml.h>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

enum class Bound { Positive, NonNegative, Any };

/// Keys that a table has in other cases, and what they belong to.
struct ForeignKeys {
  std::vector<std::string_view> keys;
  std::string owner;
};

/// A vector that may have expressions (model/expression.hpp) in place of numbers.
struct Formulas {
  Vec<3> number{};
  std::array<std::string, 3> text;  // empty: a number
};

/// One table of a case file with typed, checked access. Every error names the place, the key, what was found and
/// what was expected. A value without a fallback is required. The table must outlive the section.
class Section {
 public:
  /// `title`: how messages call the table, e.g. "[domain]". Errors: InputError for a key that is not in `keys`;
  /// that for a foreign one says whose it is.
  Section(const toml::table& table, std::string title, const std::vector<std::string_view>& keys,
          const ForeignKeys& foreign = {});

  bool has(std::string_view key) const { return table_->contains(key); }
  const toml::table& table() const { return *table_; }

  double number(std::string_view key, Bound bound, std::string_view unit,
                std::optional<double> fallback = {}) const;
  int integer(std::string_view key, int least, std::optional<int> fallback = {}) const;
  std::string string(std::string_view key, std::optional<std::string> fallback = {}) const;
  Vec<3> vector(std::string_view key, int dimensions, std::string_view unit,
                std::optional<Vec<3>> fallback = {}) const;
  Formulas formulas(std::string_view key, int dimensions, std::string_view unit) const;  // fallback: zero
  std::string expression(std::string_view key, int dimensions) const;                    // fallback: none
  bool flag(std::string_view key, bool fallback) const;
  std::array<bool, 3> flags(std::string_view key, int dimensions) const;  // one for all, or one per axis
  std::optional<std::vector<std::string>> strings(std::string_view key) const;

  template <class E>
  E choice(std::string_view key, std::optional<E> fallback = {}) const {
    return choiceIf<E>(key, fallback, [](E) { return true; });
  }

  /// The same among the values that fit.
  template <class E, class Fits>
  E choiceIf(std::string_view key, std::optional<E> fallback, Fits&& fits) const {
    if (fallback && !has(key)) return *fallback;
    const std::string word = string(key);
    std::vector<std::string_view> words;
    for (const Named<E>& n : namesOf<E>) {
      if (!fits(n.value)) continue;
      if (n.name == word) return n.value;
      words.push_back(n.name);
    }
    throw error(key, "expected " + listOf(words) + ", found '" + word + "'");
  }

  /// The table under `key`, empty if it is not there.
  Section section(std::string_view key, std::string title, const std::vector<std::string_view>& keys,
                  const ForeignKeys& foreign = {}) const;
  /// The same for a table that must be there: the message has the file's place even where it is missing.
  Section required(std::string_view key, const std::vector<std::string_view>& keys) const;
  /// The entries of [[key]], at least one.
  std::vector<const toml::table*> tables(std::string_view key) const;

  /// "place: key in title: text", for the caller to throw; without a place of its own the key gets the table's.
  InputError error(std::string_view key, const std::string& text) const;

 private:
  const toml::node& require(std::string_view key, const std::string& expected) const;
  const toml::array& arrayOf(std::string_view key, int entries, const std::string& expected) const;
  std::string expression(const toml::node& node, std::string_view key, int dimensions) const;
  double finite(const toml::node& node, std::string_view key, const std::string& expected) const;

  const toml::table* table_;
  std::string title_;
};

}  // namespace treacle
