#include "frames/poly_data.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/io/surface/free_surface.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string>
#include <utility>

namespace treacle {
namespace {

DataArray vectors(std::string_view name, const std::vector<Vec<3, float>>& values) {
  return dataArray<float>(name, 3, values.size(), [&values](std::size_t k) { return values[k / 3].v[k % 3]; });
}

/// Records of a binary file, collected to pieces of some size.
class Records {
 public:
  explicit Records(AtomicFile& file) : file_(file) {}

  template <class T>
  void add(T value) {
    const char* bytes = reinterpret_cast<const char*>(&value);
    pending_.append(bytes, sizeof value);
    if (pending_.size() >= 1 << 16) flush();
  }
  void flush() {
    file_.write(pending_);
    pending_.clear();
  }

 private:
  AtomicFile& file_;
  std::string pending_;
};

}  // namespace

std::uint64_t writeSurfaceVtp(const std::filesystem::path& path, const FreeSurface& surface,
                              OutputCompression compression) {
  const std::size_t triangles = surface.triangles.size();
  PolyData data{surface.time, 3, surface.points.size(), 0, triangles, {}};
  ArrayGroup& pointData = data.groups.emplace_back(ArrayGroup{"PointData", " Normals=\"normal\"", {}});
  for (const FreeSurface::Field& field : surface.fields)
    pointData.arrays.push_back(dataArray<float>(field.name, field.components, surface.points.size(),
                                                [&field](std::size_t k) { return field.values[k]; }));
  if (!surface.material.empty())
    pointData.arrays.push_back(dataArray<std::int32_t>("material", 1, surface.material.size(),
                                                       [&](std::size_t k) { return surface.material[k]; }));
  pointData.arrays.push_back(vectors("normal", surface.normals));
  data.groups.push_back({"Points", "", {vectors("position", surface.points)}});
  data.groups.push_back(
      {"Polys",
       "",
       {dataArray<std::int32_t>("connectivity", 1, 3 * triangles,
                                [&](std::size_t k) { return surface.triangles[k / 3][k % 3]; }),
        dataArray<std::int32_t>("offsets", 1, triangles, [](std::size_t k) { return 3 * (k + 1); })}});
  return writePolyData(path, std::move(data), compression);
}

std::uint64_t writeSurfacePly(const std::filesystem::path& path, const FreeSurface& surface) {
  constexpr bool isLittle = std::endian::native == std::endian::little;
  std::string header = fmt::format("ply\nformat binary_{}_endian 1.0\ncomment time {} s\nelement vertex {}\n",
                                   isLittle ? "little" : "big", surface.time, surface.points.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) header += fmt::format("property float {}\n", name);
  for (const FreeSurface::Field& field : surface.fields)
    for (int k = 0; k < field.components; ++k)
      header += fmt::format("property float {}{}\n", field.name,
                            field.components == 1 ? "" : fmt::format("_{}", "xyz"[k]));
  if (!surface.material.empty()) header += "property int material\n";
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                        surface.triangles.size());

  AtomicFile file(path);
  file.write(header);
  Records records(file);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    for (const Vec<3, float>& v : {surface.points[p], surface.normals[p]})
      for (int k = 0; k < 3; ++k) records.add(v[k]);
    for (const FreeSurface::Field& field : surface.fields) {
      const auto components = static_cast<std::size_t>(field.components);
      for (std::size_t k = 0; k < components; ++k) records.add(field.values[p * components + k]);
    }
    if (!surface.material.empty()) records.add(surface.material[p]);
  }
  for (const auto& triangle : surface.triangles) {
    records.add(std::uint8_t{3});
    for (const std::uint32_t p : triangle) records.add(p);
  }
  records.flush();
  file.commit();
  return file.size();
}

}  // namespace treacle
