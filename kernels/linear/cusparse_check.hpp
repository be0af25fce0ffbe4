#pragma once

#include <cusparse.h>

#include <stdexcept>
#include <string>

namespace treacle {

/// Throws with the place and cuSPARSE's own words unless the call succeeded.
inline void cusparseCheck(cusparseStatus_t status, const char* file, int line) {
  if (status != CUSPARSE_STATUS_SUCCESS)
    throw std::runtime_error(std::string(file) + ":" + std::to_string(line) +
                             ": cuSPARSE: " + cusparseGetErrorString(status));
}

}  // namespace treacle

#define TREACLE_CUSPARSE_CHECK(call) ::treacle::cusparseCheck((call), __FILE__, __LINE__)
