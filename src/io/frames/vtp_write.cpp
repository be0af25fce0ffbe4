#include "poly_data.hpp"
#include "treacle/io/frames/vtp.hpp"

#include <utility>

namespace treacle {

namespace {

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
  if (fields.viscosityFactor && !frame.viscosityFactor.empty())
    arrays.push_back(scalarArray<Real>("viscosity_factor", frame.viscosityFactor));
  for (const FrameState& state : frame.states) arrays.push_back(scalarArray<Real>(state.name, state.values));
  if (fields.material && !frame.material.empty())
    arrays.push_back(scalarArray<std::int32_t>("material", frame.material));
  if (fields.body && !frame.body.empty()) arrays.push_back(scalarArray<std::int32_t>("body", frame.body));
  if (fields.id && !frame.id.empty()) arrays.push_back(scalarArray<std::uint32_t>("id", frame.id));
  return arrays;
}

template <class Real>
std::uint64_t write(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
                    OutputCompression compression) {
  const std::size_t count = frame.position.size();
  const auto number = [](std::size_t k) { return k; };
  const auto next = [](std::size_t k) { return k + 1; };
  // A vertex per particle and not one for all: filters of ParaView that select cells then select particles.
  PolyData data{frame.time, frame.dimensions, count, count, 0, {}};
  data.groups = {{"PointData", "", pointData<Real>(frame, fields)},
                 {"Points", "", {vectorArray<Real>("position", frame.position)}},
                 {"Verts",
                  "",
                  {dataArray<std::int32_t>("connectivity", 1, count, number),
                   dataArray<std::int32_t>("offsets", 1, count, next)}}};
  return writePolyData(path, std::move(data), compression);
}

}  // namespace

std::uint64_t writeVtp(const std::filesystem::path& path, const Frame& frame, const OutputFields& fields,
                       OutputPrecision precision, OutputCompression compression) {
  if (precision == OutputPrecision::Double) return write<double>(path, frame, fields, compression);
  return write<float>(path, frame, fields, compression);
}

}  // namespace treacle
