#include "case_document.hpp"

#include "suggestion.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case_keys.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <sstream>

namespace treacle {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view setPrefix = "--set ";
constexpr std::string_view namedLists[] = {"material", "body"};  // arrays of tables addressed by name

InputError errorAt(const toml::source_region& source, const std::string& text) {
  return InputError(placeOf(source) + text);
}

std::string readText(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw InputError(fmt::format("{}: is a directory", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(
        fmt::format("{}: {}", path.string(), fs::exists(path, ignored) ? "cannot be read" : "no such case file"));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

toml::table parse(std::string_view text, const std::string& source) {
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    throw errorAt(e.source(), fmt::format("not valid TOML: {}", e.description()));
  }
}

std::string_view nameOf(const toml::table& entry) { return entry["name"].value_or(std::string_view{}); }

toml::table* findNamed(toml::array& list, std::string_view name) {
  for (toml::node& entry : list)
    if (toml::table* table = entry.as_table(); table && nameOf(*table) == name) return table;
  return nullptr;
}

/// Merging needs a name on every entry of the named lists, and one entry of each name.
void requireNames(toml::table& document) {
  for (std::string_view listName : namedLists) {
    toml::array* list = document[listName].as_array();
    if (!list || !list->is_array_of_tables()) continue;
    for (toml::node& entry : *list) {
      const std::string_view name = nameOf(*entry.as_table());
      if (name.empty())
        throw errorAt(entry.source(), fmt::format("every [[{}]] needs a name: name = \"...\"", listName));
      if (findNamed(*list, name) != &entry)
        throw errorAt(entry.source(), fmt::format("two [[{}]] are named '{}'", listName, name));
    }
  }
}

void merge(toml::table& into, toml::table&& from);

void mergeNamed(toml::array& into, toml::array&& from) {
  for (toml::node& entry : from) {
    toml::table& table = *entry.as_table();
    if (toml::table* existing = findNamed(into, nameOf(table)))
      merge(*existing, std::move(table));
    else
      into.push_back(std::move(table));
  }
}

void merge(toml::table& into, toml::table&& from) {
  for (auto&& [key, value] : from) {
    toml::node* existing = into.get(key);
    const bool named = std::ranges::find(namedLists, key.str()) != std::end(namedLists);
    if (existing && existing->is_table() && value.is_table())
      merge(*existing->as_table(), std::move(*value.as_table()));
    else if (named && existing && existing->is_array_of_tables() && value.is_array_of_tables())
      mergeNamed(*existing->as_array(), std::move(*value.as_array()));
    else
      into.insert_or_assign(key, std::move(value));
  }
}

/// `chain`: the files that led here, for the detection of cycles.
toml::table readWithBase(const fs::path& path, std::vector<fs::path>& chain) {
  toml::table document = parse(readText(path), path.string());
  requireNames(document);
  chain.push_back(fs::weakly_canonical(path));
  const toml::node* base = document.get("base");
  if (!base) return document;

  const auto* name = base->as_string();
  if (!name || name->get().empty()) throw errorAt(base->source(), "base: expected the name of a case file");
  const fs::path basePath = (path.parent_path() / name->get()).lexically_normal();
  if (std::ranges::find(chain, fs::weakly_canonical(basePath)) != chain.end())
    throw errorAt(base->source(), fmt::format("base: '{}' inherits from itself", name->get()));
  if (std::error_code ignored; !fs::is_regular_file(basePath, ignored))
    throw errorAt(base->source(), fmt::format("base: no such case file: {}", basePath.string()));
  toml::table merged = readWithBase(basePath, chain);
  document.erase("base");
  merge(merged, std::move(document));
  return merged;
}

/// Parses "key=value" as a TOML line; a value that is no TOML becomes a string: `solver.krylov=cg`.
toml::table parseOverride(const std::string& text) {
  const std::string source = std::string(setPrefix) + text;
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == text.npos) throw InputError(source + ": expected key=value");
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error&) {
    std::string quoted = text.substr(0, equals + 1) + '"';
    for (const char c : text.substr(equals + 1)) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
    return parse(quoted + '"', source);
  }
}

std::vector<std::string_view> namesIn(toml::table& document, std::string_view listName) {
  std::vector<std::string_view> names;
  if (toml::array* list = document[listName].as_array())
    for (toml::node& entry : *list)
      if (toml::table* table = entry.as_table()) names.push_back(nameOf(*table));
  return names;
}

/// Merges the value that an override gives for the entry `name` of a named list.
void overrideEntry(toml::table& document, std::string_view listName, std::string_view name, toml::node& value) {
  toml::array* list = document[listName].as_array();
  toml::table* entry = list ? findNamed(*list, name) : nullptr;
  if (!entry)
    throw errorAt(value.source(), fmt::format("there is no [[{}]] '{}'{}", listName, name,
                                              suggestion(name, namesIn(document, listName))));
  if (!value.is_table()) throw errorAt(value.source(), fmt::format("expected {}.{}.key=value", listName, name));
  merge(*entry, std::move(*value.as_table()));
}

void applyOverride(toml::table& document, const std::string& text) {
  toml::table given = parseOverride(text);
  const toml::key key = given.begin()->first;
  toml::node& value = given.begin()->second;
  if (key == "base") throw errorAt(value.source(), "base can only be given in a case file");
  if (std::ranges::find(namedLists, key.str()) != std::end(namedLists) && value.is_table()) {
    for (auto&& [name, entry] : *value.as_table()) overrideEntry(document, key.str(), name.str(), entry);
    return;
  }
  std::vector<std::string_view> candidates = topLevelKeys(), owners;
  if (std::ranges::find(candidates, key.str()) != candidates.end()) return merge(document, std::move(given));

  for (std::string_view listName : namedLists)
    for (std::string_view name : namesIn(document, listName)) {
      candidates.push_back(name);
      if (name == key.str()) owners.push_back(listName);
    }
  if (owners.empty())
    throw errorAt(value.source(), fmt::format("unknown key '{}'{}", key.str(), suggestion(key.str(), candidates)));
  if (owners.size() > 1)
    throw errorAt(value.source(),
                  fmt::format("'{0}' is a material and a body; write material.{0} or body.{0}", key.str()));
  overrideEntry(document, owners[0], key.str(), value);
}

}  // namespace

std::vector<std::string_view> topLevelKeys() {
  std::vector<std::string_view> known = keys::namesIn(Case{}, Case{});
  known.insert(known.end(), {"base", "width"});
  return known;
}

std::string placeOf(const toml::source_region& source) {
  if (!source.path) return {};
  if (source.path->starts_with(setPrefix)) return *source.path + ": ";
  return fmt::format("{}:{}:{}: ", *source.path, source.begin.line, source.begin.column);
}

toml::table readDocument(const fs::path& path, std::span<const std::string> overrides) {
  std::vector<fs::path> chain;
  toml::table document = readWithBase(path, chain);
  for (const std::string& text : overrides) applyOverride(document, text);
  requireNames(document);
  return document;
}

}  // namespace treacle
