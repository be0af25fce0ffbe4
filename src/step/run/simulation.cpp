#include "treacle/step/run/simulation.hpp"

#include "all_particles.hpp"
#include "own_particles.hpp"
#include "readings/measure.hpp"
#include "simulation_state.hpp"
#include "treacle/core/team.hpp"

#include <type_traits>
#include <utility>

namespace treacle {
namespace {

/// Loops of the host have a team. A particle in 3D has as much to do as four in 2D.
template <int D, class Backend, class F>
void withTeam(std::size_t fluid, F&& body) {
  if constexpr (std::is_same_v<Backend, Cpu>)
    Team::lead(body, D == 3 ? 4 * fluid : fluid);
  else
    body();
}

}  // namespace

template <int D, class Backend>
Simulation<D, Backend>::Simulation(const Case& c, Particles<D> particles, std::int64_t step, double time,
                                   const Communicator* processes)
    : state_(std::make_unique<State>(c, std::move(particles), step, time, processes)) {}
template <int D, class Backend>
Simulation<D, Backend>::~Simulation() {
  if (!state_ || !state_->link) return;
  try {
    state_->link->close();
  } catch (const std::exception&) {  // a device that is lost, which whoever used it last has been told
  }
}
template <int D, class Backend>
Simulation<D, Backend>::Simulation(Simulation&&) noexcept = default;

template <int D, class Backend>
StepReport Simulation<D, Backend>::advance() {
  StepReport report;
  withTeam<D, Backend>(state_->particles.fluidCount, [&] { report = state_->advance(); });
  return report;
}
template <int D, class Backend>
FieldMemory Simulation<D, Backend>::field(FluidField field) const {
  if constexpr (std::is_same_v<Backend, Cuda>) state_->context.synchronize();
  return fieldMemory(state_->particles, field);
}
template <int D, class Backend>
void Simulation<D, Backend>::copyField(FluidField field, void* host) const {
  treacle::copyField(state_->context, fieldMemory(state_->particles, field), host);
}
template <int D, class Backend>
void Simulation<D, Backend>::giveFluid(const GivenFluid& given) {
  withTeam<D, Backend>(state_->particles.fluidCount, [&] { state_->giveFluid(given); });
}
template <int D, class Backend>
void Simulation<D, Backend>::giveMotion(std::size_t body, const Body& as) {
  state_->giveMotion(body, as);
}
template <int D, class Backend>
std::vector<SolverTrial> Simulation<D, Backend>::convergence(std::span<const SolverSettings> solvers) {
  std::vector<SolverTrial> trials;
  withTeam<D, Backend>(state_->particles.fluidCount, [&] { trials = state_->convergence(solvers); });
  return trials;
}
template <int D, class Backend>
const Particles<D, Backend>& Simulation<D, Backend>::particles() const {
  return state_->particles;
}
template <int D, class Backend>
void Simulation<D, Backend>::copyParticles(Particles<D>& host) const {
  copyAllParticles(*state_, *state_->distant, host);
}
template <int D, class Backend>
std::uint32_t Simulation<D, Backend>::copyOwnParticles(Particles<D>& host) const {
  const StepMethod<D, Backend>& method = *state_->method;
  return treacle::copyOwnParticles<D, Backend>(*state_, method.grid(), method.owners(), *state_->distant, host);
}
template <int D, class Backend>
ParticleNumbers Simulation<D, Backend>::numbers() const {
  return numbersOfAll(*state_, *state_->distant);
}
template <int D, class Backend>
std::vector<ProbeReading> Simulation<D, Backend>::measure(std::uint64_t probes) const {
  return treacle::measure(*state_, probes);
}
template <int D, class Backend>
double Simulation<D, Backend>::time() const {
  return state_->time;
}
template <int D, class Backend>
std::int64_t Simulation<D, Backend>::step() const {
  return state_->step;
}
template <int D, class Backend>
std::size_t Simulation<D, Backend>::bytes() const {
  return state_->bytes();
}
template <int D, class Backend>
std::size_t Simulation<D, Backend>::peakBytes() const {
  if constexpr (std::is_same_v<Backend, Cuda>) return state_->context.peakBytes();
  return 0;
}
template <int D, class Backend>
DeviceLink::Spent Simulation<D, Backend>::linkSpent() const {
  return state_->link ? state_->link->spent() : DeviceLink::Spent{};
}
template <int D, class Backend>
std::string Simulation<D, Backend>::linkName() const {
  return state_->link ? state_->link->name() : "";
}
template <int D, class Backend>
Diagnostics Simulation<D, Backend>::diagnostics() const {
  return state_->diagnostics();
}

#define TREACLE_INSTANTIATE(Backend)     \
  template class Simulation<2, Backend>; \
  template class Simulation<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
