#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace treacle {

/// Backend tags: free functions of the same name and signature are overloaded on them.
struct Cpu {};
struct Cuda {};

/// The same for choices at run time.
enum class BackendKind { Cpu, Cuda };

#ifdef TREACLE_HAS_CUDA
inline constexpr bool cudaCompiled = true;
#else
inline constexpr bool cudaCompiled = false;
#endif

template <class Backend>
class Context;

class Communicator;
template <class Backend>
class Halo;

/// Who shares a simulation: carried by its context, so that whatever sums over its particles, or needs those of
/// other processes, knows of them (processes.hpp, halo.hpp). Null in a simulation that is alone.
struct Processes {
  const Communicator* communicator = nullptr;
};

/// T on a device; on the CPU an object that holds nothing.
struct Absent {
  std::size_t bytes() const { return 0; }
};
template <class T, class Backend>
using DeviceOnly = std::conditional_t<std::is_same_v<Backend, Cuda>, T, Absent>;

/// The CPU needs no stream; parallel loops take their threads from OpenMP.
template <>
class Context<Cpu> : public Processes {
 public:
  Halo<Cpu>* halo = nullptr;  // of the particles as they were sorted last; null in a simulation that is alone

  /// Room for the chunks' sums of a reduction; kept, so that nothing is allocated inside an iteration.
  std::vector<double> partialSums;

  /// As that of Context<Cuda>.
  void* scratch(std::size_t bytes) {
    if (scratch_.size() * sizeof(double) < bytes) scratch_.resize((bytes + sizeof(double) - 1) / sizeof(double));
    return scratch_.data();
  }

 private:
  std::vector<double> scratch_;
};

}  // namespace treacle
