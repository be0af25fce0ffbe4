#include "treacle/io/atomic_file.hpp"
#include "treacle/io/vtp.hpp"
#include "vtk_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

namespace treacle {

namespace {

/// One array of the appended block: its description and how to write its values.
struct DataArray {
  std::string_view name, type;
  int components;
  std::uint64_t bytes;
  std::function<void(AtomicFile&)> writeValues;
};

/// `value(k)` is scalar k of tuples * components, converted to T on the way out, a block at a time: a frame is
/// never held twice.
template <class T, class Value>
DataArray dataArray(std::string_view name, int components, std::size_t tuples, Value value) {
  const std::size_t count = tuples * static_cast<std::size_t>(components);
  return {name, vtkType<T>(), components, count * sizeof(T), [=](AtomicFile& file) {
            std::vector<T> block(std::min<std::size_t>(count, 1 << 16));
            for (std::size_t begin = 0; begin < count; begin += block.size()) {
              const std::size_t size = std::min(block.size(), count - begin);
              for (std::size_t k = 0; k < size; ++k) block[k] = static_cast<T>(value(begin + k));
              file.write(block.data(), size * sizeof(T));
            }
          }};
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

std::string element(std::string_view name, const std::vector<DataArray>& arrays, std::uint64_t& offset) {
  std::string xml = fmt::format("      <{}>\n", name);
  for (const DataArray& a : arrays) {
    xml += fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        a.type, a.name, a.components, offset);
    offset += sizeof(std::uint64_t) + a.bytes;
  }
  return xml + fmt::format("      </{}>\n", name);
}

template <class Real>
void write(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields) {
  const std::size_t count = frame.position.size();
  const auto number = [](std::size_t k) { return k; };
  const auto next = [](std::size_t k) { return k + 1; };
  const std::vector<DataArray> data = pointData<Real>(frame, fields);
  const std::vector<DataArray> points{vectorArray<Real>("position", frame.position)};
  // A vertex per particle and not one for all: filters of ParaView that select cells then select particles.
  const std::vector<DataArray> vertices{dataArray<std::int32_t>("connectivity", 1, count, number),
                                        dataArray<std::int32_t>("offsets", 1, count, next)};

  AtomicFile file(path);
  file.write(fmt::format(R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="{}" header_type="UInt64">
  <PolyData>
    <FieldData>
      <DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray>
      <DataArray type="Int32" Name="dimensions" NumberOfTuples="1" format="ascii">{}</DataArray>
    </FieldData>
    <Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">
)",
                         vtkByteOrder, frame.time, frame.dimensions, count, count));
  std::uint64_t offset = 0;
  file.write(element("PointData", data, offset));
  file.write(element("Points", points, offset));
  file.write(element("Verts", vertices, offset));
  file.write("    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
  for (const auto* group : {&data, &points, &vertices})
    for (const DataArray& a : *group) {
      file.write(&a.bytes, sizeof a.bytes);
      a.writeValues(file);
    }
  file.write("\n  </AppendedData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace

void writeVtp(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
              OutputPrecision precision) {
  if (precision == OutputPrecision::Double)
    write<double>(path, frame, fields);
  else
    write<float>(path, frame, fields);
}

}  // namespace treacle
