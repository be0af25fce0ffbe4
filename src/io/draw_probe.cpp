#include "draw_panels.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

constexpr std::pair<std::string_view, std::string_view> units[] = {{"velocity", "m/s"},
                                                                   {"pressure", "Pa"},
                                                                   {"dynamic_viscosity", "Pa s"},
                                                                   {"shear_rate", "1/s"},
                                                                   {"temperature", "K"},
                                                                   {"height", "m"},
                                                                   {"center", "m"},
                                                                   {"volume", "m3"},
                                                                   {"mass", "kg"},
                                                                   {"volume_flow_rate", "m3/s"},
                                                                   {"mass_flow_rate", "kg/s"},
                                                                   {"force", "N"},
                                                                   {"torque", "N m"},
                                                                   {"power", "W"}};

std::string unitOf(std::string_view quantity) {
  for (const auto& [name, unit] : units)
    if (name == quantity) return std::string(unit);
  return "";
}

/// Of a column: "velocity" of "velocity_x".
std::string_view quantityOf(std::string_view name) {
  const bool isComponent =
      name.size() > 2 && (name.ends_with("_x") || name.ends_with("_y") || name.ends_with("_z"));
  return isComponent ? name.substr(0, name.size() - 2) : name;
}

bool isCoordinate(std::string_view name) {
  return name == "time" || name == "distance" || name == "x" || name == "y" || name == "z";
}

/// Columns of one quantity are curves of one panel. `curves(panel, column, name)` adds those of a column.
template <class F>
std::vector<Panel> panelsOf(const ProbeTable& table, F&& curves) {
  std::vector<Panel> panels;
  std::string_view last;
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    const std::string_view name = table.names[k], quantity = quantityOf(name);
    if (isCoordinate(name)) continue;
    if (quantity != last) {
      std::string label(quantity);
      std::ranges::replace(label, '_', ' ');
      panels.push_back({std::move(label), unitOf(quantity), {}});
    }
    last = quantity;
    curves(panels.back(), table.columns[k], quantity == name ? "" : std::string(name.substr(name.size() - 1)));
  }
  return panels;
}

/// Over time.
void drawReadings(const std::filesystem::path& path, const ProbeTable& table, const std::string& title) {
  const std::vector<double>& time = *table.column("time");
  const auto panels = panelsOf(table, [&](Panel& panel, const std::vector<double>& values, std::string name) {
    panel.curves.push_back({std::move(name), time, values, curveColors[panel.curves.size()]});
  });
  drawPanels(path, title, {"time", "s", time.front(), time.back()}, panels);
}

/// Over the distance along the line, at some times, the last one among them.
void drawProfiles(const std::filesystem::path& path, const ProbeTable& table, std::size_t places,
                  const std::string& title) {
  const std::vector<double>&time = *table.column("time"), &distance = *table.column("distance");
  const std::size_t blocks = table.rows() / places, most = std::min<std::size_t>(blocks, 4);
  const auto part = [&](const std::vector<double>& column, std::size_t block) {
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(block * places);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(places));
  };
  const auto panels =
      panelsOf(table, [&](Panel& panel, const std::vector<double>& values, const std::string& name) {
        for (std::size_t k = 1; k <= most; ++k) {
          const std::size_t block = blocks * k / most - 1;
          const std::string at = fmt::format("{:.3g} s", time[block * places]);
          panel.curves.push_back({name.empty() ? at : fmt::format("{}, {}", name, at), part(distance, block),
                                  part(values, block), curveColors[panel.curves.size() % curveColors.size()]});
        }
      });
  drawPanels(path, title, {"distance", "m", distance[0], distance[places - 1]}, panels);
}

/// The rectangle at the last time, in its own plane.
void drawPlane(const std::filesystem::path& path, const ProbeTable& table, const Probe& probe,
               const ProbePlaces& places, PictureOptions options) {
  const std::size_t begin = table.rows() - places.count();
  const auto value = [&](std::string_view name, std::size_t k) {
    const std::vector<double>* column = table.column(name);
    return column ? (*column)[begin + k] : 0;
  };
  const double width = norm(probe.along), height = norm(probe.up);
  Frame frame;
  frame.dimensions = 2;
  frame.time = value("time", 0);
  const auto take = [&](std::string_view name, std::vector<double>& field, std::size_t k) {
    if (table.column(name)) field.push_back(value(name, k));
  };
  for (std::size_t k = 0; k < places.count(); ++k) {
    if (!std::isfinite(value("pressure", k))) continue;  // no fluid
    const Vec<3> way = places.at(k) - probe.corner;
    frame.position.push_back({dot(way, probe.along) / width, dot(way, probe.up) / height, 0});
    frame.velocity.push_back({value("velocity_x", k), value("velocity_y", k), value("velocity_z", k)});
    take("pressure", frame.pressure, k), take("temperature", frame.temperature, k);
    take("dynamic_viscosity", frame.dynamicViscosity, k), take("shear_rate", frame.shearRate, k);
  }
  if (frame.position.empty())
    throw InputError(fmt::format("picture: no fluid is in the plane at t = {:g} s", frame.time));
  constexpr double overlap = 1.45;  // of discs, that nothing shows between them
  options.spacing =
      overlap * std::max(width / std::max(places.columns - 1, 1), height / std::max(places.rows - 1, 1));
  drawFrame(path, frame, {}, options);
}

}  // namespace

void drawProbe(const std::filesystem::path& path, const ProbeTable& table, const Probe& probe,
               const PictureOptions& options) {
  const ProbePlaces places = ProbePlaces::of(probe, options.spacing);
  const std::size_t block = probe.kind == ProbeKind::Line || probe.kind == ProbeKind::Plane ? places.count() : 1;
  if (table.rows() < block) throw InputError(fmt::format("picture: probe '{}' has read nothing yet", probe.name));
  const std::string title = options.title.empty() ? probe.name : fmt::format("{}: {}", options.title, probe.name);
  if (probe.kind == ProbeKind::Plane) {
    PictureOptions ofPlane = options;
    ofPlane.title = title;
    return drawPlane(path, table, probe, places, ofPlane);
  }
  if (probe.kind == ProbeKind::Line) return drawProfiles(path, table, places.count(), title);
  drawReadings(path, table, title);
}

}  // namespace treacle
