#pragma once

#include "treacle/linear/krylov_loop.hpp"

#include <functional>
#include <string>

struct CUgraphExec_st;

namespace treacle {

/// Repeats an iteration that calls the CUDA libraries: as a loop on the device inside one graph; where a library
/// does what such a graph cannot hold, as a graph that the host launches once per iteration; else call by call.
class LibraryLoop {
 public:
  LibraryLoop() = default;
  LibraryLoop(const LibraryLoop&) = delete;
  ~LibraryLoop();

  KrylovScalars* begin(Context<Cuda>& context, const StoppingRule& rule) { return device_.begin(context, rule); }
  /// `body` must have run once: the libraries load what they need at the first call, which a recording forbids.
  void record(Context<Cuda>&, const std::function<void()>& body);
  /// Iterates as long as the scalars say Running, which they must have been brought to.
  SolveReport run(Context<Cuda>&);

  /// Which of the three.
  const std::string& kind() const { return kind_; }

 private:
  void recordOnce(Context<Cuda>&);
  void release();

  KrylovLoop<Cuda> device_;
  CUgraphExec_st* iteration_ = nullptr;
  std::function<void()> body_;
  std::string kind_;
};

}  // namespace treacle
