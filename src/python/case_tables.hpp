#pragma once

#include <string>
#include <vector>

namespace treacle {

/// A key of a table of case files, as Python's dataclasses have it.
struct TableKey {
  std::string name;
  std::string type;  // of Python
  std::string unit;
};

/// A table of case files with all keys that it can have, whatever dimensions, method, heat and kinds say.
struct CaseTable {
  std::string name;  // of the dataclass
  std::vector<TableKey> keys;
};

/// All tables, those within others before them; the case itself last. They follow from model/case_keys.hpp.
std::vector<CaseTable> caseTables();

}  // namespace treacle
