#pragma once

#include "treacle/model/case/key.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace treacle {

/// What the value of a key is in a case file. Formulas are model/expression.hpp's.
enum class ValueKind {
  Number,
  NumberOrAuto,
  NumberOrFormula,
  Numbers,
  Integer,
  Flag,
  Flags,  // one for all axes, or one per axis
  Vector,
  VectorOrFormulas,
  Points,
  Text,
  Names,
  File,
  Formula,
  MaterialName,
  Word,
  Fields,
  OfTime,
  VectorOfTime,
  Table,
  Tables
};

/// What the keys of a table follow from: the case ("dimensions", "method", "heat") or a key of the table itself.
struct KeyAxis {
  std::string name;
  std::vector<std::string>
      values;  // words; "2" and "3"; "without" and "with"; "number" and "auto"; "false" and "true"
};

/// The axes that all tables have, which come first.
enum CaseAxis : std::size_t { DimensionsAxis, MethodAxis, HeatAxis, CaseAxes };

/// A key as it is in some variants of its table. The same key may be there in several rows, because it is another
/// thing in other variants.
struct KeyRow {
  std::string name, about, unit;
  bool required = false;
  Bound bound{};
  ValueKind kind = ValueKind::Number;
  std::vector<std::string> words{};     // of Word and Fields, the default first
  std::string table{};                  // path of Table and Tables
  std::vector<bool> in{};               // per variant: whether it has the key
  std::vector<nlohmann::json> value{};  // per variant: the default, null where there is none

  /// Whether it is the same thing, whatever the default.
  bool isLike(const KeyRow& other) const;
};

/// All keys that a table may have.
struct KeyTable {
  std::string path;   // "" of the case, "solver.cells", "body.rotation"
  std::string about;  // of the key that it stands for
  bool isList = false;
  std::vector<KeyAxis> axes{};
  std::vector<std::vector<std::size_t>> variants{};  // of each the place of its value on every axis
  std::vector<KeyRow> rows{};

  /// The last part of its path.
  std::string name() const;
  /// Which values of an axis the variants have that are marked.
  std::vector<bool> valuesOf(const std::vector<bool>& in, std::size_t axis) const;
  /// Whether the variants that are marked are all that have these values, so that the values tell which they are.
  bool isProduct(const std::vector<bool>& in) const;
};

/// All tables of a case file, as keys::visit knows them, each before those in it.
std::vector<KeyTable> keyCatalogue();

}  // namespace treacle
