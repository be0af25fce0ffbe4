#pragma once

#include "step_phases.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/model/wall_motion.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace treacle {

/// The state of a simulation and what a step makes of it, the same for all methods.
template <int D, class Backend>
struct FlowState {
  Case theCase;
  std::int64_t step;  // steps done
  double time;        // [s]
  double timeStep;    // of the step at hand, or the last one [s]
  bool wallsMove = false;

  mutable Context<Backend> context;
  Particles<D, Backend> particles;
  Buffer<WallMotion<D>, Backend> wallMotion;   // per body, of the step; empty: all walls keep their velocities
  Buffer<Vec<D>, Backend> velocity, position;  // the step's results before they are accepted

  StepPhases<Backend> phases;  // of the step at hand

  FlowState(const Case& c, std::int64_t startStep, double startTime)
      : theCase(c), step(startStep), time(startTime), timeStep(c.time.step) {}
};

/// Copies and zeros within a backend's memory.
template <class T>
void copyValues(Context<Cpu>&, std::span<const T> from, T* to) {
  std::copy(from.begin(), from.end(), to);
}
template <class T>
void copyValues(Context<Cuda>& context, std::span<const T> from, T* to) {
  if (!from.empty()) copyBytesOnDevice(context, from.data(), to, from.size_bytes());
}
template <class T>
void clearValues(Context<Cpu>&, std::span<T> values) {
  std::fill(values.begin(), values.end(), T{});
}
template <class T>
void clearValues(Context<Cuda>& context, std::span<T> values) {
  if (!values.empty()) clearBytes(context, values.data(), values.size_bytes());
}
/// From the host's memory.
template <class T>
void fromHost(Context<Cpu>& context, std::span<const T> host, Buffer<T>& to) {
  to.resize(context, host.size());
  std::copy(host.begin(), host.end(), to.begin());
}
template <class T>
void fromHost(Context<Cuda>& context, std::span<const T> host, Buffer<T, Cuda>& to) {
  copyToDevice(context, host, to);
}

}  // namespace treacle
