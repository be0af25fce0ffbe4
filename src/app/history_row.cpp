#include "history_row.hpp"

#include <cmath>

namespace treacle {

HistoryRow historyRow(const Case& c, const StepReport& r) {
  const Diagnostics& d = r.diagnostics;
  const PhaseSeconds& s = r.seconds;
  HistoryRow row;
  row.step = r.step, row.time = r.time, row.timeStep = r.timeStep;
  row.iterations = r.iterations, row.residual = r.residual, row.fallbacks = r.fallbacks;
  row.kineticEnergy = d.kineticEnergy, row.potentialEnergy = d.potentialEnergy;
  row.frontX = d.frontX, row.top = d.top, row.maxSpeed = d.maxSpeed;
  row.meanDensity = d.meanDensityRatio, row.densityError = d.meanDensityError;
  row.seconds = s.total();
  if (r.flow) {
    const auto flow = [&](const FlowCount& count) {
      return HistoryFlow{count.particles, static_cast<double>(count.particles) * std::pow(c.spacing, c.dimensions),
                         count.mass};
    };
    row.particles = r.flow->particles, row.inflow = flow(r.flow->in), row.outflow = flow(r.flow->out);
  }
  if (r.gas) row.gas = {r.gas->pockets, r.gas->volume, r.gas->pressure};
  row.timings = {s.search, s.lists, s.coefficients, s.coarse, s.solve, s.update};
  return row;
}

}  // namespace treacle
