#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace treacle::test {

/// The file of a probe, column by column.
struct ProbeTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  /// Null where there is none of that name.
  const std::vector<double>* column(std::string_view name) const {
    const auto found = std::ranges::find(names, name);
    return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
  }
  std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
};

/// All rows. Errors: std::exception for words that are no numbers, and for too many of them.
inline ProbeTable readProbe(const std::filesystem::path& path) {
  ProbeTable table;
  std::ifstream file(path);
  std::string line, word;
  std::getline(file, line);
  for (std::istringstream header(line); std::getline(header, word, ',');) table.names.push_back(word);
  table.columns.resize(table.names.size());
  while (std::getline(file, line)) {
    std::size_t k = 0;
    for (std::istringstream row(line); std::getline(row, word, ',');)
      table.columns.at(k++).push_back(std::stod(word));
  }
  return table;
}

}  // namespace treacle::test
