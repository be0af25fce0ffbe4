#include "key_catalogue.hpp"
#include "treacle/io/case/case_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace treacle {
namespace {

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ", ")); }

std::string code(const std::string& text) { return '`' + text + '`'; }

/// For a cell of a table.
std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != text.npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

std::string headingOf(const KeyTable& t) {
  if (t.path.empty()) return "Top of the file";
  const std::size_t dot = t.path.find('.');
  if (t.isList) return code("[[" + t.path + "]]");
  if (dot == t.path.npos || t.path.starts_with("solver.")) return code("[" + t.path + "]");
  return code(t.name()) + " of " + code("[[" + t.path.substr(0, dot) + "]]");
}

/// What a heading is in a link: small letters, digits, and dashes for blanks.
std::string anchorOf(const KeyTable& t) {
  std::string anchor;
  for (const char c : headingOf(t))
    if (c == ' ')
      anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return anchor;
}

/// " > 0", " from 0 to 1".
std::string boundText(const Bound& b) {
  const bool above = std::isfinite(b.least), below = std::isfinite(b.most);
  if (b.open)
    return above && below ? fmt::format(" between {} and {}", b.least, b.most) : fmt::format(" > {}", b.least);
  if (above && below) return fmt::format(" from {} to {}", b.least, b.most);
  return above ? fmt::format(" ≥ {}", b.least) : "";
}

std::string wordList(const KeyRow& r) {
  std::vector<std::string> words;
  for (const std::string& word : r.words) words.push_back(code('"' + word + '"'));
  return joined(words);
}

std::string valueText(const KeyRow& r, const std::vector<KeyTable>& all) {
  const std::string unit = r.unit.empty() ? "" : fmt::format(" [{}]", r.unit);
  const std::string number = "number" + boundText(r.bound) + unit;
  switch (r.kind) {
    case ValueKind::Number:
      return number;
    case ValueKind::NumberOrAuto:
      return number + " or `\"auto\"`";
    case ValueKind::NumberOrFormula:
      return number + " or expression";
    case ValueKind::Numbers:
      return fmt::format("array of numbers{}{}", boundText(r.bound), unit);
    case ValueKind::Integer:
      if (r.bound.most == r.bound.least + 1) return fmt::format("`{}`, `{}`", r.bound.least, r.bound.most);
      return "whole number" + boundText(r.bound);
    case ValueKind::Flag:
      return "`true`, `false`";
    case ValueKind::Flags:
      return "`true`, `false` or one of them per axis";
    case ValueKind::Vector:
      return "vector" + unit;
    case ValueKind::VectorOrFormulas:
      return "vector, of numbers or expressions" + unit;
    case ValueKind::Points:
      return "array of points `[x, y]`" + unit;
    case ValueKind::Text:
    case ValueKind::MaterialName:
      return "string";
    case ValueKind::Names:
      return "array of strings";
    case ValueKind::File:
      return "file name";
    case ValueKind::Formula:
      return "expression";
    case ValueKind::Word:
      return wordList(r);
    case ValueKind::Fields:
      return "array of " + wordList(r);
    case ValueKind::OfTime:
      return number + ", or function of time";
    case ValueKind::VectorOfTime:
      return "vector, of numbers or functions of time" + unit;
    case ValueKind::Table:
    case ValueKind::Tables:
      break;
  }
  const auto table = std::ranges::find(all, r.table, &KeyTable::path);
  if (r.kind == ValueKind::Table) return fmt::format("[table](#{})", anchorOf(*table));
  return fmt::format("[tables](#{}), {} to {}", anchorOf(*table), r.bound.least, r.bound.most);
}

/// The words of an axis that are marked, or those that are not where these are fewer.
std::string axisText(const KeyAxis& axis, const std::vector<bool>& marked, std::size_t number) {
  if (number == DimensionsAxis) return marked[0] ? "two dimensions" : "three dimensions";
  if (number == MethodAxis) return marked[0] ? "MPH-I" : "ISPH";
  if (number == HeatAxis) return marked[1] ? "heat" : "no heat";
  if (axis.values.front() == "without") return (marked[1] ? "with " : "without ") + code(axis.name);
  if (axis.values.front() == "false") return code(axis.name) + ' ' + code(axis.values[marked[1] ? 1 : 0]);
  const auto few = static_cast<std::size_t>(std::ranges::count(marked, true));
  const bool others = 2 * few > marked.size() + 1;
  std::vector<std::string> words;
  for (std::size_t k = 0; k < marked.size(); ++k)
    if (marked[k] != others) words.push_back(code('"' + axis.values[k] + '"'));
  return fmt::format("{} {}{}", code(axis.name), others ? "not " : "", fmt::join(words, ", "));
}

/// Whether a key that decides is itself there with just these values of another axis, which then need no mention.
bool isImplied(const KeyTable& t, const std::vector<bool>& in, std::size_t axis,
               const std::vector<std::size_t>& by) {
  return std::ranges::any_of(by, [&](std::size_t other) {
    if (other == axis || other < CaseAxes) return false;
    const std::string& first = t.axes[other].values.front();  // of those below the key may be missing
    if ((first == "without" || first == "number" || first == "false") && t.valuesOf(in, other)[0]) return false;
    std::vector<bool> there(in.size());
    for (const KeyRow& r : t.rows)
      for (std::size_t v = 0; v < in.size() && r.name == t.axes[other].name; ++v) there[v] = there[v] || r.in[v];
    return t.valuesOf(there, axis) == t.valuesOf(in, axis);
  });
}

/// In which of some variants of the table something is, which are a product: "" for all of them.
std::string conditionText(const KeyTable& t, const std::vector<bool>& in, const std::vector<bool>& among) {
  const auto suffices = [&](const std::vector<std::size_t>& axes) {
    for (std::size_t v = 0; v < in.size(); ++v) {
      const bool has =
          std::ranges::all_of(axes, [&](std::size_t a) -> bool { return t.valuesOf(in, a)[t.variants[v][a]]; });
      if (among[v] && has != in[v]) return false;
    }
    return true;
  };
  std::vector<std::size_t> axes(t.axes.size());
  std::iota(axes.begin(), axes.end(), 0);
  for (std::size_t a = axes.size(); a-- > 0;) {
    std::vector<std::size_t> fewer = axes;
    std::erase(fewer, a);
    if (suffices(fewer) || isImplied(t, in, a, fewer)) axes = fewer;
  }
  std::vector<std::string> parts;
  for (const std::size_t a : axes) parts.push_back(axisText(t.axes[a], t.valuesOf(in, a), a));
  return joined(parts);
}

std::string textOf(const nlohmann::json& value) {
  if (value.is_number_float()) return code(fmt::format("{}", value.get<double>()));
  if (value.is_array() && !value.empty() && value[0].is_number()) {
    std::vector<std::string> numbers;
    for (const auto& x : value) numbers.push_back(fmt::format("{}", x.get<double>()));
    const bool zero = std::ranges::all_of(value, [](const auto& x) { return x.template get<double>() == 0; });
    return zero ? "zero" : code('[' + joined(numbers) + ']');
  }
  return value.is_array() ? "all" : code(value.dump());
}

/// The default of the first variant, and which others there are where.
std::string defaultText(const KeyTable& t, const KeyRow& r) {
  if (r.required) return "required";
  const bool decides = std::ranges::find(t.axes, r.name, &KeyAxis::name) != t.axes.end() || r.name == "name";
  std::vector<std::string> texts;                  // in the order of the variants
  std::map<std::string, std::vector<bool>> where;  // each of them is the default
  for (std::size_t v = 0; v < t.variants.size(); ++v) {
    if (!r.in[v] || r.value[v].is_null() || (decides && !texts.empty())) continue;
    const std::string text = textOf(r.value[v]);
    auto [found, isNew] = where.try_emplace(text, t.variants.size());
    if (isNew) texts.push_back(text);
    found->second[v] = true;
  }
  std::string all;
  for (const std::string& text : texts)
    all += all.empty() ? text : fmt::format("; {}: {}", conditionText(t, where[text], r.in), text);
  return all;
}

std::string rowText(const KeyTable& t, const KeyRow& r, const std::vector<KeyTable>& all) {
  return fmt::format("| {} | {} | {} | {} | {} |\n", code(r.name), escaped(valueText(r, all)), defaultText(t, r),
                     conditionText(t, r.in, std::vector(t.variants.size(), true)), escaped(r.about));
}

constexpr const char* preamble = R"(# Keys of a case file

All keys of a [case file](cases.md), as the program knows them: this page is what `treacle keys` prints. For editors there is the
same as a [JSON schema](command.md#treacle-schema). Quantities are in SI units. A vector is an array with as many numbers as the case has
dimensions; [expressions](cases.md#expressions) and [functions of time](cases.md#tables-of-time) are explained elsewhere. The column
*only with* says what a key goes with: in other cases it is an unknown key, which is an error.
)";

}  // namespace

std::string keyReference() {
  const std::vector<KeyTable> all = keyCatalogue();
  std::string page = preamble;
  for (const KeyTable& t : all) {
    page += fmt::format("\n## {}\n\n", headingOf(t));
    if (!t.about.empty()) page += t.about + ".\n\n";
    page += "| key | value | default | only with | meaning |\n|---|---|---|---|---|\n";
    for (const KeyRow& r : t.rows) page += rowText(t, r, all);
  }
  return page;
}

}  // namespace treacle
