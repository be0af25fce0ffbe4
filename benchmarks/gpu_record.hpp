#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/phase_clock.hpp"
#include "treacle/io/case/case_reader.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <vector>

namespace treacle {

struct BenchmarkOptions {
  std::string cases;                 // directory
  std::string scheme = "published";  // of MPH-I; what records hold unless they say otherwise
  std::string only;
  bool quick = false;
  double largest = 0;  // resolution of a 3D dam break that is run alone, for one step

  bool wants(const std::string& name) const { return name.find(only) != name.npos; }
};

/// What a run of the benchmark leaves behind.
struct Record {
  nlohmann::ordered_json json;
  double copyBandwidth = 0;  // [B/s]

  /// A part that moves at least `bytes` (0: not stated).
  void add(const std::string& name, std::uint64_t particles, double seconds, double bytes = 0) {
    nlohmann::ordered_json entry{{"name", name}, {"particles", particles}, {"ms", seconds * 1e3}};
    std::string text = fmt::format("{:<44} {:>10} particles {:>10.4f} ms", name, particles, seconds * 1e3);
    if (bytes > 0) {
      entry["bytes"] = bytes;
      entry["share_of_copy_bandwidth"] = bytes / seconds / copyBandwidth;
      text += fmt::format(" {:>8.1f} MB {:>5.1f} % of copy", bytes * 1e-6, 100 * bytes / seconds / copyBandwidth);
    }
    json["parts"].push_back(entry);
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }
};

/// Device seconds of one call of `work`, over enough repetitions.
template <class F>
double secondsOf(Context<Cuda>& context, F&& work, int repetitions = 20) {
  PhaseClock<Cuda> clock;
  for (int k = 0; k < 3; ++k) work();
  clock.start(context);
  for (int k = 0; k < repetitions; ++k) work();
  clock.mark(context);
  return clock.seconds()[0] / repetitions;
}

/// Bytes per second of a device-to-device copy, read and write counted.
inline double copyBandwidth() {
  Context<Cuda> context;
  constexpr std::size_t bytes = std::size_t{1} << 30;
  Buffer<std::byte, Cuda> from(context, bytes), to(context, bytes);
  clearBytes(context, from.data(), bytes);
  const double seconds = secondsOf(context, [&] { copyBytesOnDevice(context, from.data(), to.data(), bytes); });
  return 2 * static_cast<double>(bytes) / seconds;
}

inline Case paperCase(const BenchmarkOptions& options, int dimensions, double resolution,
                      std::vector<std::string> settings = {}) {
  settings.push_back(fmt::format("resolution={}", resolution));
  settings.push_back("method.scheme=" + options.scheme);
  return readCase(fmt::format("{}/dam-break-{}d.toml", options.cases, dimensions), settings);
}

}  // namespace treacle
