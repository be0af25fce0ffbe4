#pragma once

#include "treacle/model/case/output_settings.hpp"
#include "vtk_blocks.hpp"
#include "vtk_xml.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

namespace treacle {

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

struct ArrayGroup {
  std::string_view name;
  std::string_view attributes{};  // of its element, " Normals=..."
  std::vector<DataArray> arrays;
};

/// A file of VTK's XML PolyData (.vtp) with one piece: cells are vertices, or polygons.
struct PolyData {
  double time = 0;  // [s]
  int dimensions = 3;
  std::uint64_t points = 0, vertices = 0, polygons = 0;
  std::vector<ArrayGroup> groups;
};

/// Returns the size of the file [B]. Errors: RunError, std::bad_alloc.
std::uint64_t writePolyData(const std::filesystem::path& path, PolyData data, OutputCompression compression);

}  // namespace treacle
