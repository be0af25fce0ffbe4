#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace treacle {

/// A TOML basic string.
inline std::string tomlString(std::string_view s) {
  std::string q = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\')
      q += '\\', q += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      q += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      q += c;
  }
  return q + '"';
}

/// Whether a text can stand in TOML.
inline bool isUtf8(std::string_view s) {
  for (std::size_t k = 0; k < s.size();) {
    const auto lead = static_cast<unsigned char>(s[k]);
    const std::size_t size = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead < 0xF0                 ? 3
                             : lead < 0xF5                 ? 4
                                                           : 0;
    if (size == 0 || (lead >= 0x80 && lead < 0xC2) || k + size > s.size()) return false;
    for (std::size_t j = 1; j < size; ++j)
      if ((static_cast<unsigned char>(s[k + j]) & 0xC0) != 0x80) return false;
    k += size;
  }
  return true;
}

}  // namespace treacle
