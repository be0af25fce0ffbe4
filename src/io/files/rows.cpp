#include "treacle/io/files/rows.hpp"

#include "parse_number.hpp"
#include "table_text.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace treacle {
namespace {

std::variant<RowFile, RowTable*> opened(RowTarget target, const std::string& header) {
  using To = std::variant<RowFile, RowTable*>;
  if (auto* path = std::get_if<std::filesystem::path>(&target))
    return To(std::in_place_type<RowFile>, std::move(*path), header);
  RowTable* table = std::get<RowTable*>(target);
  table->start(header);
  return To(table);
}

/// A quote within a name is written twice.
std::string unquoted(std::string_view cell) {
  std::string text;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    text += cell[k];
    if (cell[k] == '"' && k + 1 < cell.size() && cell[k + 1] == '"') ++k;
  }
  return text;
}

}  // namespace

void RowTable::start(std::string_view header) {
  std::vector<std::string_view> cells;
  splitLine(header, ',', cells);
  names.clear();
  for (const std::string_view cell : cells) names.push_back(unquoted(cell));
  columns.assign(names.size(), {});
}

void RowTable::append(std::string_view rows) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= rows.size();) {
    const std::size_t end = std::min(rows.find('\n', begin), rows.size());
    splitLine(rows.substr(begin, end - begin), ',', cells);
    if (cells.size() != columns.size()) throw std::logic_error("a row of another number of columns");
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::optional<double> value = parseNumber<double>(cells[k]);
      if (!value) throw std::logic_error("a row with something else than numbers");
      columns[k].push_back(*value);
    }
    begin = end + 1;
  }
}

Rows::Rows(RowTarget target, const std::string& header) : to_(opened(std::move(target), header)) {}

void Rows::append(std::string row) {
  if (auto* file = std::get_if<RowFile>(&to_))
    file->append(std::move(row));
  else
    std::get<RowTable*>(to_)->append(row);
}

}  // namespace treacle
