#pragma once

#include "run/flow_state.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace treacle {

/// The fluid that comes into a state by the inflows of its case and leaves it by the outflows, after each step.
template <int D, class Backend>
class OpenBoundaries {
 public:
  explicit OpenBoundaries(FlowState<D, Backend>& state);

  /// What came and went so far begins with the state, of so many particles, where it does not know. Collective.
  void begin(Particles<D>& particles) const;

  /// The step from `start` [s] has been accepted. `density`: what new particles are shown with until a step has
  /// computed theirs. Returns whether the fluid is another now, and is to be sorted anew. Collective. Errors:
  /// RunError where a nozzle is outside the domain or no fluid is left; std::bad_alloc.
  bool follow(const CellGrid<D>& grid, double start, double density);

  std::size_t bytes() const { return gone_.bytes(); }

 private:
  /// What a step changes, before anything of the state is touched.
  struct Change {
    OpenFlow flow;                // as it will be
    std::uint64_t left = 0;       // particles that go, of all processes
    Particles<D> added;           // that come
    std::vector<double> setBack;  // per body: how far the layers of its nozzle are [m]
  };

  void letOut(Change& change);
  void letIn(const CellGrid<D>& grid, double start, Change& change) const;
  void addLayer(const CellGrid<D>& grid, std::size_t body, double way, Change& change) const;

  FlowState<D, Backend>& state_;
  double volume_;  // of a particle [m3; m2 in 2D]
  Buffer<OutflowRegion<D>, Backend> regions_;
  Buffer<std::uint8_t, Backend> gone_;  // per own fluid particle
};

}  // namespace treacle
