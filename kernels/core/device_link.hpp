#pragma once

#include "treacle/core/device_link.hpp"
#include "treacle/core/macros.hpp"

namespace treacle {

/// Messages that are kept one behind the other start where anything may be read from.
TREACLE_HD inline std::size_t padded(std::size_t bytes) { return (bytes + 15) / 16 * 16; }

/// By the devices' own memory, where all are on one host and reach each other's; null where not. Collective.
std::unique_ptr<DeviceLink> makePeerLink(const Communicator& job, const Context<Cuda>& context);
/// By NCCL; null where the build has none.
std::unique_ptr<DeviceLink> makeNcclLink(const Communicator& job, const Context<Cuda>& context);

}  // namespace treacle
