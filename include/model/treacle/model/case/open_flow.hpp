#pragma once

#include <cstdint>
#include <vector>

namespace treacle {

/// Particles that have come or gone since the start of a case, and what they weigh [kg; per metre of depth in 2D].
struct FlowCount {
  std::uint64_t particles = 0;
  double mass = 0;

  FlowCount& operator+=(const FlowCount& o) {
    particles += o.particles, mass += o.mass;
    return *this;
  }
  bool operator==(const FlowCount&) const = default;
};

/// What a run remembers of the fluid that comes and goes; nothing, zero and empty, where none does.
struct OpenFlow {
  struct Inflow : FlowCount {
    // Of its columns of particles since one of theirs left the nozzle; one number where all go together [m].
    std::vector<double> ways = {0.0};

    bool operator==(const Inflow&) const = default;
  };

  std::uint32_t nextId = 0;           // of the next particle that comes
  std::vector<Inflow> inflows{};      // per body of the case, zero for those that are none
  std::vector<FlowCount> outflows{};  // per outflow of the case
  struct Opening {
    FlowCount in, out;
    double drag = 0;      // OpeningForce::drag of the next step [N/m3]
    double pressure = 0;  // of the last step, where a flow rate is given [Pa]

    bool operator==(const Opening&) const = default;
  };
  std::vector<Opening> openings{};  // per opening of the case

  FlowCount in() const {
    FlowCount sum;
    for (const Inflow& i : inflows) sum += i;
    for (const Opening& o : openings) sum += o.in;
    return sum;
  }
  FlowCount out() const {
    FlowCount sum;
    for (const FlowCount& o : outflows) sum += o;
    for (const Opening& o : openings) sum += o.out;
    return sum;
  }

  bool operator==(const OpenFlow&) const = default;
};

}  // namespace treacle
