#pragma once

namespace treacle {

/// Backend tags: free functions of the same name and signature are overloaded on them.
struct Cpu {};
struct Cuda {};

template <class Backend>
class Context;

/// The CPU needs no stream; parallel loops take their threads from OpenMP.
template <>
class Context<Cpu> {};

}  // namespace treacle
