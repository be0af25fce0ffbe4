#pragma once

#include "treacle/core/device.hpp"

/// First line of every test that needs a GPU.
#define TREACLE_SKIP_WITHOUT_GPU() \
  if (::treacle::cudaDevices().empty()) GTEST_SKIP() << "no CUDA device on this machine"
