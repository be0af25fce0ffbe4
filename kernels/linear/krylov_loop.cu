#include "treacle/linear/krylov_loop.hpp"

#include "core/launch.hpp"
#include "treacle/core/device_link.hpp"

namespace treacle {
namespace {

/// One thread: another round of the loop while the scalars say Running.
__global__ void setLoopCondition(cudaGraphConditionalHandle loop, const KrylovScalars* scalars) {
  cudaGraphSetConditional(loop, scalars->status == SolveStatus::Running);
}

}  // namespace

KrylovLoop<Cuda>::~KrylovLoop() {
  if (graph_) cudaGraphExecDestroy(graph_);
  if (source_) cudaGraphDestroy(source_);
}

KrylovScalars* KrylovLoop<Cuda>::begin(Context<Cuda>& context, const StoppingRule& rule) {
  scalars_.resize(context, 1);
  const KrylovScalars start{rule};
  copyBytesToDevice(context, &start, scalars_.data(), sizeof(start));
  return scalars_.data();
}

SolveReport KrylovLoop<Cuda>::report(Context<Cuda>& context) const {
  return valueOnHost(context, scalars_.data()).report();
}

void KrylovLoop<Cuda>::record(Context<Cuda>& context, const std::function<void()>& body) {
  if (!context.usesGraphs() || (context.link && !context.link->canBeRecorded())) {
    body_ = body;
    return;
  }
  cudaGraph_t whole = nullptr;
  TREACLE_CUDA_CHECK(cudaGraphCreate(&whole, 0));
  if (source_) cudaGraphDestroy(source_);
  source_ = whole;
  capture(context, body, whole);

  cudaGraphExecUpdateResultInfo result{};
  if (graph_ && cudaGraphExecUpdate(graph_, whole, &result) == cudaSuccess) return;
  static_cast<void>(cudaGetLastError());  // another set of kernels: a graph of its own
  if (graph_) TREACLE_CUDA_CHECK(cudaGraphExecDestroy(std::exchange(graph_, nullptr)));
  TREACLE_CUDA_CHECK(cudaGraphInstantiate(&graph_, whole, 0));
}

void KrylovLoop<Cuda>::capture(Context<Cuda>& context, const std::function<void()>& body, CUgraph_st* whole) {
  cudaGraphConditionalHandle loop;
  TREACLE_CUDA_CHECK(cudaGraphConditionalHandleCreate(&loop, whole, 1, cudaGraphCondAssignDefault));
  cudaGraphNodeParams node{};
  node.type = cudaGraphNodeTypeConditional;
  node.conditional.handle = loop;
  node.conditional.type = cudaGraphCondTypeWhile;
  node.conditional.size = 1;
  cudaGraphNode_t added;
  TREACLE_CUDA_CHECK(cudaGraphAddNode(&added, whole, nullptr, nullptr, 0, &node));

  TREACLE_CUDA_CHECK(cudaStreamBeginCaptureToGraph(context.stream(), node.conditional.phGraph_out[0], nullptr,
                                                   nullptr, 0, cudaStreamCaptureModeThreadLocal));
  try {
    body();
    launch(context, 1, 1, 0, setLoopCondition, loop, scalars_.data());
  } catch (...) {
    cudaGraph_t unfinished = nullptr;
    cudaStreamEndCapture(context.stream(), &unfinished);
    cudaGetLastError();  // what is thrown says more, and the next call must not meet this
    throw;
  }
  cudaGraph_t captured = nullptr;
  TREACLE_CUDA_CHECK(cudaStreamEndCapture(context.stream(), &captured));
}

SolveReport KrylovLoop<Cuda>::run(Context<Cuda>& context) {
  KrylovScalars* scalars = scalars_.data();
  forEach(context, 1, [=] __device__(std::size_t) { scalars->status = SolveStatus::Running; });
  if (graph_) {
    TREACLE_CUDA_CHECK(cudaGraphLaunch(graph_, context.stream()));
    return report(context);
  }
  SolveReport now;
  do {
    body_();
    now = report(context);
  } while (now.status == SolveStatus::Running);
  return now;
}

}  // namespace treacle
