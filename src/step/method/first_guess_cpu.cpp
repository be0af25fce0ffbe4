#include "treacle/step/method/first_guess.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D>
void extrapolate(Context<Cpu>&, const Extrapolation<D>& next, std::span<const Vec<D>> u, FlowMemory<D> memory,
                 std::span<Vec<D>> guess) {
  parallelFor(guess.size(), parallelGrain,
              [&](std::size_t i) { guess[i] = next(u[i], memory.acceleration[i], memory.jerk[i]); });
}

template <int D>
void updateFlowMemory(Context<Cpu>&, double dt, double lastStep, std::span<const Vec<D>> before,
                      std::span<const Vec<D>> after, FlowMemory<D> memory) {
  parallelFor(after.size(), parallelGrain, [&](std::size_t i) {
    const auto r = MotionDerivatives<D>::make(dt, lastStep, before[i], after[i], memory.acceleration[i]);
    memory.acceleration[i] = r.acceleration;
    memory.jerk[i] = r.jerk;
  });
}

template void extrapolate<2>(Context<Cpu>&, const Extrapolation<2>&, std::span<const Vec<2>>, FlowMemory<2>,
                             std::span<Vec<2>>);
template void extrapolate<3>(Context<Cpu>&, const Extrapolation<3>&, std::span<const Vec<3>>, FlowMemory<3>,
                             std::span<Vec<3>>);
template void updateFlowMemory<2>(Context<Cpu>&, double, double, std::span<const Vec<2>>, std::span<const Vec<2>>,
                                  FlowMemory<2>);
template void updateFlowMemory<3>(Context<Cpu>&, double, double, std::span<const Vec<3>>, std::span<const Vec<3>>,
                                  FlowMemory<3>);

}  // namespace treacle
