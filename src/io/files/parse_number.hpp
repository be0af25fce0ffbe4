#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace treacle {

/// A number that fills the whole text. It may have a plus, as some programs write, and from_chars does not read.
template <class T>
std::optional<T> parseNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

}  // namespace treacle
