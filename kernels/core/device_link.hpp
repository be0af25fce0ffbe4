#pragma once

#include "treacle/core/device_link.hpp"

namespace treacle {

/// By NCCL; null where the build has none.
std::unique_ptr<DeviceLink> makeNcclLink(const Communicator& job, const Context<Cuda>& context);

}  // namespace treacle
