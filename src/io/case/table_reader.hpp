#pragma once

#include "case_section.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/kind_key.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace treacle {

/// The tables of a case file, by where their values stand in the case.
using Sections = std::map<CasePath, Section>;

/// Reads a table of a case file into a part of the case, as a visitor of its keys (model/case_keys.hpp): looks at
/// types, at keys that are missing or unknown, and at each value by itself. What has no key keeps its value.
/// Errors: InputError.
class TableReader {
 public:
  /// `c`: the whole case. `sections`: takes this table and those in it.
  TableReader(Case& c, Sections& sections, Section section, CasePath path)
      : case_(c), sections_(sections), section_(std::move(section)), path_(std::move(path)) {}

  template <class Table>
  void read(Table& member) {
    prepare(member);
    requireKnownKeys(member);
    sections_.insert_or_assign(path_, section_);
    keys::visit(*this, member, case_);
  }

  void operator()(const Key& key, double& x) const;
  void operator()(const Key& key, int& x) const;
  void operator()(const Key& key, bool& flag) const;
  void operator()(const Key& key, std::array<bool, 3>& flags) const;  // one for all, or one per axis
  void operator()(const Key& key, Vec<3>& x) const;
  void operator()(const Key& key, Vec<3>& numbers, std::array<std::string, 3>& texts) const;
  void operator()(const Key& key, double& x, std::string& text) const;
  void operator()(const Key& key, std::vector<double>& numbers) const;
  void operator()(const Key& key, std::vector<Vec<2>>& points) const;
  void operator()(const Key& key, std::vector<std::string>& names) const;
  void operator()(const Key& key, std::string& text) const;
  void operator()(const Key& key, std::string& path, keys::FileTag) const;  // made absolute
  void operator()(const Key& key, std::string& text, keys::ExpressionTag) const;
  void operator()(const Key& key, std::string& text, keys::FormulaTag) const { (*this)(key, text); }
  void operator()(const Key& key, int& index, keys::MaterialTag) const;
  void operator()(const Key& key, double& x, bool& isAuto, keys::OrAutoTag) const;
  void operator()(const Key& key, OutputFields& fields) const;
  void operator()(const Key& key, std::optional<TimeFunction>& function) const;
  void operator()(const Key& key, TimeVector& functions) const;
  void operator()(const Key& key, Vec<3>& numbers, TimeVector& varying) const;

  template <class E, class Fits = keys::AllFit>
  requires std::is_enum_v<E>
  void operator()(const Key& key, E& value, Fits fits = {}) const {
    const std::string* word = this->word(key);
    if (!word) return;
    const std::optional<E> named = valueNamed<E>(*word);
    if (!named || !fits(*named)) throw section_.error(key.name, wrongWord(wordsThat<E>(fits), *word));
    value = *named;
  }

  template <class Table>
  requires std::is_class_v<Table>
  void operator()(const Key& key, Table& member) const {
    if (const toml::table* table = this->table(key)) below(*table, titleOf(key.name), {key.name}).read(member);
  }
  template <class Table>
  void operator()(const Key& key, std::optional<Table>& member) const {
    if (table(key)) (*this)(key, member.emplace());
  }
  template <class Table>
  void operator()(const Key& key, std::vector<Table>& members) const {
    for (const auto& [name, table] : entries(key))
      below(*table, fmt::format("[[{}]] '{}'", key.name, name), {key.name, name}).read(members.emplace_back());
  }

 private:
  struct Entry {
    std::string name;
    const toml::table* table;
  };

  /// What must be known before the keys are: which there are, and what they are unless the file says otherwise.
  template <class Table>
  void prepare(Table&) {}
  template <HasKind Table>
  void prepare(Table& table) {
    constexpr auto key = kindKey(static_cast<const Table*>(nullptr));
    prepareKind(key.name, table.*(key.member));
  }
  void prepare(Case& c);
  void prepare(MethodSettings& method);
  void prepare(Material& material);
  void prepare(Body& body);
  void prepare(Rotation& rotation);
  void prepare(SolverSettings& solver);
  void prepare(TimeSettings& time);
  void nameMethod();
  /// Which keys there are the word at `key` says, which messages then name.
  template <class E>
  void prepareKind(std::string_view key, E& kind) {
    const auto named = lookUp<E>(key);
    if (!named) return;
    kind = *named;
    section_ = Section(section_.table(), fmt::format("{} ({})", section_.title(), nameOf(kind)));
  }

  template <class Table>
  void requireKnownKeys(const Table& member) const {
    constexpr bool mayHaveHeat = std::is_same_v<Table, Material> || std::is_same_v<Table, Body>;
    if (mayHaveHeat && case_.method.kind == MethodKind::MphI && !case_.heat) {
      Case warm = case_;
      warm.heat.emplace();
      return section_.requireKnown(knownKeys(member), keys::namesIn(member, warm), "cases with [heat]");
    }
    Case other;
    other.dimensions = case_.dimensions;
    other.method.kind = case_.method.kind == MethodKind::Isph ? MethodKind::MphI : MethodKind::Isph;
    section_.requireKnown(knownKeys(member), keys::namesIn(member, other),
                          fmt::format("the method '{}'", nameOf(other.method.kind)));
  }
  void requireKnownKeys(const TimeSettings& time) const;
  template <class Table>
  std::vector<std::string_view> knownKeys(const Table& member) const {
    return keys::namesIn(member, case_);
  }
  template <HasKind Table>
  std::vector<std::string_view> knownKeys(const Table& member) const {
    constexpr auto key = kindKey(static_cast<const Table*>(nullptr));
    return keysOfKind<KindOf<Table>>(key.name, member,
                                     [](Table& table, KindOf<Table> kind) { table.*(key.member) = kind; });
  }
  std::vector<std::string_view> knownKeys(const Case&) const;
  std::vector<std::string_view> knownKeys(const Body& body) const;
  /// Only the keys of the kind at hand, which the word at `key` says, so that a radius given to a box is an error;
  /// all while it is unclear. set(table, kind) makes a table of a kind.
  template <class E, class Table, class Set>
  std::vector<std::string_view> keysOfKind(std::string_view key, const Table& member, Set set) const {
    if (lookUp<E>(key)) return keys::namesIn(member, case_);
    std::vector<std::string_view> known;
    for (const Named<E>& kind : namesOf<E>) {
      Table other;
      set(other, kind.value);
      for (std::string_view name : keys::namesIn(other, case_))
        if (std::ranges::find(known, name) == known.end()) known.push_back(name);
    }
    return known;
  }

  const std::string* word(const Key& key) const;
  const toml::table* table(const Key& key) const;
  std::vector<Entry> entries(const Key& key) const;
  const toml::array* array(const Key& key, const std::string& expected) const;
  double number(const Key& key, const toml::node& node, const std::string& expected) const;
  std::string expression(const Key& key, const toml::node& node) const;
  TimeFunction function(const Key& key, const toml::node& node) const;
  /// The value of a key that need not be there nor be a word of E.
  template <class E>
  std::optional<E> lookUp(std::string_view key) const {
    return valueNamed<E>(section_.table()[key].value_or(std::string_view{}));
  }

  std::string titleOf(std::string_view key) const;
  TableReader below(const toml::table& table, std::string title,
                    std::initializer_list<std::string_view> keys) const;

  Case& case_;
  Sections& sections_;
  Section section_;
  CasePath path_;
};

}  // namespace treacle
