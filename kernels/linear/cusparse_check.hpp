#pragma once

#include "treacle/core/cuda.hpp"

#include <cusparse.h>

#include <string>

namespace treacle {

/// Throws DeviceFailure with the place and cuSPARSE's own words unless the call succeeded.
inline void cusparseCheck(cusparseStatus_t status, const char* file, int line) {
  if (status != CUSPARSE_STATUS_SUCCESS)
    throw DeviceFailure(std::string(file) + ":" + std::to_string(line) +
                        ": cuSPARSE: " + cusparseGetErrorString(status));
}

}  // namespace treacle

#define TREACLE_CUSPARSE_CHECK(call) ::treacle::cusparseCheck((call), __FILE__, __LINE__)
