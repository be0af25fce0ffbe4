#include "backend.hpp"

#include "machine.hpp"
#include "print.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/version.hpp"

#include <fmt/format.h>

namespace treacle {

std::optional<DeviceInfo> deviceFor(BackendChoice choice) {
  if (choice == BackendChoice::Cpu) return {};
  const std::vector<DeviceInfo> devices = cudaDevices();
  if (!devices.empty() && devices.front().hasCode) return devices.front();
  if (!devices.empty()) {
    const std::string reason = noCodeText(devices.front(), buildInfo().architectures);
    if (choice == BackendChoice::Cuda) throw InputError("--backend cuda: " + reason);
    printError("treacle: warning: " + reason + "; the CPU computes instead\n");
    return {};
  }
  if (choice == BackendChoice::Auto) return {};
  if (!cudaCompiled)
    throw InputError("--backend cuda: this program was built without CUDA; expected 'auto' or 'cpu'");
  throw InputError("--backend cuda: no CUDA device on this machine; expected 'auto' or 'cpu'");
}

std::string deviceText(const DeviceInfo& device) {
  return fmt::format("{} (sm_{}{})", device.name, device.computeMajor, device.computeMinor);
}

std::vector<std::string> cpuWarnings(const Case& c) {
  std::vector<std::string> warnings;
  if (c.solver.neighbours == NeighbourKind::Ranges)
    warnings.push_back("solver.neighbours = 'ranges' is for GPUs and has no effect here: the CPU uses lists");
  if (c.solver.multigrid.coarseOperators == CoarseKind::Spgemm)
    warnings.push_back(
        "solver.multigrid.coarse_operators = 'spgemm' is for GPUs and has no effect here: the CPU takes sums of "
        "pair terms");
  return warnings;
}

}  // namespace treacle
