#include "table_text.hpp"

#include "parse_number.hpp"

#include <algorithm>

namespace treacle {
namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// Where the first of the characters stands outside of double quotes; the size of the text if nowhere.
std::size_t findUnquoted(std::string_view text, std::string_view characters) {
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '"') quoted = !quoted;
    if (!quoted && characters.find(text[k]) != characters.npos) return k;
  }
  return text.size();
}

}  // namespace

TextLines::TextLines(std::string_view text) : rest_(text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(mark)) rest_.remove_prefix(mark.size());
}

std::optional<std::string_view> TextLines::next() {
  while (!rest_.empty()) {
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    ++number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') return line;
  }
  return std::nullopt;
}

char separatorOf(std::string_view line) {
  const std::size_t k = findUnquoted(line, ",;\t");
  return k < line.size() ? line[k] : ' ';
}

void splitLine(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool byBlanks = separator == ' ';
  const std::string_view ends = byBlanks ? blanks : std::string_view(&separator, 1);
  if (byBlanks) line = trimmed(line);
  while (true) {
    const std::size_t size = findUnquoted(line, ends);
    fields.push_back(unquoted(trimmed(line.substr(0, size))));
    if (size == line.size()) return;
    line.remove_prefix(size + 1);
    if (byBlanks) line = trimmed(line);
  }
}

std::optional<double> tableNumber(std::string_view text) {
  const std::size_t exponent = text.find_first_of("dD");
  if (exponent == text.npos) return parseNumber<double>(text);
  std::string plain(text);
  plain[exponent] = 'e';
  return parseNumber<double>(plain);
}

std::string expectedNumber(std::string_view found) {
  const std::string text = "expected a number, found '" + std::string(found.substr(0, 40)) + "'";
  constexpr std::string_view ofNumbers = "0123456789+-.,;eEdD \t";
  const bool isNumeric =
      found.find_first_of("0123456789") != found.npos && found.find_first_not_of(ofNumbers) == found.npos;
  const bool decimalComma = isNumeric && found.find_first_of(",;\t") != found.npos;
  return decimalComma ? text + ": is it a decimal comma? Write numbers with decimal points" : text;
}

}  // namespace treacle
