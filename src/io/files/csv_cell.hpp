#pragma once

#include <string>

namespace treacle {

/// A cell of text, in quotes where it has commas, quotes or ends of lines.
inline std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

}  // namespace treacle
