#include "treacle/io/probe_table.hpp"

#include "text_file.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace treacle {
namespace {

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> found;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    found.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return found;
}

}  // namespace

const std::vector<double>* ProbeTable::column(std::string_view name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

ProbeTable readProbe(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  ProbeTable table;
  std::size_t number = 0, begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    const auto found = cells(std::string_view(text).substr(begin, end - begin));
    const auto refuse = [&](const std::string& expected) {
      throw InputError(fmt::format("{}:{}: expected {}, found '{}'", path.string(), number, expected,
                                   text.substr(begin, end - begin)));
    };
    if (++number == 1) {
      if (found[0] != "time") refuse("the header of a probe, time,...");
      table.names.assign(found.begin(), found.end());
      table.columns.resize(found.size());
      continue;
    }
    if (found.size() != table.names.size()) refuse(fmt::format("{} numbers", table.names.size()));
    for (std::size_t k = 0; k < found.size(); ++k) {
      double value = 0;
      const char* const last = found[k].data() + found[k].size();
      const auto result = std::from_chars(found[k].data(), last, value);
      if (result.ec != std::errc{} || result.ptr != last) refuse(fmt::format("{} numbers", table.names.size()));
      table.columns[k].push_back(value);
    }
  }
  if (number == 0) throw InputError(fmt::format("{}:1: expected the header of a probe, time,...", path.string()));
  return table;
}

}  // namespace treacle
