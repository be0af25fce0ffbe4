#pragma once

#include "treacle/io/files/row_file.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace treacle {

/// Rows of numbers in memory, column by column, as a CSV file would hold them.
struct RowTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  /// Without any rows. `header`: the names, in CSV.
  void start(std::string_view header);
  /// One row or several, in CSV. Errors: std::logic_error for others than rows of as many numbers as there are
  /// names.
  void append(std::string_view rows);
};

/// Where a writer of rows puts them: a file, or a table that outlives the writer.
using RowTarget = std::variant<std::filesystem::path, RowTable*>;

/// What a writer of rows writes to. Errors: those of RowFile.
class Rows {
 public:
  /// Replaces what the target holds. Header and rows come without the ends of their lines.
  Rows(RowTarget target, const std::string& header);

  void append(std::string row);

 private:
  std::variant<RowFile, RowTable*> to_;
};

}  // namespace treacle
