#include "case_section.hpp"

#include "case_document.hpp"
#include "treacle/model/expression.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {
namespace {

/// A value in words: what was found.
std::string describe(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return fmt::format("the string \"{}\"", node.as_string()->get());
    case toml::node_type::integer:
      return fmt::format("{}", node.as_integer()->get());
    case toml::node_type::floating_point:
      return fmt::format("{}", node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::array:
      return fmt::format("an array of {}", node.as_array()->size());
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

std::string boundText(Bound bound) {
  switch (bound) {
    case Bound::Positive:
      return "a positive number";
    case Bound::NonNegative:
      return "a number not less than 0";
    default:
      return "a finite number";
  }
}

bool satisfies(double x, Bound bound) {
  return bound == Bound::Any || (bound == Bound::Positive ? x > 0 : x >= 0);
}

}  // namespace

Section::Section(const toml::table& table, std::string title, const std::vector<std::string_view>& keys,
                 const ForeignKeys& foreign)
    : table_(&table), title_(std::move(title)) {
  for (auto&& [key, value] : table) {
    if (std::ranges::find(keys, key.str()) != keys.end()) continue;
    const toml::source_region& place = key.source().path ? key.source() : value.source();
    const bool known = std::ranges::find(foreign.keys, key.str()) != foreign.keys.end();
    throw InputError(fmt::format("{}unknown key '{}' in {}{}", placeOf(place), key.str(), title_,
                                 known
                                     ? fmt::format(": it belongs to {}; expected {}", foreign.owner, listOf(keys))
                                     : suggestion(key.str(), keys)));
  }
}

InputError Section::error(std::string_view key, const std::string& text) const {
  const toml::node* node = table_->get(key);
  return InputError(
      fmt::format("{}{} in {}: {}", placeOf(node ? node->source() : table_->source()), key, title_, text));
}

const toml::node& Section::require(std::string_view key, const std::string& expected) const {
  if (const toml::node* node = table_->get(key)) return *node;
  throw error(key, fmt::format("missing; expected {}", expected));
}

double Section::finite(const toml::node& node, std::string_view key, const std::string& expected) const {
  const std::optional<double> x = node.is_number() ? node.value<double>() : std::nullopt;
  if (!x || !std::isfinite(*x)) throw error(key, fmt::format("expected {}, found {}", expected, describe(node)));
  return *x;
}

double Section::number(std::string_view key, Bound bound, std::string_view unit,
                       std::optional<double> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string expected = boundText(bound) + (unit.empty() ? "" : fmt::format(" [{}]", unit));
  const toml::node& node = require(key, expected);
  const double x = finite(node, key, expected);
  if (!satisfies(x, bound)) throw error(key, fmt::format("expected {}, found {}", expected, describe(node)));
  return x;
}

int Section::integer(std::string_view key, int least, std::optional<int> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string expected = fmt::format("a whole number of at least {}", least);
  const toml::node& node = require(key, expected);
  const auto* value = node.as_integer();
  if (!value || value->get() < least || value->get() > std::numeric_limits<int>::max())
    throw error(key, fmt::format("expected {}, found {}", expected, describe(node)));
  return static_cast<int>(value->get());
}

std::string Section::string(std::string_view key, std::optional<std::string> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const toml::node& node = require(key, "a string");
  if (!node.is_string()) throw error(key, fmt::format("expected a string, found {}", describe(node)));
  return node.as_string()->get();
}

Vec<3> Section::vector(std::string_view key, int dimensions, std::string_view unit,
                       std::optional<Vec<3>> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string expected = fmt::format("an array of {} finite numbers [{}]", dimensions, unit);
  const toml::array& array = arrayOf(key, dimensions, expected);
  Vec<3> x{};
  for (int k = 0; k < dimensions; ++k) x[k] = finite(array[static_cast<std::size_t>(k)], key, expected);
  return x;
}

const toml::array& Section::arrayOf(std::string_view key, int entries, const std::string& expected) const {
  const toml::node& node = require(key, expected);
  const toml::array* array = node.as_array();
  if (!array || array->size() != static_cast<std::size_t>(entries))
    throw error(key, fmt::format("expected {}, found {}", expected, describe(node)));
  return *array;
}

Formulas Section::formulas(std::string_view key, int dimensions, std::string_view unit) const {
  Formulas formulas;
  if (!has(key)) return formulas;
  const std::string expected = fmt::format("an array of {} finite numbers or expressions [{}]", dimensions, unit);
  const toml::array& array = arrayOf(key, dimensions, expected);
  for (std::size_t k = 0; k < array.size(); ++k)
    if (array[k].is_string())
      formulas.text[k] = expression(array[k], key, dimensions);
    else
      formulas.number[static_cast<int>(k)] = finite(array[k], key, expected);
  return formulas;
}

std::string Section::expression(std::string_view key, int dimensions) const {
  if (!has(key)) return {};
  return expression(*table_->get(key), key, dimensions);
}

std::string Section::expression(const toml::node& node, std::string_view key, int dimensions) const {
  if (!node.is_string()) throw error(key, fmt::format("expected an expression, found {}", describe(node)));
  const std::string& text = node.as_string()->get();
  try {
    Expression{text, dimensions};
  } catch (const InputError& e) {
    throw error(key, e.what());
  }
  return text;
}

bool Section::flag(std::string_view key, bool fallback) const {
  const toml::node* node = table_->get(key);
  if (!node) return fallback;
  if (!node->is_boolean()) throw error(key, fmt::format("expected true or false, found {}", describe(*node)));
  return node->as_boolean()->get();
}

std::array<bool, 3> Section::flags(std::string_view key, int dimensions) const {
  std::array<bool, 3> flags{};
  const toml::node* node = table_->get(key);
  if (!node) return flags;
  const toml::array* array = node->as_array();
  const bool fits = array ? array->size() == static_cast<std::size_t>(dimensions) &&
                                array->is_homogeneous(toml::node_type::boolean)
                          : node->is_boolean();
  if (!fits)
    throw error(
        key, fmt::format("expected true, false or an array of {} of them, found {}", dimensions, describe(*node)));
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
    flags[k] = (array ? (*array)[k] : *node).as_boolean()->get();
  return flags;
}

std::optional<std::vector<std::string>> Section::strings(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (!node) return std::nullopt;
  const toml::array* array = node->as_array();
  if (!array || !(array->empty() || array->is_homogeneous(toml::node_type::string)))
    throw error(key, fmt::format("expected an array of strings, found {}", describe(*node)));
  std::vector<std::string> words;
  for (const toml::node& word : *array) words.push_back(word.as_string()->get());
  return words;
}

Section Section::section(std::string_view key, std::string title, const std::vector<std::string_view>& keys,
                         const ForeignKeys& foreign) const {
  static const toml::table empty;
  const toml::node* node = table_->get(key);
  if (!node) return Section(empty, std::move(title), keys);
  if (!node->is_table()) throw error(key, fmt::format("expected a table, found {}", describe(*node)));
  return Section(*node->as_table(), std::move(title), keys, foreign);
}

Section Section::required(std::string_view key, const std::vector<std::string_view>& keys) const {
  if (!has(key)) throw error(key, fmt::format("missing; expected a table [{}]", key));
  return section(key, fmt::format("[{}]", key), keys);
}

std::vector<const toml::table*> Section::tables(std::string_view key) const {
  const std::string expected = fmt::format("at least one [[{}]]", key);
  const toml::node& node = require(key, expected);
  const toml::array* array = node.as_array();
  if (!array || !array->is_array_of_tables())
    throw error(key, fmt::format("expected {}, found {}", expected, describe(node)));
  std::vector<const toml::table*> entries;
  for (const toml::node& entry : *array) entries.push_back(entry.as_table());
  return entries;
}

}  // namespace treacle
