#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace treacle {

/// What the writers and readers of VTK's XML files share.

constexpr std::string_view vtkByteOrder =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

/// The value of `compressor` in files whose arrays are compressed.
constexpr std::string_view vtkZlibCompressor = "vtkZLibDataCompressor";

template <class T>
constexpr std::string_view vtkType() {
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "UInt32";
}

/// The text of the first `<name ...>` in `xml` at or after `from` without its closing bracket; moves `from` behind
/// it.
std::optional<std::string_view> nextTag(std::string_view xml, std::string_view name, std::size_t& from);

/// The value of an attribute in the text of a tag.
std::optional<std::string_view> attribute(std::string_view tag, std::string_view name);

}  // namespace treacle
