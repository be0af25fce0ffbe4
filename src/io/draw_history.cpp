#include "draw_panels.hpp"
#include "scale.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace treacle {
namespace {

std::vector<Panel> panelsOf(const std::vector<HistoryRow>& rows) {
  const auto curve = [&](const std::string& name, std::size_t color, auto&& value) {
    PanelCurve c{name, {}, {}, curveColors[color]};
    for (const HistoryRow& row : rows) c.x.push_back(row.time), c.y.push_back(value(row));
    return c;
  };
  constexpr std::size_t blue = 0, orange = 1, green = 2, purple = 3;
  std::vector<Panel> panels = {
      {"iterations", "", {curve("", blue, [](const HistoryRow& r) { return double(r.iterations); })}},
      {"kinetic energy", "J", {curve("", orange, [](const HistoryRow& r) { return r.kineticEnergy; })}},
      {"potential energy", "J", {curve("", green, [](const HistoryRow& r) { return r.potentialEnergy; })}},
      {"extent",
       "m",
       {curve("front x", blue, [](const HistoryRow& r) { return r.frontX; }),
        curve("top", orange, [](const HistoryRow& r) { return r.top; })}},
      {"largest speed", "m/s", {curve("", purple, [](const HistoryRow& r) { return r.maxSpeed; })}}};
  if (std::ranges::any_of(rows, [](const HistoryRow& r) { return r.particles > 0; }))
    panels.push_back({"mass in and out",
                      "kg",
                      {curve("in", blue, [](const HistoryRow& r) { return r.inflow.mass; }),
                       curve("out", orange, [](const HistoryRow& r) { return r.outflow.mass; })}});
  return panels;
}

}  // namespace

void drawHistory(const std::filesystem::path& path, const std::vector<HistoryRow>& rows,
                 const std::string& title) {
  if (rows.empty()) throw InputError("picture: the history holds no steps");
  for (const HistoryRow& row : rows)
    if (!isDrawable(row.time))
      throw InputError(fmt::format("picture: step {} is at t = {} s", row.step, row.time));
  drawPanels(path, title, {"time", "s", rows.front().time, rows.back().time}, panelsOf(rows));
}

}  // namespace treacle
