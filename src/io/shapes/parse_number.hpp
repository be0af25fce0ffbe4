#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace treacle {

/// A number that fills the whole text.
template <class T>
std::optional<T> parseNumber(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

}  // namespace treacle
