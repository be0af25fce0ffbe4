#include "treacle/io/probe_table.hpp"

#include "parse_number.hpp"
#include "table_text.hpp"
#include "text_file.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace treacle {
const std::vector<double>* ProbeTable::column(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

ProbeTable readProbe(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  ProbeTable table;
  std::vector<std::string_view> found;
  std::size_t number = 0, begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const auto refuse = [&](const std::string& expected) {
      throw InputError(fmt::format("{}:{}: expected {}, found '{}'", path.string(), number, expected, line));
    };
    splitLine(line, ',', found);
    if (++number == 1) {
      if (found[0] != "time") refuse("the header of a probe, time,...");
      table.names.assign(found.begin(), found.end());
      table.columns.resize(found.size());
      continue;
    }
    const std::string expected = fmt::format("{} numbers", table.names.size());
    if (found.size() != table.names.size()) refuse(expected);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::optional<double> value = parseNumber<double>(found[k]);
      if (!value) refuse(expected);
      table.columns[k].push_back(*value);
    }
  }
  if (number == 0) throw InputError(fmt::format("{}:1: expected the header of a probe, time,...", path.string()));
  return table;
}

}  // namespace treacle
