#include "treacle/model/case/case_error.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

/// As a key of TOML: in quotes where it is not one word.
std::string keyText(const std::string& name) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  const bool oneWord = !name.empty() && name.find_first_not_of(plain) == name.npos;
  return oneWord ? name : fmt::format("\"{}\"", name);
}

std::string pathText(const CasePath& path) {
  std::vector<std::string> words;
  std::ranges::transform(path, std::back_inserter(words), keyText);
  return fmt::format("{}", fmt::join(words, "."));
}

}  // namespace

CaseError::CaseError(CasePath path, std::string text)
    : InputError(pathText(path) + ": " + text), path_(std::move(path)), text_(std::move(text)) {}

}  // namespace treacle
