#include "time_table.hpp"

#include "files/table_text.hpp"
#include "files/text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace treacle {
TimeFunction readTimeTable(const std::filesystem::path& path, const std::string& column) {
  const std::string text = readTextFile(path);
  TextLines lines(text);
  TimeFunction f;
  std::vector<std::string_view> fields;
  std::size_t values = 1;
  char separator = ' ';
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", path.string(), lines.number(), what));
  };
  const auto findColumn = [&](bool named) {
    if (column.empty()) return;
    const auto found = std::ranges::find(fields, column);
    if (!named || found == fields.end())
      refuse(fmt::format(
          "no column '{}'{}", column,
          named && fields.size() > 1 ? "; expected " + listOf({fields.begin() + 1, fields.end()}) : ""));
    values = static_cast<std::size_t>(found - fields.begin());
    if (values == 0) refuse(fmt::format("column '{}' is the first one, which holds the times", column));
  };
  for (bool first = true; const auto line = lines.next(); first = false) {
    if (first) separator = separatorOf(*line);
    splitLine(*line, separator, fields);
    if (std::ranges::all_of(fields, &std::string_view::empty)) continue;  // as spreadsheets end with
    if (first) {
      const bool named =
          std::ranges::none_of(fields, [](std::string_view x) { return tableNumber(x).has_value(); });
      findColumn(named);
      if (named) continue;
    }
    if (fields.size() <= values)
      refuse(fmt::format("expected {} numbers or more, found {}", values + 1, fields.size()));
    for (const std::size_t k : {std::size_t{0}, values}) {
      const std::optional<double> x = tableNumber(fields[k]);
      if (!x) refuse(expectedNumber(fields[k]));
      (k == 0 ? f.times : f.values).push_back(*x);
    }
  }
  if (f.times.empty()) throw InputError(fmt::format("{}: expected rows of a time and values", path.string()));
  return f;
}

}  // namespace treacle
