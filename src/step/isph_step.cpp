#include "isph_step.hpp"

namespace treacle {

template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeIsphStep(FlowState<D, Backend>& state) {
  return std::make_unique<IsphStep<D, Backend>>(state);
}

template std::unique_ptr<StepMethod<2, Cpu>> makeIsphStep(FlowState<2, Cpu>&);
template std::unique_ptr<StepMethod<3, Cpu>> makeIsphStep(FlowState<3, Cpu>&);
#ifdef TREACLE_HAS_CUDA
template std::unique_ptr<StepMethod<2, Cuda>> makeIsphStep(FlowState<2, Cuda>&);
template std::unique_ptr<StepMethod<3, Cuda>> makeIsphStep(FlowState<3, Cuda>&);
#endif

}  // namespace treacle
