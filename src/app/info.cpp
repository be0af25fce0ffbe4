#include "backend.hpp"
#include "commands.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "print.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/free_surface.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <string_view>

namespace treacle {

void infoCommand() {
  const BuildInfo build = buildInfo();
  const auto yesNo = [](std::string_view option) { return option == "ON" ? "yes" : "no"; };
  print("treacle     {} ({})\n", build.version, build.commit);
  print("build       {}, {}\n", build.buildType, build.compiler);
  print("native      {}\n", yesNo(build.native));
  print("processor   {}\n", processorName());
  print("threads     {}\n", omp_get_max_threads());
  print("memory      {} available\n", bytesText(availableMemory()));
  print("CUDA        {}\n", build.cuda == std::string_view("ON") ? "compiled" : "not compiled");
  print("surfaces    {}\n", hasFreeSurface() ? "by OpenVDB" : "not compiled");
  for (const DeviceInfo& device : cudaDevices())
    print("device      {}, {} multiprocessors, {}, {} available\n", deviceText(device), device.multiprocessors,
          bytesText(device.memory), bytesText(device.freeMemory));
}

}  // namespace treacle
