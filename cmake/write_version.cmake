# Script mode: writes version.cpp; leaves it alone when nothing changed.
set(COMMIT unknown)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(COMMIT ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "treacle/core/version.hpp"

namespace treacle {
BuildInfo buildInfo() {
  return {"@VERSION@", "@COMMIT@", "@BUILD_TYPE@", "@COMPILER@", "@NATIVE@", "@CUDA@", "@MPI@", "@ARCHITECTURES@"};
}
}  // namespace treacle
]])
