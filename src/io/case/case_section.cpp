#include "case_section.hpp"

#include "case_document.hpp"
#include "suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
namespace treacle {
namespace {

/// A text as messages show it.
std::string beginning(const std::string& text) {
  constexpr std::size_t longest = 200;
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

/// A value in words: what was found.
std::string describe(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return fmt::format("the string \"{}\"", beginning(node.as_string()->get()));
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

}  // namespace

const toml::node* Section::value(const Key& key, const std::string& expected) const {
  const toml::node* node = table_->get(key.name);
  if (!node && key.required) throw error(key.name, fmt::format("missing; expected {}", expected));
  return node;
}

void Section::requireKnown(const std::vector<std::string_view>& known,
                           const std::vector<std::string_view>& foreign, std::string_view owner) const {
  for (auto&& [key, value] : *table_) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    const toml::source_region& place = key.source().path ? key.source() : value.source();
    const bool ofOther = std::ranges::find(foreign, key.str()) != foreign.end();
    throw errorAt(place, std::string(key.str()),
                  fmt::format("unknown key '{}' in {}{}", key.str(), title_,
                              ofOther ? fmt::format(": it belongs to {}; expected {}", owner, listOf(known))
                                      : suggestion(key.str(), known)));
  }
}

CaseFileError Section::error(std::string_view key, const std::string& text) const {
  const toml::node* node = table_->get(key);
  return errorAt(node ? node->source() : table_->source(), std::string(key),
                 fmt::format("{} in {}: {}", key, title_, text));
}

CaseFileError Section::unexpected(const Key& key, const std::string& expected, const toml::node& found) const {
  return error(key.name, mismatch(key, expected, describe(found)));
}

}  // namespace treacle
