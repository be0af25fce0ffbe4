#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// The file of a probe, column by column.
struct ProbeTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  /// Null where there is none of that name.
  const std::vector<double>* column(std::string_view name) const;
  std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
};

/// All rows; an unfinished last line is left out. Errors: InputError with path and line.
ProbeTable readProbe(const std::filesystem::path& path);

}  // namespace treacle
