#include "vtk_xml.hpp"

#include <fmt/format.h>

#include <string>

namespace treacle {

std::optional<std::string_view> nextTag(std::string_view xml, std::string_view name, std::size_t& from) {
  const std::size_t begin = xml.find(fmt::format("<{} ", name), from);
  if (begin == xml.npos) return std::nullopt;
  const std::size_t end = xml.find('>', begin);
  if (end == xml.npos) return std::nullopt;
  from = end + 1;
  return xml.substr(begin, end - begin);
}

std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  const std::string opening = fmt::format(" {}=\"", name);
  const std::size_t found = tag.find(opening);
  if (found == tag.npos) return std::nullopt;
  const std::size_t begin = found + opening.size();
  const std::size_t end = tag.find('"', begin);
  if (end == tag.npos) return std::nullopt;
  return tag.substr(begin, end - begin);
}

}  // namespace treacle
