#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/linear/krylov_scalars.hpp"

#include <functional>

struct CUgraph_st;
struct CUgraphExec_st;

namespace treacle {

/// Runs the iterations of a Krylov method: `body` again and again, until the scalars' status says otherwise.
template <class Backend>
class KrylovLoop;

template <>
class KrylovLoop<Cpu> {
 public:
  /// Room for the scalars, with the rule of a new solve.
  KrylovScalars* begin(Context<Cpu>&, const StoppingRule& rule) {
    scalars_ = {rule};
    return &scalars_;
  }
  SolveReport report(Context<Cpu>&) const { return scalars_.report(); }
  void record(Context<Cpu>&, std::function<void()> body) { body_ = std::move(body); }
  /// Iterates from Running or Refresh to any other status (or the next Refresh).
  SolveReport run(Context<Cpu>&) {
    scalars_.status = SolveStatus::Running;
    while (scalars_.status == SolveStatus::Running) body_();
    return scalars_.report();
  }

 private:
  KrylovScalars scalars_;
  std::function<void()> body_;
};

/// On the device the loop is a graph with a conditional node: the host launches it once and looks at the scalars
/// when it has ended. The graph of the last solve is kept, since to give its kernels new arguments takes a third
/// of the time that a new graph takes. The host starts each iteration where a link to other devices cannot be a
/// part of that (DeviceLink::canBeRecorded).
template <>
class KrylovLoop<Cuda> {
 public:
  KrylovLoop() = default;
  KrylovLoop(const KrylovLoop&) = delete;
  KrylovLoop& operator=(const KrylovLoop&) = delete;
  ~KrylovLoop();

  KrylovScalars* begin(Context<Cuda>&, const StoppingRule& rule);
  SolveReport report(Context<Cuda>&) const;
  /// `body` may launch kernels on the context's stream, nothing else.
  void record(Context<Cuda>&, const std::function<void()>& body);
  SolveReport run(Context<Cuda>&);

 private:
  void capture(Context<Cuda>&, const std::function<void()>& body, CUgraph_st* graph);

  Buffer<KrylovScalars, Cuda> scalars_;
  CUgraph_st* source_ = nullptr;  // what the graph was made of last: its condition is known to both
  CUgraphExec_st* graph_ = nullptr;
  std::function<void()> body_;  // where it does without a graph
};

}  // namespace treacle
