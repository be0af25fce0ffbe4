#include "treacle/io/frames/particle_csv.hpp"

#include "files/parse_number.hpp"
#include "files/table_text.hpp"
#include "files/text_file.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

enum Column : std::size_t {
  X,
  Y,
  Z,
  VelocityX,
  VelocityY,
  VelocityZ,
  Pressure,
  NumberDensity,
  NearestDistance,
  Temperature,
  Id,
  columnCount
};

/// Lower case, with '_' for ':' and '.'; the first name is the one in messages.
constexpr std::array<std::string_view, 5> spellings[columnCount] = {
    {"x", "pos_x", "position_x", "points_0"},
    {"y", "pos_y", "position_y", "points_1"},
    {"z", "pos_z", "position_z", "points_2"},
    {"vx", "u", "vel_x", "velocity_x", "velocity_0"},
    {"vy", "v", "vel_y", "velocity_y", "velocity_1"},
    {"vz", "w", "vel_z", "velocity_z", "velocity_2"},
    {"pressure"},
    {"number_density"},
    {"nearest_distance"},
    {"temperature"},
    {"id"}};

/// columnCount: none of those that are known.
std::size_t columnOf(std::string_view name) {
  std::string plain(name);
  for (char& c : plain) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == ':' || c == '.') c = '_';
  }
  const auto named = [&](const auto& names) {
    return !plain.empty() && std::find(names.begin(), names.end(), plain) != names.end();
  };
  return static_cast<std::size_t>(std::find_if(spellings, spellings + columnCount, named) - spellings);
}

class ParticleCsv {
 public:
  ParticleCsv(const std::filesystem::path& path, std::optional<int> dimensions)
      : path_(path.string()), text_(readTextFile(path)), lines_(text_), dimensions_(dimensions) {}

  Frame frame() {
    readHeader();
    while (const auto line = lines_.next()) readRow(*line);
    if (frame_.position.empty()) bad("no particles; expected a row for each below the names of the columns");
    finish();
    return std::move(frame_);
  }

 private:
  [[noreturn]] void bad(const std::string& what) const { badAt(std::max<std::size_t>(lines_.number(), 1), what); }
  [[noreturn]] void badAt(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line, what));
  }

  bool has(Column column) const { return place_[column] != missing; }

  void readHeader() {
    const auto line = lines_.next();
    if (!line) bad("the file is empty; expected a line of column names, such as x,y,vx,vy");
    headerLine_ = lines_.number();
    separator_ = separatorOf(*line);
    splitLine(*line, separator_, fields_);
    columns_ = fields_.size();
    place_.fill(missing);
    for (std::size_t k = 0; k < columns_; ++k) {
      const std::size_t column = columnOf(fields_[k]);
      if (column == columnCount) continue;
      if (place_[column] != missing)
        bad(fmt::format("'{}' and '{}' both name the column '{}'; expected one of them", fields_[place_[column]],
                        fields_[k], spellings[column][0]));
      place_[column] = k;
    }
    if (!has(X) || !has(Y)) bad(fmt::format("expected column names with 'x' and 'y', found '{}'", *line));
    if (has(VelocityX) != has(VelocityY) || (has(VelocityZ) && !has(VelocityX)))
      bad("expected 'vx' and 'vy' together, found one component of the velocity without the other");
    if (dimensions_ == 3) requireThree();
  }

  void requireThree() const {
    if (!has(Z)) badAt(headerLine_, "expected a column 'z', since there are three dimensions");
    if (has(VelocityX) && !has(VelocityZ))
      badAt(headerLine_, "expected a column 'vz' beside 'vx' and 'vy', since there are three dimensions");
  }

  void readRow(std::string_view line) {
    splitLine(line, separator_, fields_);
    if (fields_.size() != columns_)
      bad(fmt::format("expected {} values, as many as there are column names, found {}", columns_,
                      fields_.size()));
    const Vec<3> x{{coordinate(X), coordinate(Y), has(Z) ? coordinate(Z) : 0}};
    if (dimensions_ == 2 && x[2] != 0) bad(fmt::format("z: expected 0 in two dimensions, found '{}'", field(Z)));
    frame_.position.push_back(x);
    if (has(VelocityX))
      frame_.velocity.push_back({{number(VelocityX), number(VelocityY), has(VelocityZ) ? number(VelocityZ) : 0}});
    if (has(Pressure)) frame_.pressure.push_back(number(Pressure));
    if (has(NumberDensity)) frame_.numberDensity.push_back(number(NumberDensity));
    if (has(NearestDistance)) frame_.nearestDistance.push_back(number(NearestDistance));
    if (has(Temperature)) frame_.temperature.push_back(number(Temperature));
    if (has(Id)) frame_.id.push_back(id());
  }

  void finish() {
    const bool flat =
        std::all_of(frame_.position.begin(), frame_.position.end(), [](const Vec<3>& x) { return x[2] == 0; });
    frame_.dimensions = dimensions_.value_or(flat ? 2 : 3);
    if (frame_.dimensions == 3) return requireThree();
    for (Vec<3>& u : frame_.velocity) u[2] = 0;
  }

  std::string_view field(Column column) const { return fields_[place_[column]]; }

  std::uint32_t id() const {
    const auto value = parseNumber<std::uint32_t>(field(Id));
    if (!value)
      bad(fmt::format("{}: expected a whole number from 0 to 4294967295, found '{}'", spellings[Id][0],
                      field(Id)));
    return *value;
  }

  double number(Column column) const {
    const std::optional<double> value = tableNumber(field(column));
    if (!value) bad(fmt::format("{}: {}", spellings[column][0], expectedNumber(field(column))));
    return *value;
  }

  double coordinate(Column column) const {
    const double x = number(column);
    if (!std::isfinite(x))
      bad(fmt::format("{}: expected a finite number, found '{}'", spellings[column][0], field(column)));
    return x;
  }

  static constexpr std::size_t missing = ~std::size_t{0};

  std::string path_, text_;
  TextLines lines_;
  std::optional<int> dimensions_;
  std::size_t headerLine_ = 0, columns_ = 0;
  char separator_ = ',';
  std::array<std::size_t, columnCount> place_{};  // of the columns among the fields of a line
  std::vector<std::string_view> fields_;          // of the line that was read last
  Frame frame_;
};

}  // namespace

Frame readParticleCsv(const std::filesystem::path& path, std::optional<int> dimensions) {
  return ParticleCsv(path, dimensions).frame();
}

}  // namespace treacle
