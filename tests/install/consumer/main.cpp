// A program outside the project: one time step of a square of fluid that falls freely, through installed headers.
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cmath>
#include <cstdio>

int main() {
  treacle::Case c;
  c.dimensions = 2;
  c.spacing = 1e-3;  // [m]
  c.domain = {{-0.02, -0.02, 0}, {0.03, 0.03, 0}, {}};
  c.gravity = {0, -10, 0};  // [m/s2]
  c.materials = {{"syrup", 1000, 10, 1e4, 1e6}};
  c.time = {1e-3, 1e-3};  // [s]
  treacle::Body drop;
  drop.shape.max = {0.01, 0.01, 0};  // [m]
  c.bodies = {drop};

  std::vector<std::string> notes;
  treacle::Simulation<2> simulation(c, treacle::createParticles<2>(c, notes));
  const treacle::StepReport report = simulation.advance();

  const double expected = 10 * 1e-3;  // g dt [m/s]
  std::printf("after one step the drop falls at %g m/s, expected %g\n", report.diagnostics.maxSpeed, expected);
  return std::abs(report.diagnostics.maxSpeed - expected) < 1e-5 * expected ? 0 : 1;
}
