#include "probe_recorder.hpp"

#include <cstddef>
#include <utility>

namespace treacle {

ProbeRecorder::ProbeRecorder(const Case& c, const Target& target, double start, Measure measure)
    : case_(c), start_(start), measure_(std::move(measure)), patches_(c.probes.size()) {
  for (const Probe& probe : c.probes) {
    writers_.emplace_back(target(probe), c, probe);
    intervals_.emplace_back();
    if (probe.interval > 0) intervals_.back().emplace(probe.interval, c.time, start);
  }
}

void ProbeRecorder::begin() {
  std::uint64_t all = 0;
  for (std::size_t k = 0; k < writers_.size(); ++k) all |= std::uint64_t{1} << k;
  take(all, start_, nullptr);
}

void ProbeRecorder::record(const StepReport& report) {
  std::uint64_t due = 0;
  for (std::size_t k = 0; k < intervals_.size(); ++k)
    if (!intervals_[k] || intervals_[k]->due(report.time)) due |= std::uint64_t{1} << k;
  meanPatches(report);
  take(due, report.time, &report);
}

void ProbeRecorder::meanPatches(const StepReport& step) {
  std::size_t patch = 0;
  for (std::size_t k = 0; k < writers_.size(); ++k)
    if (case_.probes[k].kind == ProbeKind::WallPressure) patches_[k].add(step.patches.at(patch++), step.timeStep);
}

void ProbeRecorder::take(std::uint64_t probes, double time, const StepReport* step) {
  std::uint64_t measured = 0;
  for (std::size_t k = 0; k < writers_.size(); ++k) {
    const std::uint64_t bit = probes & std::uint64_t{1} << k;
    if (!case_.probes[k].isOnWall())
      measured |= bit;
    else if (bit == 0 || !step)
      continue;
    else if (case_.probes[k].kind == ProbeKind::Load)
      writers_[k].append(time, step->loads);
    else
      writers_[k].append(time, std::exchange(patches_[k], {}));
  }
  if (measured == 0) return;
  for (const ProbeReading& reading : measure_(measured)) {
    ProbeWriter& writer = writers_[reading.index];
    if (reading.probe.isSummed()) {
      writer.append(time, reading.probe, reading.sums);
      continue;
    }
    reading.particles.visit([&](const auto& p) {
      Frame fluid = makeFrame(p, 0, p.fluidCount, time);
      addViscosities(case_, fluid);
      writer.append(time, reading.probe, fluid, makeFrame(p, p.fluidCount, p.count, time));
    });
  }
}

}  // namespace treacle
