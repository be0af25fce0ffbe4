#pragma once

namespace treacle {

struct BuildInfo {
  const char* version;
  const char* commit;
  const char* buildType;
  const char* compiler;
  const char* native;         // "ON": optimised for the processor of the building machine
  const char* cuda;           // "ON": the CUDA backend was compiled
  const char* mpi;            // "ON": several processes can share a case
  const char* architectures;  // for which, as CMAKE_CUDA_ARCHITECTURES names them
};

BuildInfo buildInfo();

}  // namespace treacle
