#include "treacle/io/atomic_file.hpp"
#include "treacle/io/vtp.hpp"
#include "vtk_blocks.hpp"
#include "vtk_xml.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

namespace {

/// One array of the appended data.
struct DataArray {
  std::string_view name, type;
  int components;
  ArrayBytes values;
  std::uint64_t offset = 0;  // [B] from the start of the appended data, known once it is written
};

/// `value(k)` is scalar k of tuples * components, converted to T on the way out, a block at a time: a frame is
/// never held twice.
template <class T, class Value>
DataArray dataArray(std::string_view name, int components, std::size_t tuples, Value value) {
  static_assert(vtkBlock % sizeof(T) == 0);
  const std::size_t count = tuples * static_cast<std::size_t>(components);
  const auto copy = [=](std::uint64_t begin, std::uint64_t end, char* out) {
    for (std::uint64_t k = begin / sizeof(T); k < end / sizeof(T); ++k, out += sizeof(T)) {
      const T converted = static_cast<T>(value(k));
      std::memcpy(out, &converted, sizeof(T));
    }
  };
  return {name, vtkType<T>(), components, {count * sizeof(T), copy}};
}

template <class Real>
DataArray vectorArray(std::string_view name, const std::vector<Vec<3>>& vectors) {
  return dataArray<Real>(name, 3, vectors.size(), [&vectors](std::size_t k) { return vectors[k / 3].v[k % 3]; });
}

template <class T, class Field>
DataArray scalarArray(std::string_view name, const std::vector<Field>& values) {
  return dataArray<T>(name, 1, values.size(), [&values](std::size_t k) { return values[k]; });
}

template <class Real>
std::vector<DataArray> pointData(const Frame& frame, const OutputFields& fields) {
  std::vector<DataArray> arrays;
  if (fields.velocity && !frame.velocity.empty()) arrays.push_back(vectorArray<Real>("velocity", frame.velocity));
  if (fields.pressure && !frame.pressure.empty()) arrays.push_back(scalarArray<Real>("pressure", frame.pressure));
  if (fields.numberDensity && !frame.numberDensity.empty())
    arrays.push_back(scalarArray<Real>("number_density", frame.numberDensity));
  if (fields.nearestDistance && !frame.nearestDistance.empty())
    arrays.push_back(scalarArray<Real>("nearest_distance", frame.nearestDistance));
  if (fields.dynamicViscosity && !frame.dynamicViscosity.empty())
    arrays.push_back(scalarArray<Real>("dynamic_viscosity", frame.dynamicViscosity));
  if (fields.shearRate && !frame.shearRate.empty())
    arrays.push_back(scalarArray<Real>("shear_rate", frame.shearRate));
  if (fields.temperature && !frame.temperature.empty())
    arrays.push_back(scalarArray<Real>("temperature", frame.temperature));
  if (fields.material && !frame.material.empty())
    arrays.push_back(scalarArray<std::int32_t>("material", frame.material));
  if (fields.body && !frame.body.empty()) arrays.push_back(scalarArray<std::int32_t>("body", frame.body));
  if (fields.id && !frame.id.empty()) arrays.push_back(scalarArray<std::uint32_t>("id", frame.id));
  return arrays;
}

struct ArrayGroup {
  std::string_view name;
  std::vector<DataArray> arrays;
};

/// The file up to the appended data: as long whatever the offsets are.
std::string header(const Frame& frame, const std::vector<ArrayGroup>& groups, OutputCompression compression) {
  std::string xml = fmt::format(
      R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="{}" header_type="UInt64"{}>
  <PolyData>
    <FieldData>
      <DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray>
      <DataArray type="Int32" Name="dimensions" NumberOfTuples="1" format="ascii">{}</DataArray>
    </FieldData>
    <Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
)",
      vtkByteOrder,
      compression == OutputCompression::None ? "" : fmt::format(" compressor=\"{}\"", vtkZlibCompressor),
      frame.time, frame.dimensions, frame.position.size(), frame.position.size());
  for (const ArrayGroup& group : groups) {
    xml += fmt::format("      <{}>\n", group.name);
    for (const DataArray& a : group.arrays)
      xml += fmt::format(
          "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
          "offset={:22}/>\n",
          a.type, a.name, a.components, fmt::format("\"{}\"", a.offset));
    xml += fmt::format("      </{}>\n", group.name);
  }
  return xml + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
}

template <class Real>
std::uint64_t write(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
                    OutputCompression compression) {
  const std::size_t count = frame.position.size();
  const auto number = [](std::size_t k) { return k; };
  const auto next = [](std::size_t k) { return k + 1; };
  // A vertex per particle and not one for all: filters of ParaView that select cells then select particles.
  std::vector<ArrayGroup> groups{{"PointData", pointData<Real>(frame, fields)},
                                 {"Points", {vectorArray<Real>("position", frame.position)}},
                                 {"Verts",
                                  {dataArray<std::int32_t>("connectivity", 1, count, number),
                                   dataArray<std::int32_t>("offsets", 1, count, next)}}};
  AtomicFile file(path);
  file.write(header(frame, groups, compression));
  const std::uint64_t begin = file.size();
  for (ArrayGroup& group : groups)
    for (DataArray& a : group.arrays) {
      a.offset = file.size() - begin;
      compression == OutputCompression::None ? appendRaw(file, a.values) : appendCompressed(file, a.values);
    }
  file.write("\n  </AppendedData>\n</VTKFile>\n");
  file.overwrite(0, header(frame, groups, compression));
  file.commit();
  return file.size();
}

}  // namespace

std::uint64_t writeVtp(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
                       OutputPrecision precision, OutputCompression compression) {
  if (precision == OutputPrecision::Double) return write<double>(path, frame, fields, compression);
  return write<float>(path, frame, fields, compression);
}

}  // namespace treacle
