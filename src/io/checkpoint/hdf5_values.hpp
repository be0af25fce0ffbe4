#pragma once

#include "hdf5.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/core/vec.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace treacle {

/// How values stand in an HDF5 file, and the attributes of one. Errors, of all functions: Hdf5Error.

/// Type of a value in the file and in memory.
struct Layout {
  hid_t file, memory;
  hsize_t components;
};

inline Layout layoutOf(const double*) { return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1}; }
inline Layout layoutOf(const std::uint8_t*) { return {H5T_STD_U8LE, H5T_NATIVE_UINT8, 1}; }
inline Layout layoutOf(const std::int32_t*) { return {H5T_STD_I32LE, H5T_NATIVE_INT32, 1}; }
inline Layout layoutOf(const std::uint32_t*) { return {H5T_STD_U32LE, H5T_NATIVE_UINT32, 1}; }
inline Layout layoutOf(const std::int64_t*) { return {H5T_STD_I64LE, H5T_NATIVE_INT64, 1}; }
template <int D>
Layout layoutOf(const Vec<D>*) {
  static_assert(sizeof(Vec<D>) == D * sizeof(double));
  return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, D};
}
template <int D>
Layout layoutOf(const Vec<D, float>*) {
  static_assert(sizeof(Vec<D, float>) == D * sizeof(float));
  return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, D};
}

template <int D>
Layout layoutOf(const SymmetricBlock<D>*) {
  static_assert(sizeof(SymmetricBlock<D>) == SymmetricBlock<D>::size * sizeof(double));
  return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, SymmetricBlock<D>::size};
}

/// Vectors and blocks make a table of count rows and D columns.
struct Extents {
  int rank;
  std::array<hsize_t, 2> size;

  Extents(std::uint64_t count, const Layout& layout)
      : rank(layout.components == 1 ? 1 : 2), size{count, layout.components} {}
};

inline Hdf5Handle textType(std::size_t bytes) { return {H5Tcreate(H5T_STRING, bytes), H5Tclose}; }

inline void writeAttribute(hid_t file, const char* name, hid_t fileType, hid_t memoryType, const void* value) {
  const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(file, name, fileType, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  hdf5Checked(H5Awrite(attribute, memoryType, value));
}

template <class T>
void writeAttribute(hid_t file, const char* name, const T& value) {
  const Layout layout = layoutOf(&value);
  writeAttribute(file, name, layout.file, layout.memory, &value);
}

inline void writeText(hid_t file, const char* name, std::string_view value) {
  const std::string ended(value);
  const Hdf5Handle type = textType(ended.size() + 1);
  writeAttribute(file, name, type, type, ended.c_str());
}

/// An attribute, its type and size. H5Aread writes as many values as the file says that there are, so these are
/// looked at before.
struct Attribute {
  Hdf5Handle handle, type, space;

  Attribute(hid_t file, const char* name, H5T_class_t expected)
      : handle(H5Aopen(file, name, H5P_DEFAULT), H5Aclose),
        type(H5Aget_type(handle), H5Tclose),
        space(H5Aget_space(handle), H5Sclose) {
    if (const hssize_t values = hdf5Checked(H5Sget_simple_extent_npoints(space)); values != 1)
      throw Hdf5Error(fmt::format("the attribute {} has {} values, expected one", name, values));
    if (H5Tget_class(type) != expected)
      throw Hdf5Error(fmt::format("the attribute {} has an unexpected type", name));
  }
};

template <class T>
constexpr H5T_class_t classOf = std::is_integral_v<T> ? H5T_INTEGER : H5T_FLOAT;

template <class T>
T readAttribute(hid_t file, const char* name) {
  const Attribute attribute(file, name, classOf<T>);
  T value{};
  hdf5Checked(H5Aread(attribute.handle, layoutOf(&value).memory, &value));
  return value;
}

inline bool hasAttribute(hid_t file, const char* name) { return hdf5Checked(H5Aexists(file, name)) != 0; }

/// Empty where there is no such attribute.
inline std::string readText(hid_t file, const char* name) {
  if (!hasAttribute(file, name)) return {};
  const Attribute attribute(file, name, H5T_STRING);
  constexpr std::size_t longest = 101;  // a name of 100 bytes and its end
  const std::size_t bytes = H5Tget_size(attribute.type);
  if (H5Tis_variable_str(attribute.type) != 0 || bytes == 0 || bytes > longest)
    throw Hdf5Error(fmt::format("the attribute {} is no short text", name));
  std::array<char, longest + 1> text{};
  hdf5Checked(H5Aread(attribute.handle, attribute.type, text.data()));
  return text.data();
}

}  // namespace treacle
