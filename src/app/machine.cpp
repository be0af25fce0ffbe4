#include "machine.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace treacle {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// A file that holds one number; `unlimited` where there is none.
std::uint64_t numberIn(const char* path) {
  std::uint64_t value = 0;
  std::ifstream file(path);
  return file >> value ? value : unlimited;
}

/// MemAvailable of the kernel: free memory and caches that can be given up [B].
std::uint64_t freeMemory() {
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    std::uint64_t kibibytes = 0;
    if (key == "MemAvailable:" && file >> kibibytes) return kibibytes << 10;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return unlimited;
}

}  // namespace

std::uint64_t availableMemory() {
  std::uint64_t available = freeMemory();
  const std::uint64_t limit = numberIn("/sys/fs/cgroup/memory.max");
  const std::uint64_t used = numberIn("/sys/fs/cgroup/memory.current");
  if (limit != unlimited && used != unlimited) available = std::min(available, limit - std::min(limit, used));
  rlimit addressSpace{};
  if (getrlimit(RLIMIT_AS, &addressSpace) == 0 && addressSpace.rlim_cur != RLIM_INFINITY)
    available = std::min<std::uint64_t>(available, addressSpace.rlim_cur);
  return available;
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != line.npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string noCodeText(const DeviceInfo& device, const std::string& architectures) {
  return fmt::format(
      "{} needs code for sm_{}{}, and this program was built for {}; configure with "
      "-DCMAKE_CUDA_ARCHITECTURES={}{}, or 'native' where the device is",
      device.name, device.computeMajor, device.computeMinor, architectures, device.computeMajor,
      device.computeMinor);
}

}  // namespace treacle
