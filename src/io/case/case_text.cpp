#include "treacle/io/case/case_reader.hpp"

#include "toml_string.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

std::string array(const std::vector<std::string>& entries) {
  return fmt::format("[{}]", fmt::join(entries, ", "));
}

/// The text of a table, as a visitor of its keys (model/case_keys.hpp).
class TableText {
 public:
  /// `path`: what the headings of the tables in it begin with.
  template <class Table>
  TableText(const Case& c, std::string path, const Table& table)
      : case_(c), path_(std::move(path)), isTop_(std::is_same_v<Table, Case>) {
    keys::visit(*this, table, c);
  }

  /// Line by line, with the tables in it after its values.
  std::string text() const { return fmt::format("{}\n{}", fmt::join(values_, "\n"), tables_); }
  std::string onOneLine() const { return fmt::format("{{ {} }}", fmt::join(values_, ", ")); }

  void operator()(const Key& key, double x) { put(key, fmt::format("{}", x)); }
  void operator()(const Key& key, int x) { put(key, fmt::format("{}", x)); }
  void operator()(const Key& key, bool flag) { put(key, fmt::format("{}", flag)); }
  void operator()(const Key& key, const std::array<bool, 3>& flags) {
    put(key, perAxis([&](std::size_t k) { return fmt::format("{}", flags[k]); }));
  }
  void operator()(const Key& key, const Vec<3>& x) { (*this)(key, x, std::array<std::string, 3>{}); }
  void operator()(const Key& key, const Vec<3>& numbers, const std::array<std::string, 3>& texts) {
    put(key, perAxis([&](std::size_t k) {
          return texts[k].empty() ? fmt::format("{}", numbers[static_cast<int>(k)]) : tomlString(texts[k]);
        }));
  }
  void operator()(const Key& key, double x, const std::string& text) {
    put(key, text.empty() ? fmt::format("{}", x) : tomlString(text));
  }
  void operator()(const Key& key, const std::vector<double>& numbers) {
    put(key, fmt::format("[{}]", fmt::join(numbers, ", ")));
  }
  void operator()(const Key& key, const std::vector<Vec<2>>& points) {
    std::vector<std::string> pairs;
    for (const Vec<2>& x : points) pairs.push_back(fmt::format("[{}, {}]", x[0], x[1]));
    put(key, array(pairs));
  }
  void operator()(const Key& key, const std::vector<std::string>& names) {
    std::vector<std::string> words;
    for (const std::string& name : names) words.push_back(tomlString(name));
    if (!words.empty()) put(key, array(words));
  }
  void operator()(const Key& key, const std::string& text) { put(key, tomlString(text)); }
  void operator()(const Key& key, const std::string& path, keys::FileTag) { put(key, tomlString(path)); }
  void operator()(const Key& key, const std::string& text, keys::ExpressionTag) {
    if (!text.empty()) put(key, tomlString(text));
  }
  void operator()(const Key& key, const std::string& text, keys::FormulaTag) {
    if (!text.empty()) put(key, tomlString(text));
  }
  void operator()(const Key& key, int index, keys::MaterialTag) {
    put(key, tomlString(case_.materials[static_cast<std::size_t>(index)].name));
  }
  void operator()(const Key& key, double x, bool isAuto, keys::OrAutoTag) {
    put(key, isAuto ? "\"auto\"" : fmt::format("{}", x));
  }
  void operator()(const Key& key, const OutputFields& fields) {
    std::vector<std::string> names;
    for (const OutputFieldName& f : outputFieldNames)
      if (fields.*(f.flag)) names.push_back(tomlString(f.name));
    put(key, array(names));
  }
  template <class E>
  requires std::is_enum_v<E>
  void operator()(const Key& key, E value, auto&&...) { put(key, tomlString(nameOf(value))); }

  template <class Table>
  requires std::is_class_v<Table>
  void operator()(const Key& key, const Table& table) {
    const std::string path = path_ + std::string(key.name);
    tables_ += fmt::format("\n[{}]\n{}", path, TableText(case_, path + '.', table).text());
  }
  void operator()(const Key& key, const Oscillation& o) {
    if (o != Oscillation{}) put(key, TableText(case_, {}, o).onOneLine());
  }
  void operator()(const Key& key, const Nozzle& n) { put(key, TableText(case_, {}, n).onOneLine()); }
  void operator()(const Key& key, const std::optional<TimeFunction>& f) {
    if (f) put(key, textOf(*f));
  }
  void operator()(const Key& key, const TimeVector& functions) {
    if (functions == TimeVector{}) return;
    put(key, perAxis([&](std::size_t k) { return functions[k] ? textOf(*functions[k]) : "0"; }));
  }
  void operator()(const Key& key, const Vec<3>& numbers, const TimeVector& varying) {
    put(key, perAxis([&](std::size_t k) {
          return varying[k] ? textOf(*varying[k]) : fmt::format("{}", numbers[static_cast<int>(k)]);
        }));
  }
  template <class Table>
  void operator()(const Key& key, const std::optional<Table>& table) {
    if (table) put(key, TableText(case_, {}, *table).onOneLine());
  }
  template <class Table>
  void operator()(const Key& key, const std::vector<Table>& tables) {
    std::vector<std::string> entries;
    for (const Table& table : tables) {
      const TableText entry(case_, {}, table);
      if (isTop_)
        tables_ += fmt::format("\n[[{}]]\n{}", key.name, entry.text());
      else
        entries.push_back(entry.onOneLine());
    }
    if (!entries.empty()) put(key, array(entries));
  }

 private:
  static std::string textOf(const TimeFunction& f) {
    if (f.isTable())
      return fmt::format("{{ times = [{}], values = [{}] }}", fmt::join(f.times, ", "), fmt::join(f.values, ", "));
    return f.expression.empty() ? fmt::format("{}", f.value) : tomlString(f.expression);
  }

  void put(const Key& key, const std::string& value) {
    values_.push_back(fmt::format("{} = {}", key.name, value));
  }

  template <class Entry>
  std::string perAxis(Entry&& entry) const {
    std::vector<std::string> entries;
    for (std::size_t k = 0; k < static_cast<std::size_t>(case_.dimensions); ++k) entries.push_back(entry(k));
    return array(entries);
  }

  const Case& case_;
  std::string path_;
  bool isTop_;                       // of the file
  std::vector<std::string> values_;  // "key = value"
  std::string tables_;
};

}  // namespace

std::string caseText(const Case& c) {
  Case resolved = c;
  resolved.resolution = 1;  // applied
  return "# SI units. Base file, resolution and command-line settings are applied; every key is explicit.\n" +
         TableText(resolved, {}, resolved).text();
}

}  // namespace treacle
