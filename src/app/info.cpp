#include "backend.hpp"
#include "commands.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "treacle/core/version.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <string_view>

namespace treacle {

void infoCommand() {
  const BuildInfo build = buildInfo();
  const auto yesNo = [](std::string_view option) { return option == "ON" ? "yes" : "no"; };
  fmt::print("treacle     {} ({})\n", build.version, build.commit);
  fmt::print("build       {}, {}\n", build.buildType, build.compiler);
  fmt::print("native      {}\n", yesNo(build.native));
  fmt::print("processor   {}\n", processorName());
  fmt::print("threads     {}\n", omp_get_max_threads());
  fmt::print("memory      {} available\n", bytesText(availableMemory()));
  fmt::print("CUDA        {}\n", build.cuda == std::string_view("ON") ? "compiled" : "not compiled");
  for (const DeviceInfo& device : cudaDevices())
    fmt::print("device      {}, {} multiprocessors, {}, {} available\n", deviceText(device),
               device.multiprocessors, bytesText(device.memory), bytesText(device.freeMemory));
}

}  // namespace treacle
