#pragma once

#include <vector>

namespace treacle {

/// Backend tags: free functions of the same name and signature are overloaded on them.
struct Cpu {};
struct Cuda {};

template <class Backend>
class Context;

/// The CPU needs no stream; parallel loops take their threads from OpenMP.
template <>
class Context<Cpu> {
 public:
  /// Room for the chunks' sums of a reduction; kept, so that nothing is allocated inside an iteration.
  std::vector<double> partialSums;
};

}  // namespace treacle
