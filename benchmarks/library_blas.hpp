#pragma once

#include "treacle/core/cuda.hpp"

#include <memory>
#include <span>
#include <string>

namespace treacle {

/// The vector operations of a Krylov method by cuBLAS, all scalars in device memory. The library is looked for
/// when the program runs (TREACLE_CUBLAS names a file), not linked: it is too large to be carried to the machine
/// with the GPU, and the versions there and here differ. Where there is none, own kernels do the same; name() says
/// so.
class LibraryBlas {
 public:
  /// Errors: std::runtime_error for a cuBLAS that does not start.
  explicit LibraryBlas(Context<Cuda>&);
  ~LibraryBlas();

  const std::string& name() const { return name_; }

  /// *result = x.y
  void dot(std::span<const double> x, std::span<const double> y, double* result);
  /// y += *a x
  void axpy(const double* a, std::span<const double> x, std::span<double> y);
  /// x *= *a
  void scale(const double* a, std::span<double> x);

 private:
  struct Library;
  Context<Cuda>& context_;
  Buffer<std::byte, Cuda> workspace_;
  std::unique_ptr<Library> library_;  // null: own kernels
  std::string name_;
};

}  // namespace treacle
