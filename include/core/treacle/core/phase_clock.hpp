#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/timer.hpp"

#include <cstddef>
#include <vector>

struct CUevent_st;

namespace treacle {

/// Seconds between marks in the order of a backend's work: mark(context) ends a phase; seconds() gives the lengths
/// of all phases since start() and waits for the last one.
template <class Backend>
class PhaseClock;

template <>
class PhaseClock<Cpu> {
 public:
  void start(Context<Cpu>&) {
    laps_.clear();
    timer_ = {};
  }
  void mark(Context<Cpu>&) { laps_.push_back(timer_.lap()); }
  const std::vector<double>& seconds() { return laps_; }

 private:
  Timer timer_;
  std::vector<double> laps_;
};

/// By CUDA events on the context's stream: the host does not wait at a mark.
template <>
class PhaseClock<Cuda> {
 public:
  PhaseClock() = default;
  PhaseClock(const PhaseClock&) = delete;
  PhaseClock& operator=(const PhaseClock&) = delete;
  ~PhaseClock();

  void start(Context<Cuda>&);
  void mark(Context<Cuda>&);
  const std::vector<double>& seconds();

 private:
  std::vector<CUevent_st*> events_;  // kept from step to step
  std::size_t used_ = 0;
  std::vector<double> laps_;
};

}  // namespace treacle
