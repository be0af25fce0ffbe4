#pragma once

#include "table_text.hpp"
#include "treacle/core/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace treacle {

/// The lines of a file of the authors' program by their words, which blanks part; what begins with # is passed
/// over. Errors, of every member: InputError, "path:line: what".
class MphLines {
 public:
  MphLines(std::string path, std::string_view text) : path_(std::move(path)), lines_(text) {}

  /// Whether there is a next one, which then is this one.
  bool next();
  const std::vector<std::string_view>& words() const { return words_; }
  std::string key() const { return std::string(words_.front()); }
  std::size_t line() const;

  [[noreturn]] void fail(const std::string& what) const;
  /// `row`: how it is called in the message. Words beside the key.
  void requireValues(std::size_t count, std::string_view row) const;

  double number(std::size_t word) const;  // finite
  double positive(std::size_t word) const;
  Vec<3> vector(std::size_t first) const { return {number(first), number(first + 1), number(first + 2)}; }
  std::int64_t integer(std::size_t word, std::int64_t least, std::int64_t most, std::string_view what) const;
  int type(std::size_t word) const;

 private:
  std::string path_;
  TextLines lines_;
  std::vector<std::string_view> words_;
};

}  // namespace treacle
