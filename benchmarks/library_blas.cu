#include "library_blas.hpp"

#include "core/reduce.cuh"

#include <cublas_v2.h>
#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>

namespace treacle {
namespace {

constexpr std::size_t workspaceBytes = std::size_t{32} << 20;  // what cuBLAS recommends for Hopper

void* openCublas() {
  if (const char* named = std::getenv("TREACLE_CUBLAS")) {
    if (void* library = dlopen(named, RTLD_NOW | RTLD_LOCAL)) return library;
    throw std::runtime_error(std::string("TREACLE_CUBLAS: ") + dlerror());
  }
  for (const char* name :
       {"libcublas.so.13", "libcublas.so.12", "libcublas.so", "/usr/local/cuda/lib64/libcublas.so"})
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  return nullptr;
}

void check(cublasStatus_t status, const char* call) {
  if (status != CUBLAS_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cuBLAS: ") + call + " failed with status " +
                             std::to_string(static_cast<int>(status)));
}

template <class F>
void find(void* library, const char* name, F*& function) {
  function = reinterpret_cast<F*>(dlsym(library, name));
  if (!function) throw std::runtime_error(std::string("cuBLAS: ") + dlerror());
}

}  // namespace

/// cuBLAS and a handle of it; stays loaded to the end of the program.
struct LibraryBlas::Library {
  decltype(cublasCreate_v2)* create;
  decltype(cublasDestroy_v2)* destroy;
  decltype(cublasGetVersion_v2)* getVersion;
  decltype(cublasSetStream_v2)* setStream;
  decltype(cublasSetWorkspace_v2)* setWorkspace;
  decltype(cublasSetPointerMode_v2)* setPointerMode;
  decltype(cublasDdot_v2)* ddot;
  decltype(cublasDaxpy_v2)* daxpy;
  decltype(cublasDscal_v2)* dscal;
  cublasHandle_t handle = nullptr;

  explicit Library(void* library) {
    find(library, "cublasCreate_v2", create);
    find(library, "cublasDestroy_v2", destroy);
    find(library, "cublasGetVersion_v2", getVersion);
    find(library, "cublasSetStream_v2", setStream);
    find(library, "cublasSetWorkspace_v2", setWorkspace);
    find(library, "cublasSetPointerMode_v2", setPointerMode);
    find(library, "cublasDdot_v2", ddot);
    find(library, "cublasDaxpy_v2", daxpy);
    find(library, "cublasDscal_v2", dscal);
    check(create(&handle), "cublasCreate");
  }
  Library(const Library&) = delete;
  ~Library() { destroy(handle); }

  std::string version() const {
    int number = 0;
    check(getVersion(handle, &number), "cublasGetVersion");
    return std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
           std::to_string(number % 100);
  }
};

LibraryBlas::LibraryBlas(Context<Cuda>& context) : context_(context), name_("own kernels (no cuBLAS found)") {
  void* const opened = openCublas();
  if (!opened) return;
  library_ = std::make_unique<Library>(opened);
  // The workspace: else cuBLAS would allocate while a graph is recorded, which the body of a loop cannot hold.
  workspace_.resize(context, workspaceBytes);
  check(library_->setStream(library_->handle, context.stream()), "cublasSetStream");
  check(library_->setWorkspace(library_->handle, workspace_.data(), workspaceBytes), "cublasSetWorkspace");
  check(library_->setPointerMode(library_->handle, CUBLAS_POINTER_MODE_DEVICE), "cublasSetPointerMode");
  name_ = "cuBLAS " + library_->version();
}

LibraryBlas::~LibraryBlas() = default;

void LibraryBlas::dot(std::span<const double> x, std::span<const double> y, double* result) {
  const int n = static_cast<int>(x.size());
  if (library_) return check(library_->ddot(library_->handle, n, x.data(), 1, y.data(), 1, result), "cublasDdot");
  reduce(
      context_, x.size(), [x = x.data(), y = y.data()] __device__(std::size_t i) { return x[i] * y[i]; },
      [=] __device__(double sum) { *result = sum; });
}

void LibraryBlas::axpy(const double* a, std::span<const double> x, std::span<double> y) {
  const int n = static_cast<int>(x.size());
  if (library_) return check(library_->daxpy(library_->handle, n, a, x.data(), 1, y.data(), 1), "cublasDaxpy");
  forEach(context_, x.size(), [=, x = x.data(), y = y.data()] __device__(std::size_t i) { y[i] += *a * x[i]; });
}

void LibraryBlas::scale(const double* a, std::span<double> x) {
  const int n = static_cast<int>(x.size());
  if (library_) return check(library_->dscal(library_->handle, n, a, x.data(), 1), "cublasDscal");
  forEach(context_, x.size(), [=, x = x.data()] __device__(std::size_t i) { x[i] *= *a; });
}

}  // namespace treacle
