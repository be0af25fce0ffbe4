#include "treacle/step/method/first_guess.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per fluid particle; reads its velocity, acceleration and jerk, writes its first guess. No atomics.
template <int D>
void extrapolate(Context<Cuda>& context, const Extrapolation<D>& next, std::span<const Vec<D>> u,
                 FlowMemory<D> memory, std::span<Vec<D>> guess) {
  forEach(context, guess.size(), [next, u, memory, guess] __device__(std::size_t i) {
    guess[i] = next(u[i], memory.acceleration[i], memory.jerk[i]);
  });
}

/// One thread per fluid particle; reads its velocities and acceleration, writes acceleration and jerk. No atomics.
template <int D>
void updateFlowMemory(Context<Cuda>& context, double dt, double lastStep, std::span<const Vec<D>> before,
                      std::span<const Vec<D>> after, FlowMemory<D> memory) {
  forEach(context, after.size(), [dt, lastStep, before, after, memory] __device__(std::size_t i) {
    const auto r = MotionDerivatives<D>::make(dt, lastStep, before[i], after[i], memory.acceleration[i]);
    memory.acceleration[i] = r.acceleration;
    memory.jerk[i] = r.jerk;
  });
}

template void extrapolate<2>(Context<Cuda>&, const Extrapolation<2>&, std::span<const Vec<2>>, FlowMemory<2>,
                             std::span<Vec<2>>);
template void extrapolate<3>(Context<Cuda>&, const Extrapolation<3>&, std::span<const Vec<3>>, FlowMemory<3>,
                             std::span<Vec<3>>);
template void updateFlowMemory<2>(Context<Cuda>&, double, double, std::span<const Vec<2>>, std::span<const Vec<2>>,
                                  FlowMemory<2>);
template void updateFlowMemory<3>(Context<Cuda>&, double, double, std::span<const Vec<3>>, std::span<const Vec<3>>,
                                  FlowMemory<3>);

}  // namespace treacle
