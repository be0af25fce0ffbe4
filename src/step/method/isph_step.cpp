#include "isph_step.hpp"

namespace treacle {

template <int D, class Backend>
std::unique_ptr<StepMethod<D, Backend>> makeIsphStep(FlowState<D, Backend>& state) {
  return std::make_unique<IsphStep<D, Backend>>(state);
}

#define TREACLE_INSTANTIATE(Backend)                                                     \
  template std::unique_ptr<StepMethod<2, Backend>> makeIsphStep(FlowState<2, Backend>&); \
  template std::unique_ptr<StepMethod<3, Backend>> makeIsphStep(FlowState<3, Backend>&);
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
