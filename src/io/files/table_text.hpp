#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

/// The lines of a text that hold something: without blank lines and comments (#), line ends of either kind and
/// the mark that some programs put before UTF-8.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  std::optional<std::string_view> next();
  std::size_t number() const { return number_; }  // of the last line, from 1

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Between the fields of a line: the first comma, semicolon or tab outside of double quotes, otherwise ' ', which
/// stands for any number of blanks and tabs.
char separatorOf(std::string_view line);

/// A number as tables have it, also with an exponent of Fortran (1.5D-3).
std::optional<double> tableNumber(std::string_view text);
/// "expected a number, found '…'", and what may be the reason.
std::string expectedNumber(std::string_view found);

/// The fields without the blanks and the double quotes around them.
void splitLine(std::string_view line, char separator, std::vector<std::string_view>& fields);

}  // namespace treacle
