#include "linear/cusparse.hpp"

#include "treacle/core/error.hpp"

#include <dlfcn.h>

namespace treacle {
namespace {

#define TREACLE_TEXT_OF(number) #number
#define TREACLE_TEXT(number) TREACLE_TEXT_OF(number)
constexpr const char* cusparseFile = "libcusparse.so." TREACLE_TEXT(CUSPARSE_VER_MAJOR);
#undef TREACLE_TEXT
#undef TREACLE_TEXT_OF

constexpr int cudaMajor = CUDART_VERSION / 1000;

[[noreturn]] void throwMissing(const std::string& reason) {
  const std::string package = cudaMajor == 12 ? "nvidia-cusparse-cu12" : "nvidia-cusparse";
  throw RunError("products of sparse matrices on a GPU need NVIDIA's cuSPARSE: " + reason +
                 "; install cuSPARSE of CUDA " + std::to_string(cudaMajor) +
                 " from the CUDA toolkit or your distribution, or by 'pip install " + package +
                 "', and name its folder in LD_LIBRARY_PATH if the dynamic loader does not search it");
}

}  // namespace

Cusparse loadCusparse(std::span<const std::string> files) {
  void* library = nullptr;
  std::string reason;
  for (const std::string& file : files) {
    library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library) break;
    if (reason.empty()) reason = dlerror();
  }
  if (!library) throwMissing(reason);
  const auto find = [&]<class Function>(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(library, name));
    if (!function) throwMissing(std::string("the library that was found has no function ") + name);
  };
  Cusparse functions;
#define TREACLE_CUSPARSE_FIND(name) find(functions.name, "cusparse" #name);
  TREACLE_CUSPARSE_FUNCTIONS(TREACLE_CUSPARSE_FIND)
#undef TREACLE_CUSPARSE_FIND
  return functions;
}

const Cusparse& cusparse() {
  // The toolkit's own folder need not be among those that the loader searches.
  static const std::string files[] = {cusparseFile, std::string(TREACLE_CUDA_LIBRARY_DIR "/") + cusparseFile};
  static const Cusparse functions = loadCusparse(files);
  return functions;
}

}  // namespace treacle
