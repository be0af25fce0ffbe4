#include "backend.hpp"
#include "commands.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "print.hpp"
#include "treacle/core/vectors.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/surface/free_surface.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <string_view>

namespace treacle {

void infoCommand() {
  const BuildInfo build = buildInfo();
  const auto isOn = [](std::string_view option) { return option == "ON"; };
  const auto compiled = [](bool is) { return is ? "compiled" : "not compiled"; };
  print("treacle     {} ({})\n", build.version, build.commit);
  print("build       {}, {}\n", build.buildType, build.compiler);
  print("native      {}\n", isOn(build.native) ? "yes" : "no");
  print("processor   {}\n", processorName());
  print("vectors     {}\n", vectorInstructions());
  print("threads     {}\n", omp_get_max_threads());
  print("memory      {} available\n", bytesText(availableMemory()));
  print("CUDA        {}\n", compiled(isOn(build.cuda)));
  print("MPI         {}\n", compiled(isOn(build.mpi)));
  print("surfaces    {}\n", hasFreeSurface() ? "by OpenVDB" : "not compiled");
  for (const DeviceInfo& device : cudaDevices())
    print("device      {}, {} multiprocessors, {}, {} available\n", deviceText(device), device.multiprocessors,
          bytesText(device.memory), bytesText(device.freeMemory));
}

}  // namespace treacle
