#include "library_loop.hpp"

#include "core/cuda_check.hpp"

#include <cstdio>
#include <utility>

namespace treacle {

namespace {

constexpr const char* loopKind = "device loop";
constexpr const char* graphKind = "graph per iteration";
constexpr const char* callKind = "single calls";

void report(const char* what, const std::exception& error) {
  std::fprintf(stderr, "CUDA libraries: no %s: %s\n", what, error.what());
  cudaGetLastError();  // must not meet the next call
}

}  // namespace

LibraryLoop::~LibraryLoop() { release(); }

void LibraryLoop::release() {
  if (iteration_) cudaGraphExecDestroy(std::exchange(iteration_, nullptr));
}

void LibraryLoop::record(Context<Cuda>& context, const std::function<void()>& body) {
  release();
  body_ = body;
  if (!context.usesGraphs()) {
    kind_ = callKind;
    return;
  }
  // What failed once is not tried again.
  if (kind_.empty() || kind_ == loopKind) try {
      device_.record(context, body);
      kind_ = loopKind;
      return;
    } catch (const std::exception& error) {
      report(loopKind, error);
      kind_ = graphKind;
    }
  if (kind_ == graphKind) try {
      recordOnce(context);
    } catch (const std::exception& error) {
      report(graphKind, error);
      kind_ = callKind;
    }
}

void LibraryLoop::recordOnce(Context<Cuda>& context) {
  TREACLE_CUDA_CHECK(cudaStreamBeginCapture(context.stream(), cudaStreamCaptureModeThreadLocal));
  cudaGraph_t graph = nullptr;
  try {
    body_();
  } catch (...) {
    cudaStreamEndCapture(context.stream(), &graph);
    if (graph) cudaGraphDestroy(graph);
    throw;
  }
  TREACLE_CUDA_CHECK(cudaStreamEndCapture(context.stream(), &graph));
  const cudaError_t status = cudaGraphInstantiate(&iteration_, graph, 0);
  cudaGraphDestroy(graph);
  TREACLE_CUDA_CHECK(status);
}

SolveReport LibraryLoop::run(Context<Cuda>& context) {
  SolveReport now = device_.report(context);
  if (now.status != SolveStatus::Running) return now;
  if (kind_ == loopKind) return device_.run(context);
  do {
    if (iteration_)
      TREACLE_CUDA_CHECK(cudaGraphLaunch(iteration_, context.stream()));
    else
      body_();
    now = device_.report(context);
  } while (now.status == SolveStatus::Running);
  return now;
}

}  // namespace treacle
