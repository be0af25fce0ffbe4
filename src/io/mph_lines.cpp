#include "mph_lines.hpp"

#include "mph_files.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace treacle {
namespace {

/// Of a word that a message shows.
constexpr std::size_t longestShown = 40;

std::string shown(std::string_view word) {
  return word.size() <= longestShown ? std::string(word) : std::string(word.substr(0, longestShown)) + "...";
}

template <class T>
bool read(std::string_view text, T& value) {
  if (text.starts_with('+')) text.remove_prefix(1);  // as some programs write, and from_chars does not read
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

bool MphLines::next() {
  constexpr std::string_view blanks = " \t\r\v\f";
  words_.clear();
  while (words_.empty()) {
    const auto found = lines_.next();
    if (!found) return false;
    std::string_view line = found->substr(0, found->find('#'));
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
      if (line.empty()) break;
      words_.push_back(line.substr(0, line.find_first_of(blanks)));
      line.remove_prefix(words_.back().size());
    }
  }
  return true;
}

std::size_t MphLines::line() const { return std::max<std::size_t>(lines_.number(), 1); }

void MphLines::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", path_, line(), what));
}

void MphLines::requireValues(std::size_t count, std::string_view row) const {
  if (words_.size() == count + 1) return;
  fail(fmt::format("{}: expected {} value{}, found {}", row, count, count == 1 ? "" : "s", words_.size() - 1));
}

double MphLines::number(std::size_t word) const {
  double x = 0;
  if (word >= words_.size())
    fail(fmt::format("expected {} values in the line, found {}", word + 1, words_.size()));
  if (!read(words_[word], x) || !std::isfinite(x))
    fail(fmt::format("expected a finite number, found '{}'", shown(words_[word])));
  return x;
}

double MphLines::positive(std::size_t word) const {
  const double x = number(word);
  if (!(x > 0)) fail(fmt::format("expected a positive number, found '{}'", shown(words_[word])));
  return x;
}

std::int64_t MphLines::integer(std::size_t word, std::int64_t least, std::int64_t most,
                               std::string_view what) const {
  std::int64_t value = 0;
  if (!read(words_[word], value) || value < least || value > most)
    fail(fmt::format("expected {}, a whole number from {} to {}, found '{}'", what, least, most,
                     shown(words_[word])));
  return value;
}

int MphLines::type(std::size_t word) const {
  return static_cast<int>(integer(word, 0, mphTypes - 1, "a type, 0 and 1 for fluids, 2 and 3 for walls"));
}

}  // namespace treacle
