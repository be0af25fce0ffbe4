#include "treacle/model/case/names.hpp"

#include <fmt/format.h>

namespace treacle {

std::string listOf(const std::vector<std::string_view>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += fmt::format("'{}'", words[i]);
  }
  return text;
}

std::string wrongWord(const std::vector<std::string_view>& words, std::string_view found) {
  return fmt::format("expected {}, found '{}'", listOf(words), found);
}

}  // namespace treacle
