#include "poly_data.hpp"

#include "treacle/io/files/atomic_file.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace treacle {

namespace {

/// The file up to the appended data: as long whatever the offsets are.
std::string header(const PolyData& data, OutputCompression compression) {
  std::string xml = fmt::format(
      R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="{}" header_type="UInt64"{}>
  <PolyData>
    <FieldData>
      <DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray>
      <DataArray type="Int32" Name="dimensions" NumberOfTuples="1" format="ascii">{}</DataArray>
    </FieldData>
    <Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{}">
)",
      vtkByteOrder,
      compression == OutputCompression::None ? "" : fmt::format(" compressor=\"{}\"", vtkZlibCompressor),
      data.time, data.dimensions, data.points, data.vertices, data.polygons);
  for (const ArrayGroup& group : data.groups) {
    xml += fmt::format("      <{}{}>\n", group.name, group.attributes);
    for (const DataArray& a : group.arrays)
      xml += fmt::format(
          "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
          "offset={:22}/>\n",
          a.type, a.name, a.components, fmt::format("\"{}\"", a.offset));
    xml += fmt::format("      </{}>\n", group.name);
  }
  return xml + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
}

}  // namespace

std::uint64_t writePolyData(const std::filesystem::path& path, PolyData data, OutputCompression compression) {
  AtomicFile file(path);
  file.write(header(data, compression));
  const std::uint64_t begin = file.size();
  for (ArrayGroup& group : data.groups)
    for (DataArray& a : group.arrays) {
      a.offset = file.size() - begin;
      compression == OutputCompression::None ? appendRaw(file, a.values) : appendCompressed(file, a.values);
    }
  file.write("\n  </AppendedData>\n</VTKFile>\n");
  file.overwrite(0, header(data, compression));
  file.commit();
  return file.size();
}

}  // namespace treacle
