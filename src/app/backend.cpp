#include "backend.hpp"

#include "machine.hpp"
#include "print.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/version.hpp"

#include <fmt/format.h>

namespace treacle {

std::optional<DeviceInfo> deviceFor(BackendChoice choice, int localRank) {
  if (choice == BackendChoice::Cpu) return {};
  const std::vector<DeviceInfo> devices = cudaDevices();
  const std::size_t rank = localRank, own = devices.empty() ? 0 : rank % devices.size();
  if (!devices.empty() && own != rank && choice == BackendChoice::Auto) return {};
  if (!devices.empty() && devices[own].hasCode) {
    useDevice(own);
    return devices[own];
  }
  if (!devices.empty()) {
    const std::string reason = noCodeText(devices[own], buildInfo().architectures);
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
