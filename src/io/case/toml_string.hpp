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

}  // namespace treacle
