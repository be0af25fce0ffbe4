#include "treacle/core/phase_clock.hpp"

#include "core/cuda_check.hpp"
#include "treacle/core/cuda.hpp"

namespace treacle {

PhaseClock<Cuda>::~PhaseClock() {
  for (cudaEvent_t event : events_) cudaEventDestroy(event);
}

void PhaseClock<Cuda>::start(Context<Cuda>& context) {
  used_ = 0;
  mark(context);
}

void PhaseClock<Cuda>::mark(Context<Cuda>& context) {
  if (used_ == events_.size()) {
    cudaEvent_t event = nullptr;
    TREACLE_CUDA_CHECK(cudaEventCreate(&event));
    events_.push_back(event);
  }
  TREACLE_CUDA_CHECK(cudaEventRecord(events_[used_], context.stream()));
  ++used_;
}

const std::vector<double>& PhaseClock<Cuda>::seconds() {
  laps_.clear();
  if (used_ > 0) TREACLE_CUDA_CHECK(cudaEventSynchronize(events_[used_ - 1]));
  for (std::size_t i = 1; i < used_; ++i) {
    float milliseconds = 0;
    TREACLE_CUDA_CHECK(cudaEventElapsedTime(&milliseconds, events_[i - 1], events_[i]));
    laps_.push_back(1e-3 * milliseconds);
  }
  return laps_;
}

}  // namespace treacle
