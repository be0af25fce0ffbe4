#include "session.hpp"

#include "machine.hpp"
#include "memory.hpp"
#include "threads.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/frames/arrangement.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/names.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>

namespace treacle {
namespace {

/// Whether going on with another case leaves the particles what they are.
bool hasSameParticles(const Case& c, Case next) {
  const bool sameMaterials = std::ranges::equal(c.materials, next.materials, {}, &Material::name, &Material::name);
  if (!sameMaterials || c.heat.has_value() != next.heat.has_value()) return false;
  if (c.hasSurfaceTension() != next.hasSurfaceTension()) return false;
  next.materials = c.materials, next.gravity = c.gravity, next.gravityInTime = c.gravityInTime,
  next.rheology = c.rheology, next.heat = c.heat;
  next.solver = c.solver, next.watch = c.watch, next.title = c.title, next.resolution = c.resolution;
  next.time.end = c.time.end, next.time.tolerance = c.time.tolerance, next.time.least = c.time.least;
  if (c.time.stepsVary() && next.time.stepsVary())
    next.time.step = c.time.step, next.time.courant = c.time.courant;
  return next == c;
}

std::size_t bodyNamed(const Case& c, const std::string& name) {
  std::vector<std::string_view> known;
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    if (c.bodies[b].name == name) return b;
    known.push_back(c.bodies[b].name);
  }
  throw InputError("body: " + wrongWord(known, name));
}

std::unique_lock<std::recursive_mutex> taken(std::recursive_mutex& user, bool waits) {
  std::unique_lock lock(user, std::defer_lock);
  if (waits)
    lock.lock();
  else if (!lock.try_lock())
    throw RunError("another thread uses the simulation now; expected one thread at a time");
  return lock;
}

}  // namespace

Session::Use::Use(const Session& session, bool waits)
    : lock_(taken(session.user_, waits)), threads_(session.threads_) {}

Session::Session(Case c, const Options& options) : case_(std::move(c)), threads_(options.threads) {
  const Use use(*this);
  startThreads(threads_);
  const std::optional<DeviceInfo> device = deviceFor(options.backend);
  if (device) backend_ = BackendKind::Cuda;
  device_ = device ? deviceText(*device) : processorName();
  if (options.precision) case_.solver.precision = *options.precision;
  requireRoomForParticles(case_);
  MadeParticles made = MadeParticles::of(case_, warnings_);
  if (options.checkpoint.empty()) made.requireParticles(case_);
  for (std::string& warning : caseWarnings(case_)) warnings_.push_back(std::move(warning));
  if (!device)
    for (std::string& warning : cpuWarnings(case_)) warnings_.push_back(std::move(warning));
  StartState start = options.checkpoint.empty() ? StartState{std::move(made.particles)}
                                                : fittingState(case_, options.checkpoint, made);
  requireMemory(case_, start.particles, device ? &*device : nullptr);
  simulation_.emplace(case_, std::move(start.particles), backend_, start.step, start.time);

  historyWriter_.emplace(&history_,
                         HistoryColumns{.flow = case_.isOpen(), .gas = case_.gas.has_value(), .timings = true});
  if (case_.output.balance) balanceWriter_.emplace(&balance_, case_);
  if (case_.hasRigid()) rigidWriter_.emplace(&rigid_, case_);
  probeRecorder_.emplace(
      case_, [this](const Probe&) { return &probes_.emplace_back(); }, start.time,
      [this](std::uint64_t probes) { return simulation_->measure(probes); });
  probeRecorder_->begin();
}

const StepReport& Session::advance() {
  ++version_;
  Timer timer;
  try {
    report_ = simulation_->advance();
  } catch (const DeviceFailure&) {
    isLost_ = true;
    throw;
  }
  stepSeconds_ += timer.lap();
  historyWriter_->append(historyRow(case_, report_));
  if (balanceWriter_ && report_.balance) balanceWriter_->append(report_.step, report_.time, *report_.balance);
  if (rigidWriter_) rigidWriter_->append(report_.step, report_.time, report_.rigid);
  probeRecorder_->record(report_);
  return report_;
}

void Session::giveFluid(const GivenFluid& given) {
  simulation_->giveFluid(given);
  if (given.viscosityFactor.empty() || case_.hasViscosityFactors()) return;
  case_.haveViscosityFactors();
  ++revision_, ++version_;
}

void Session::change(Case next) {
  requireValid(next);
  if (isRecorded_)
    throw InputError("a run directory is being written, whose case is this one; expected a change between runs");
  if (!hasSameParticles(case_, next))
    throw InputError(
        "between steps only constants of materials, gravity, [rheology], [heat], [solver], [watch] and the end of "
        "the time can change, and the length of steps that vary; expected a case that differs in these alone");
  makeAnew(next);
  next.probes = std::move(case_.probes);  // they are the same, and who writes them refers to these
  case_ = std::move(next);
}

/// The simulation around its particles.
void Session::makeAnew(const Case& next) {
  AnySimulation changed(next, particles(), backend_, simulation_->step(), simulation_->time());
  ++version_;
  simulation_.emplace(std::move(changed));
}

void Session::steer(const std::string& body, const Steering& steering) {
  const std::size_t b = bodyNamed(case_, body);
  Body next = steered(case_.bodies[b], steering, simulation_->time());
  if (isSteeredAlready(case_.bodies[b], next)) {
    simulation_->giveMotion(b, next);
  } else {
    Case changed = case_;
    changed.bodies[b] = next;
    requireValid(changed);
    makeAnew(changed);
  }
  case_.bodies[b] = std::move(next);
  ++revision_;
}

AnyParticles Session::particles() const {
  AnyParticles host(case_.dimensions);
  simulation_->copyParticles(host);
  return host;
}

std::vector<double> Session::viscosities() const {
  Frame fluid;
  const auto copied = [&](FluidField field, auto value) {
    std::vector<decltype(value)> values(simulation_->field(field).count);
    simulation_->copyField(field, values.data());
    return values;
  };
  const std::vector<std::uint8_t> materials = copied(FluidField::Material, std::uint8_t{});
  fluid.material.assign(materials.begin(), materials.end());
  fluid.shearRate = copied(FluidField::ShearRate, double{});
  fluid.temperature = copied(FluidField::Temperature, double{});
  fluid.viscosityFactor = copied(FluidField::ViscosityFactor, double{});
  for (std::size_t k = 0; k < case_.stateNames().size(); ++k)
    fluid.states.push_back({"", copied(fieldOfState(k), double{})});
  fluid.time = simulation_->time();
  fluid.shearRate.resize(materials.size());  // where no material has a rheology they do not matter
  addViscosities(case_, fluid);
  return std::move(fluid.dynamicViscosity);
}

Frame Session::fluidFrame() const {
  Frame fluid, walls;
  particles().visit([&](const auto& p) {
    fluid = makeFrame(p, 0, p.fluidCount, simulation_->time());
    walls = makeFrame(p, p.fluidCount, p.count, simulation_->time());
  });
  addViscosities(case_, fluid);
  measureArrangement(fluid, solidWalls(case_, walls), case_.domain, case_.spacing);
  return fluid;
}

Frame Session::wallsFrame() const {
  return particles().visit(
      [&](const auto& p) { return makeFrame(p, p.fluidCount, p.count, simulation_->time()); });
}

std::vector<std::string> Session::takeWarnings() { return std::exchange(warnings_, {}); }

}  // namespace treacle
