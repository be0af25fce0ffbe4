#include "treacle/step/run/any_simulation.hpp"

#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/peak_memory.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/step/run/shareable.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <optional>
#include <utility>
#include <variant>

namespace treacle {

struct AnySimulation::Held {
#ifdef TREACLE_HAS_CUDA
  std::variant<Simulation<2, Cpu>, Simulation<3, Cpu>, Simulation<2, Cuda>, Simulation<3, Cuda>> simulation;
#else
  std::variant<Simulation<2, Cpu>, Simulation<3, Cpu>> simulation;
#endif

  template <class F>
  decltype(auto) visit(F&& f) {
    return std::visit(f, simulation);
  }

  /// The one place where a case becomes a simulation of some dimensions on some backend.
  static Held of(const Case& c, AnyParticles& particles, [[maybe_unused]] BackendKind backend, std::int64_t step,
                 double time, const Communicator* processes) {
    return particles.visit([&]<int D>(Particles<D>& p) -> Held {
#ifdef TREACLE_HAS_CUDA
      if (backend == BackendKind::Cuda) return {Simulation<D, Cuda>(c, std::move(p), step, time, processes)};
#endif
      return {Simulation<D, Cpu>(c, std::move(p), step, time, processes)};
    });
  }
};

namespace {

/// What the first process asks of the others.
enum class Order : int { Make, Advance, Copy, Measure, Share, Duty, Drop, End };

struct DutyCall {
  int order;
  std::int64_t number;
};

void give(const Communicator* processes, Order order) {
  if (processes && processes->rank() == 0) processes->broadcast(order);
}

/// Does a part of what several processes do. A RunError or InputError is one that all of them have met; anything
/// else this one alone, and the others would wait for it.
template <class F>
decltype(auto) part(const Communicator* processes, F&& f) {
  try {
    return f();
  } catch (const RunError&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    if (!processes) throw;
    processes->abort("memory exhausted", static_cast<int>(ExitCode::RunFailed));
  } catch (const std::exception& e) {
    if (!processes) throw;
    processes->abort(e.what(), static_cast<int>(ExitCode::RunFailed));
  }
}

}  // namespace

AnySimulation::AnySimulation(const Case& c, AnyParticles particles, BackendKind backend, std::int64_t step,
                             double time, const Communicator* processes)
    : processes_(processes && processes->size() > 1 ? processes : nullptr) {
  requireValid(c);
  if (particles.dimensions() != c.dimensions)
    throw InputError(
        fmt::format("the case has {} dimensions, its particles {}", c.dimensions, particles.dimensions()));
  if (backend == BackendKind::Cuda && !cudaCompiled)
    throw InputError("this program was built without CUDA; expected the CPU as backend");
  if (processes_) requireShareable(c, backend);
  give(processes_, Order::Make);
  held_ = part(processes_,
               [&] { return std::make_unique<Held>(Held::of(c, particles, backend, step, time, processes_)); });
}

AnySimulation::~AnySimulation() {
  if (held_) give(processes_, Order::Drop);
}
AnySimulation::AnySimulation(AnySimulation&&) noexcept = default;

StepReport AnySimulation::advance() {
  give(processes_, Order::Advance);
  return part(processes_, [&] { return held_->visit([](auto& s) { return s.advance(); }); });
}

std::vector<SolverTrial> AnySimulation::convergence(std::span<const SolverSettings> solvers) {
  return held_->visit([&](auto& s) { return s.convergence(solvers); });
}

void AnySimulation::copyParticles(AnyParticles& host) const {
  give(processes_, Order::Copy);
  part(processes_, [&] {
    held_->visit([&]<int D, class Backend>(Simulation<D, Backend>& s) {
      if (host.dimensions() != D) host = AnyParticles(D);
      s.copyParticles(host.of<D>());
    });
  });
}

std::vector<ProbeReading> AnySimulation::measure(std::uint64_t probes) const {
  give(processes_, Order::Measure);
  if (processes_) processes_->broadcast(probes);
  return part(processes_, [&] { return held_->visit([&](auto& s) { return s.measure(probes); }); });
}

FieldMemory AnySimulation::field(FluidField field) const {
  return held_->visit([&](auto& s) { return s.field(field); });
}
void AnySimulation::copyField(FluidField field, void* host) const {
  held_->visit([&](auto& s) { s.copyField(field, host); });
}
void AnySimulation::giveFluid(const GivenFluid& given) {
  held_->visit([&](auto& s) { s.giveFluid(given); });
}
void AnySimulation::giveMotion(std::size_t body, const Body& as) {
  held_->visit([&](auto& s) { s.giveMotion(body, as); });
}

ParticleNumbers AnySimulation::numbers() const {
  return held_->visit([](auto& s) { return s.numbers(); });
}

double AnySimulation::time() const {
  return held_->visit([](auto& s) { return s.time(); });
}
std::int64_t AnySimulation::step() const {
  return held_->visit([](auto& s) { return s.step(); });
}
std::size_t AnySimulation::bytes() const {
  return held_->visit([](auto& s) { return s.bytes(); });
}
std::size_t AnySimulation::peakBytes() const {
  return held_->visit([](auto& s) { return s.peakBytes(); });
}

std::string AnySimulation::linkName() const {
  return held_->visit([](auto& s) { return s.linkName(); });
}

std::vector<AnySimulation::Share> AnySimulation::shares() const {
  give(processes_, Order::Share);
  Share own{};
  own.fluidParticles = held_->visit([](auto& s) { return s.particles().fluidCount; });
  if (!processes_) return {own};
  const DeviceLink::Spent link = held_->visit([](auto& s) { return s.linkSpent(); });
  own.traffic = processes_->traffic();
  own.traffic.bytes += link.bytes, own.traffic.calls += link.calls, own.traffic.seconds += link.seconds;
  own.waiting = link.waiting;
  own.peakBytes = peakBytes();
  own.peakHostBytes = peakMemory();
  return processes_->all(own);
}

void AnySimulation::everywhere(int order, std::int64_t number, const Duty& duty) {
  give(processes_, Order::Duty);
  DutyCall call{order, number};
  if (processes_ && processes_->rank() == 0) processes_->broadcast(call);
  part(processes_, [&] { duty(*this, order, number); });
}

std::uint32_t AnySimulation::copyOwnParticles(AnyParticles& host) const {
  return held_->visit([&]<int D, class Backend>(Simulation<D, Backend>& s) {
    if (host.dimensions() != D) host = AnyParticles(D);
    return s.copyOwnParticles(host.of<D>());
  });
}

Followers::~Followers() {
  if (processes_.size() > 1) give(&processes_, Order::End);
}

void serveSimulation(const Case& c, AnyParticles particles, BackendKind backend, std::int64_t step, double time,
                     const Communicator& processes, const AnySimulation::Duty& duty) {
  std::optional<AnySimulation> simulation;
  AnyParticles none(particles.dimensions());
  for (Order order = Order::End;;) {
    processes.broadcast(order);
    try {
      switch (order) {
        case Order::Make:
          simulation.emplace(c, std::move(particles), backend, step, time, &processes);
          break;
        case Order::Advance:
          simulation->advance();
          break;
        case Order::Copy:
          simulation->copyParticles(none);
          break;
        case Order::Measure:
          simulation->measure(0);  // the first process says which
          break;
        case Order::Share:
          simulation->shares();
          break;
        case Order::Duty: {
          DutyCall call{};
          processes.broadcast(call);
          simulation->everywhere(call.order, call.number, duty);
          break;
        }
        case Order::Drop:
          simulation.reset();
          break;
        case Order::End:
          return;
      }
    } catch (const RunError&) {  // the first process has met it, too, and says so
    } catch (const InputError&) {
    }
  }
}

}  // namespace treacle
