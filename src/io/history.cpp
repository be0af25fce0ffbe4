#include "treacle/io/history.hpp"

#include "posix.hpp"
#include "text_file.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <utility>

namespace treacle {

namespace {

constexpr std::string_view columns =
    "step,time,iterations,residual,kinetic_energy,potential_energy,front_x,top,max_speed,seconds\n";

/// Calls f with every value of the row in the order of the columns.
template <class Row, class F>
void forEachColumn(Row& row, F&& f) {
  f(row.step), f(row.time), f(row.iterations), f(row.residual), f(row.kineticEnergy), f(row.potentialEnergy);
  f(row.frontX), f(row.top), f(row.maxSpeed), f(row.seconds);
}

HistoryRow parseRow(std::string_view line, const std::string& where) {
  HistoryRow row;
  const char* next = line.data();
  const char* const end = line.data() + line.size();
  bool first = true, good = true;
  forEachColumn(row, [&](auto& value) {
    if (!std::exchange(first, false)) good = good && next != end && *next++ == ',';
    if (!good) return;
    const auto result = std::from_chars(next, end, value);
    good = result.ec == std::errc{};
    next = result.ptr;
  });
  if (!good || next != end) throw InputError(fmt::format("{}: expected ten numbers, found '{}'", where, line));
  return row;
}

}  // namespace

HistoryWriter::HistoryWriter(std::filesystem::path path) : path_(std::move(path)) {
  writeFile(path_, columns);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throw RunError(writeFailure(path_, errno));
  size_ = static_cast<std::int64_t>(columns.size());
}

HistoryWriter::~HistoryWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void HistoryWriter::append(const HistoryRow& row) {
  std::string line;
  forEachColumn(row, [&](auto value) { line += fmt::format("{},", value); });
  line.back() = '\n';
  if (!writeAll(descriptor_, line.data(), line.size())) {
    std::string message = writeFailure(path_, errno);
    if (::ftruncate(descriptor_, size_) != 0) message += "; its last row is incomplete";
    throw RunError(message);
  }
  size_ += static_cast<std::int64_t>(line.size());
}

std::vector<HistoryRow> readHistory(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  if (!text.starts_with(columns))
    throw InputError(fmt::format("{}:1: not a history written by treacle; expected the header {}", path.string(),
                                 columns.substr(0, columns.size() - 1)));
  std::vector<HistoryRow> rows;
  std::size_t begin = columns.size();
  for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
    rows.push_back(parseRow(std::string_view(text).substr(begin, end - begin),
                            fmt::format("{}:{}", path.string(), rows.size() + 2)));
  return rows;
}

}  // namespace treacle
