#include "treacle/io/tables/history.hpp"

#include "files/text_file.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace treacle {

namespace {

constexpr std::string_view solveColumns =
    ",iterations,residual,kinetic_energy,potential_energy,front_x,top,max_speed";
constexpr std::string_view timingColumns = ",search_s,lists_s,coefficients_s,coarse_s,solve_s,update_s";

constexpr std::string_view flowColumns =
    ",particles,inflow_particles,inflow_volume,inflow_mass,outflow_particles,outflow_volume,outflow_mass";

constexpr std::string_view gasColumns = ",gas_pockets,gas_volume,gas_pressure";

/// Which columns a file has beside those that all have.
struct Layout : HistoryColumns {
  int version = newest;  // of the columns: 2 has fallbacks, 3 the time step and densities

  static constexpr int newest = 3;
};

/// The header without the end of its line.
std::string columns(const Layout& layout) {
  return fmt::format("step,time{}{}{},seconds{}{}{}{}", layout.version >= 3 ? ",time_step" : "", solveColumns,
                     layout.version >= 3 ? ",mean_density,density_error" : "",
                     layout.version >= 2 ? ",fallbacks" : "", layout.flow ? flowColumns : "",
                     layout.gas ? gasColumns : "", layout.timings ? timingColumns : "");
}

std::string header(const Layout& layout) { return columns(layout) + '\n'; }

/// Calls f with every value of the row in the order of the columns.
template <class Row, class F>
void forEachColumn(Row& row, const Layout& layout, F&& f) {
  f(row.step), f(row.time);
  if (layout.version >= 3) f(row.timeStep);
  f(row.iterations), f(row.residual), f(row.kineticEnergy), f(row.potentialEnergy);
  f(row.frontX), f(row.top), f(row.maxSpeed);
  if (layout.version >= 3) f(row.meanDensity), f(row.densityError);
  f(row.seconds);
  if (layout.version >= 2) f(row.fallbacks);
  if (layout.flow) {
    f(row.particles);
    for (auto* flow : {&row.inflow, &row.outflow}) f(flow->particles), f(flow->volume), f(flow->mass);
  }
  if (layout.gas) f(row.gas.pockets), f(row.gas.volume), f(row.gas.pressure);
  if (!layout.timings) return;
  auto& t = row.timings;
  f(t.search), f(t.lists), f(t.coefficients), f(t.coarse), f(t.solve), f(t.update);
}

Layout layoutOf(std::string_view text, const std::filesystem::path& path) {
  for (int version = Layout::newest; version > 0; --version)
    for (const bool flow : {true, false})
      for (const bool gas : {true, false})
        for (const bool timings : {true, false}) {
          const Layout layout{{flow, gas, timings}, version};
          if (text.starts_with(header(layout))) return layout;
        }
  throw InputError(
      fmt::format("{}:1: not a history written by treacle; expected the header {}", path.string(), columns({})));
}

HistoryRow parseRow(std::string_view line, const Layout& layout, const std::string& where) {
  HistoryRow row;
  const char* next = line.data();
  const char* const end = line.data() + line.size();
  bool first = true, good = true;
  int expected = 0;
  forEachColumn(row, layout, [&](auto& value) {
    ++expected;
    if (!std::exchange(first, false)) good = good && next != end && *next++ == ',';
    if (!good) return;
    const auto result = std::from_chars(next, end, value);
    good = result.ec == std::errc{};
    next = result.ptr;
  });
  if (!good || next != end)
    throw InputError(fmt::format("{}: expected {} numbers, found '{}'", where, expected, line));
  if (!std::isfinite(row.time))
    throw InputError(fmt::format("{}: expected a finite time, found '{}'", where, line));
  return row;
}

}  // namespace

HistoryWriter::HistoryWriter(RowTarget to, HistoryColumns some)
    : columns_(some), rows_(std::move(to), columns({some})) {}

void HistoryWriter::append(const HistoryRow& row) {
  std::string line;
  forEachColumn(row, {columns_}, [&](auto value) { line += fmt::format("{},", value); });
  line.pop_back();
  rows_.append(line);
}

std::vector<HistoryRow> readHistory(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  const Layout layout = layoutOf(text, path);
  std::vector<HistoryRow> rows;
  std::size_t begin = header(layout).size();
  for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
    rows.push_back(parseRow(std::string_view(text).substr(begin, end - begin), layout,
                            fmt::format("{}:{}", path.string(), rows.size() + 2)));
  return rows;
}

}  // namespace treacle
