#include "case_document.hpp"

#include "files/posix.hpp"
#include "suggestion.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <optional>
#include <span>

namespace treacle {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view setPrefix = "--set ";
constexpr std::string_view namedLists[] = {"material", "body", "outflow", "opening",
                                           "probe"};  // arrays of tables addressed by name
constexpr std::string_view namedBelow[] = {"contact_angles", "elastic", "springs", "state",
                                           "vents"};  // those of other tables, merged by name

CaseFileError errorAt(const toml::source_region& source, const std::string& text) {
  return treacle::errorAt(source, {}, text);
}

/// An error of the file as a whole.
CaseFileError errorIn(const fs::path& path, const std::string& text) {
  return {{path.string()}, {}, fmt::format("{}: {}", path.string(), text)};
}

/// Pipes, too, `treacle check <(...)`; those that nobody writes to are empty and not waited for.
std::string readText(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw errorIn(path, "is a directory");
  constexpr std::size_t largest = 64 << 20;  // [B]
  const std::optional<std::string> text = readAll(path, largest);
  if (!text) throw errorIn(path, fs::exists(path, ignored) ? "cannot be read" : "no such case file");
  if (text->size() > largest) throw errorIn(path, "too large for a case file");
  return *text;
}

/// Where a text in quotes ends that begins at `from`; `from` itself where it does not end on its line.
std::size_t endOfQuoted(std::string_view text, std::size_t from) {
  for (std::size_t k = from + 1; k < text.size() && text[k] != '\n'; ++k) {
    if (text[k] == text[from]) return k;
    if (text[k] == '\\' && text[from] == '"') ++k;
  }
  return from;
}

/// Line with the first key of more parts than any case has, `a.b.c...`; 0: none. The parser makes a table in a
/// table for each part, and goes from one to the next by calls of its own: thousands of them would be more than
/// the stack holds. Chains of words and points in comments count as well, but none that means anything is as long.
std::size_t lineOfDeepKey(std::string_view text) {
  constexpr std::size_t deepest = 256;
  constexpr std::string_view within = " \t_-";
  std::size_t line = 1, parts = 0;
  std::string unended;  // quotes of this line that nothing ends; then nothing ends later ones either
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '.' && ++parts > deepest) return line;
    if (c == '"' || c == '\'') {
      if (unended.find(c) != unended.npos) continue;
      const std::size_t end = endOfQuoted(text, k);
      if (end == k) unended += c;
      k = end;
      continue;
    }
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (c != '.' && !letter && within.find(c) == within.npos) parts = 0;
    if (c == '\n') ++line, unended.clear();
  }
  return 0;
}

toml::table parse(std::string_view text, const std::string& source) {
  if (const std::size_t line = lineOfDeepKey(text); line > 0)
    throw CaseFileError({source, static_cast<std::uint32_t>(line)}, {},
                        fmt::format("{}:{}: not valid TOML for a case: a key of hundreds of parts", source, line));
  try {
    return source.empty() ? toml::parse(text) : toml::parse(text, source);
  } catch (const toml::parse_error& e) {
    throw errorAt(e.source(), fmt::format("not valid TOML: {}", e.description()));
  }
}

bool contains(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

std::string_view nameOf(const toml::table& entry) { return entry["name"].value_or(std::string_view{}); }

toml::table* findNamed(toml::array& list, std::string_view name) {
  for (toml::node& entry : list)
    if (toml::table* table = entry.as_table(); table && nameOf(*table) == name) return table;
  return nullptr;
}

/// One entry of each name.
void requireDistinct(std::string_view listName, toml::array& list) {
  for (toml::node& entry : list)
    if (const std::string_view name = nameOf(*entry.as_table()); !name.empty() && findNamed(list, name) != &entry)
      throw errorAt(entry.source(), fmt::format("two [[{}]] are named '{}'", listName, name));
}

/// Merging needs a name on every entry of the named lists, and one entry of each name.
void requireNames(toml::table& document) {
  for (std::string_view listName : namedLists) {
    toml::array* list = document[listName].as_array();
    if (!list || !list->is_array_of_tables()) continue;
    for (toml::node& entry : *list)
      if (nameOf(*entry.as_table()).empty())
        throw errorAt(entry.source(), fmt::format("every [[{}]] needs a name: name = \"...\"", listName));
    requireDistinct(listName, *list);
  }
}

void merge(toml::table& into, toml::table&& from);

void mergeNamed(std::string_view listName, toml::array& into, toml::array&& from) {
  requireDistinct(listName, from);
  for (toml::node& entry : from) {
    toml::table& table = *entry.as_table();
    if (toml::table* existing = findNamed(into, nameOf(table)))
      merge(*existing, std::move(table));
    else
      into.push_back(std::move(table));
  }
}

/// Merges what an override gives for entries of a list by their names: body.flap.springs.left.stiffness=5.
void mergeByName(std::string_view listName, toml::array& into, toml::table&& from) {
  for (auto&& [name, value] : from) {
    toml::table* entry = findNamed(into, name.str());
    if (!entry) throw errorAt(value.source(), fmt::format("there is no {} '{}'", listName, name.str()));
    if (!value.is_table())
      throw errorAt(value.source(), fmt::format("expected {}.{}.key=value", listName, name.str()));
    merge(*entry, std::move(*value.as_table()));
  }
}

void merge(toml::table& into, toml::table&& from) {
  for (auto&& [key, value] : from) {
    toml::node* existing = into.get(key);
    const bool named = contains(namedLists, key.str()) || contains(namedBelow, key.str());
    if (existing && existing->is_table() && value.is_table())
      merge(*existing->as_table(), std::move(*value.as_table()));
    else if (named && existing && existing->is_array_of_tables() && value.is_array_of_tables())
      mergeNamed(key.str(), *existing->as_array(), std::move(*value.as_array()));
    else if (contains(namedBelow, key.str()) && existing && existing->is_array_of_tables() && value.is_table())
      mergeByName(key.str(), *existing->as_array(), std::move(*value.as_table()));
    else
      into.insert_or_assign(key, std::move(value));
  }
}

/// The path without links and detours, where it has one: that of a pipe leads nowhere.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? path : found;
}

toml::table readWithBase(const fs::path& path, std::vector<fs::path>& chain);

/// `chain`: the files that led here, for the detection of cycles. `folder`: of the file that the document is.
toml::table withBase(toml::table document, const fs::path& folder, std::vector<fs::path>& chain) {
  requireNames(document);
  const toml::node* base = document.get("base");
  if (!base) return document;

  const auto* name = base->as_string();
  if (!name || name->get().empty() || name->get().find('\0') != std::string::npos)
    throw errorAt(base->source(), "base: expected the name of a case file");
  const fs::path basePath = (folder / name->get()).lexically_normal();
  if (std::ranges::find(chain, resolved(basePath)) != chain.end())
    throw errorAt(base->source(), fmt::format("base: '{}' inherits from itself", name->get()));
  if (std::error_code ignored; !fs::is_regular_file(basePath, ignored))
    throw errorAt(base->source(), fmt::format("base: no such case file: {}", basePath.string()));
  toml::table merged = readWithBase(basePath, chain);
  document.erase("base");
  merge(merged, std::move(document));
  return merged;
}

toml::table readWithBase(const fs::path& path, std::vector<fs::path>& chain) {
  toml::table document = parse(readText(path), path.string());
  chain.push_back(resolved(path));
  return withBase(std::move(document), path.parent_path(), chain);
}

/// Parses "key=value" as a TOML line; a value that is no TOML becomes a string: `solver.krylov=cg`.
toml::table parseOverride(const std::string& text) {
  const std::string source = std::string(setPrefix) + text;
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == text.npos) throw InputError(source + ": expected key=value");
  if (lineOfDeepKey(text) > 0) throw InputError("--set: expected key=value, found a key of hundreds of parts");
  toml::table given;
  try {
    given = toml::parse(text, source);
  } catch (const toml::parse_error&) {
    std::string quoted = text.substr(0, equals + 1) + '"';
    for (const char c : text.substr(equals + 1)) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
    given = parse(quoted + '"', source);
  }
  // A text of several lines, or one that is a comment.
  if (given.size() != 1)
    throw InputError(fmt::format("{}: expected one key=value, found {}", source, given.size()));
  return given;
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
  if (contains(namedLists, key.str()) && value.is_table()) {
    for (auto&& [name, entry] : *value.as_table()) overrideEntry(document, key.str(), name.str(), entry);
    return;
  }
  // Bodies and materials come first: where one has the name of a probe or an outflow, it is meant.
  std::vector<std::string_view> candidates = topLevelKeys(), owners, others;
  const auto isNew = [&](std::string_view name) {
    return std::ranges::find(candidates, name) == candidates.end();
  };
  if (!isNew(key.str())) return merge(document, std::move(given));

  for (std::string_view listName : namedLists)
    for (std::string_view name : namesIn(document, listName)) {
      if (isNew(name)) candidates.push_back(name);
      if (name == key.str()) (listName == "body" || listName == "material" ? owners : others).push_back(listName);
    }
  if (owners.empty()) owners = others;
  if (owners.empty())
    throw errorAt(value.source(), fmt::format("unknown key '{}'{}", key.str(), suggestion(key.str(), candidates)));
  if (owners.size() > 1)
    throw errorAt(value.source(), fmt::format("'{0}' is the name of a {1} and a {2}; write {1}.{0} or {2}.{0}",
                                              key.str(), owners[0], owners[1]));
  overrideEntry(document, owners[0], key.str(), value);
}

}  // namespace

std::vector<std::string_view> topLevelKeys() {
  std::vector<std::string_view> known = keys::namesIn(Case{}, Case{});
  known.insert(known.end(), {keys::baseKey.name, keys::widthKey.name});
  return known;
}

std::string placeOf(const toml::source_region& source) {
  if (!source.path) return {};
  if (source.path->starts_with(setPrefix)) return *source.path + ": ";
  return fmt::format("{}:{}:{}: ", *source.path, source.begin.line, source.begin.column);
}

CaseFileError errorAt(const toml::source_region& source, std::string key, const std::string& text) {
  CasePlace place;
  if (source.path && !source.path->starts_with(setPrefix))
    place = {*source.path, source.begin.line, source.begin.column};
  return {std::move(place), std::move(key), placeOf(source) + text};
}

fs::path fileNamedAt(const toml::source_region& source, const std::string& name) {
  const bool inFile = source.path && !source.path->starts_with(setPrefix);
  const fs::path folder = inFile ? fs::path(*source.path).parent_path() : fs::path();
  std::error_code error;
  const fs::path found = fs::absolute(folder / name, error).lexically_normal();
  return error ? folder / name : found;
}

namespace {

toml::table overridden(toml::table document, std::span<const std::string> overrides) {
  for (const std::string& text : overrides) applyOverride(document, text);
  requireNames(document);
  return document;
}

}  // namespace

toml::table readDocument(const fs::path& path, std::span<const std::string> overrides) {
  std::vector<fs::path> chain;
  return overridden(readWithBase(path, chain), overrides);
}

toml::table documentOf(std::string_view text, std::span<const std::string> overrides) {
  std::vector<fs::path> chain;
  return overridden(withBase(parse(text, {}), {}, chain), overrides);
}

}  // namespace treacle
