#pragma once

#include "run/step_method.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace treacle {

/// The fluid that comes into a state by the inflows of its case, leaves it by the outflows, and goes either way
/// through the openings, after each step.
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

  /// The friction in the reserves of openings, once the step's velocities are there, for the next step.
  void measureFriction(StepMethod<D, Backend>& method);
  /// What own fluid goes with: in the tails of reserves straight on.
  std::span<const Vec<D>> straightened(std::span<const Vec<D>> u);

  std::size_t bytes() const { return gone_.bytes() + vector_.bytes(); }

 private:
  /// What a step changes, before anything of the state is touched.
  struct Change {
    OpenFlow flow;           // as it will be
    std::uint64_t left = 0;  // particles that go, of all processes
    Particles<D> added;      // that come
    // Per body: how far the columns of its nozzle are, or all of them together; empty where none is [m].
    std::vector<std::vector<double>> setBack;
  };

  void letOut(Change& change);
  void letIn(const CellGrid<D>& grid, double start, Change& change) const;
  void addLayer(const CellGrid<D>& grid, std::size_t body, int layer, std::span<const double> counts,
                Change& change) const;
  void fillReserves(const CellGrid<D>& grid, Change& change);
  void fillReserve(const CellGrid<D>& grid, std::size_t opening, std::span<const ReserveParticle<D>> in,
                   Change& change) const;

  /// What fluid of a source comes with.
  struct Incoming {
    std::string source;
    int material;
    std::size_t body;
    double temperature, viscosityFactor;
  };
  /// Adds particles at rest; returns the first.
  std::uint32_t add(const CellGrid<D>& grid, const Incoming& incoming, std::vector<Vec<D>> places,
                    FlowCount& count, Change& change) const;

  FlowState<D, Backend>& state_;
  double volume_;  // of a particle [m3; m2 in 2D]
  Buffer<OutflowRegion<D>, Backend> regions_;
  Buffer<std::uint8_t, Backend> gone_;  // per own fluid particle
  Buffer<Vec<D>, Backend> vector_;      // likewise, of cases with openings
  std::vector<double> drag_;            // of the next step, per opening [N/m3]
};

}  // namespace treacle
