#include "mesh_lines.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace treacle {

bool MeshLines::next() {
  constexpr std::string_view blanks = " \t\r\v\f";
  words_.clear();
  while (!rest_.empty() && words_.empty()) {
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    ++line_;
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
      if (line.empty()) break;
      words_.push_back(line.substr(0, line.find_first_of(blanks)));
      line.remove_prefix(words_.back().size());
    }
  }
  return !words_.empty();
}

void MeshLines::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", path_, std::max<std::size_t>(line_, 1), what));
}

double MeshLines::number(std::size_t word) const {
  if (word >= words_.size())
    fail(fmt::format("expected 3 numbers after '{}', found {}", key(), words_.size() - 1));
  std::string_view text = words_[word];
  if (text.starts_with('+')) text.remove_prefix(1);  // as some programs write, and from_chars does not read
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = end == text.data() + text.size();
  const bool outOfRange = error == std::errc::result_out_of_range;
  if (outOfRange) value = std::strtod(std::string(text).c_str(), nullptr);  // as good as 0, or infinite
  if ((error != std::errc{} && !outOfRange) || !whole || !(std::abs(value) <= farthestVertex))
    fail(fmt::format("expected a finite number of at most {:g}, found '{}'{}", farthestVertex, words_[word],
                     words_[word].find(',') == words_[word].npos ? "" : "; write decimal points, not commas"));
  return value;
}

std::int64_t MeshLines::integer(std::string_view text) const {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    fail(fmt::format("expected a whole number, found '{}'", text));
  return value;
}

void appendFan(Triangles& t, const std::vector<std::uint32_t>& corners, std::size_t face) {
  for (std::size_t k = 2; k < corners.size(); ++k) {
    t.corners.push_back({corners[0], corners[k - 1], corners[k]});
    t.face.push_back(static_cast<std::uint32_t>(face));
  }
}

}  // namespace treacle
