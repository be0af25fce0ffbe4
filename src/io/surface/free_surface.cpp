#include "treacle/io/surface/free_surface.hpp"

#include "fill_field.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/parallel.hpp"
#include "volume_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

constexpr std::pair<std::string_view, std::vector<double> Frame::*> scalars[] = {
    {"pressure", &Frame::pressure},
    {"dynamic_viscosity", &Frame::dynamicViscosity},
    {"shear_rate", &Frame::shearRate},
    {"temperature", &Frame::temperature}};

TriangleMesh meshOf(const FillField& field) {
  return volumeMesh({field.computed(), field.inside(), FillField::outside, FillField::within,
                     [&](std::size_t k, float* values) { return field.values(field.computed()[k], values); }});
}

/// The mean of the normals of the triangles at a point, by their areas.
void findNormals(FreeSurface& surface) {
  std::vector<Vec<3>> sums(surface.points.size());
  const auto at = [&](std::uint32_t p) { return converted<double>(surface.points[p]); };
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec<3> area = cross(at(b) - at(a), at(c) - at(a));
    sums[a] += area, sums[b] += area, sums[c] += area;
  }
  surface.normals.resize(sums.size());
  for (std::size_t p = 0; p < sums.size(); ++p) {
    const double length = norm(sums[p]);
    if (length > 0) surface.normals[p] = converted<float>(1 / length * sums[p]);
  }
}

/// Means over the particles around each point, by how much of it they fill.
void findFields(const Frame& fluid, const FillField& field, const std::vector<Vec<3, float>>& positions,
                FreeSurface& surface) {
  const std::size_t count = positions.size();
  const auto add = [&](std::string_view name, int components, bool has) {
    if (has) surface.fields.push_back({std::string(name), components, {}});
  };
  add("velocity", 3, !fluid.velocity.empty());
  for (const auto& [name, member] : scalars) add(name, 1, !(fluid.*member).empty());
  std::vector<const std::vector<double>*> sources;
  for (const auto& [name, member] : scalars)
    if (!(fluid.*member).empty()) sources.push_back(&(fluid.*member));
  const std::size_t first = surface.fields.size() - sources.size();
  for (FreeSurface::Field& f : surface.fields) f.values.resize(count * static_cast<std::size_t>(f.components));
  if (!fluid.material.empty()) surface.material.resize(count);

  parallelForDynamic(count, parallelGrain, 256, [&](std::size_t p) {
    double all = 0, most = 0;
    Vec<3> velocity{};
    std::array<double, std::size(scalars)> sums{};
    field.forEachAround(converted<double>(positions[p]), [&](std::uint32_t i, double weight) {
      all += weight;
      if (first > 0) velocity += weight * fluid.velocity[i];
      for (std::size_t k = 0; k < sources.size(); ++k) sums[k] += weight * (*sources[k])[i];
      if (weight > most && !surface.material.empty()) surface.material[p] = fluid.material[i];
      most = std::max(most, weight);
    });
    if (all == 0) return;
    for (std::size_t k = 0; first > 0 && k < 3; ++k)
      surface.fields[0].values[3 * p + k] = static_cast<float>(velocity[static_cast<int>(k)] / all);
    for (std::size_t k = 0; k < sources.size(); ++k)
      surface.fields[first + k].values[p] = static_cast<float>(sums[k] / all);
  });
}

}  // namespace

bool hasFreeSurface() { return whyNoVolumeMesh().empty(); }

std::string whyNoFreeSurface() { return whyNoVolumeMesh(); }

FreeSurface freeSurface(const Frame& fluid, double spacing, double node) {
  if (!hasFreeSurface()) throw InputError(whyNoFreeSurface());
  if (fluid.dimensions != 3)
    throw InputError("a frame of two dimensions has no surface of triangles; expected three dimensions");
  const FillField field(fluid.position, spacing, node);
  TriangleMesh mesh = meshOf(field);
  FreeSurface surface;
  surface.time = fluid.time;
  surface.leftOut = field.leftOut();
  surface.triangles = std::move(mesh.triangles);
  surface.points.resize(mesh.points.size());
  parallelFor(mesh.points.size(), parallelGrain, [&](std::size_t p) {
    surface.points[p] = converted<float>(field.place(converted<double>(mesh.points[p])));
  });
  findNormals(surface);
  findFields(fluid, field, mesh.points, surface);
  return surface;
}

}  // namespace treacle
