#pragma once

#include "treacle/core/cuda.hpp"

#include <cusparse.h>

#include <span>
#include <string>

namespace treacle {

#define TREACLE_CUSPARSE_FUNCTIONS(DO) \
  DO(Create)                           \
  DO(Destroy)                          \
  DO(SetStream)                        \
  DO(GetErrorString)                   \
  DO(CreateCsr)                        \
  DO(DestroySpMat)                     \
  DO(SpMatGetSize)                     \
  DO(CsrSetPointers)                   \
  DO(SpGEMM_createDescr)               \
  DO(SpGEMM_destroyDescr)              \
  DO(SpGEMM_workEstimation)            \
  DO(SpGEMM_estimateMemory)            \
  DO(SpGEMM_compute)                   \
  DO(SpGEMM_copy)                      \
  DO(Csr2cscEx2_bufferSize)            \
  DO(Csr2cscEx2)

/// The functions of cuSPARSE that treacle calls, by their names without "cusparse". The program does not link the
/// library, so it starts where the library is missing.
struct Cusparse {
#define TREACLE_CUSPARSE_MEMBER(name) decltype(&::cusparse##name) name = nullptr;
  TREACLE_CUSPARSE_FUNCTIONS(TREACLE_CUSPARSE_MEMBER)
#undef TREACLE_CUSPARSE_MEMBER
};

/// Loads the first of `files` that the dynamic loader finds. Errors: RunError, which says what to install.
Cusparse loadCusparse(std::span<const std::string> files);

/// The library of the CUDA version that treacle was built with. The first call loads it. Errors: as above.
const Cusparse& cusparse();

/// Throws DeviceFailure with the place and cuSPARSE's own words unless the call succeeded.
inline void cusparseCheck(cusparseStatus_t status, const char* file, int line) {
  if (status != CUSPARSE_STATUS_SUCCESS)
    throw DeviceFailure(std::string(file) + ":" + std::to_string(line) +
                        ": cuSPARSE: " + cusparse().GetErrorString(status));
}

}  // namespace treacle

#define TREACLE_CUSPARSE_CHECK(call) ::treacle::cusparseCheck((call), __FILE__, __LINE__)
