#pragma once

#include "backend.hpp"
#include "history_row.hpp"
#include "probe_recorder.hpp"
#include "resume.hpp"
#include "threads.hpp"
#include "treacle/io/tables/balance_writer.hpp"
#include "treacle/io/tables/history.hpp"
#include "treacle/io/tables/rigid_writer.hpp"
#include "treacle/model/case/steering.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// What a Simulation of Python's holds: a case, its simulation, and what its steps have told so far.
class Session {
 public:
  struct Options {
    BackendChoice backend = BackendChoice::Auto;
    std::optional<Precision> precision;  // default: the case's
    int threads = 0;                     // 0: as many as OpenMP takes by itself
    std::filesystem::path checkpoint;    // to go on from; empty: what the case starts with
  };

  /// What a thread has while it uses a session. It may have several of one session; other threads are refused, or
  /// wait. Meanwhile the thread has the session's number of threads of OpenMP.
  class Use {
   public:
    /// Errors: RunError while another thread uses the session, unless it waits.
    explicit Use(const Session& session, bool waits = false);

   private:
    std::unique_lock<std::recursive_mutex> lock_;
    UsedThreads threads_;
  };

  /// Errors: InputError, RunError, std::bad_alloc, as those of `treacle run`.
  Session(Case c, const Options& options);
  Session(const Session&) = delete;

  /// Errors: those of Simulation::advance; the last good state stays.
  const StepReport& advance();
  const StepReport& lastReport() const { return report_; }

  /// Errors: those of Simulation::giveFluid.
  void giveFluid(const GivenFluid& given);

  /// Goes on with another case, which may have other constants of materials, gravity, solver and so on, but the
  /// same particles. Errors: InputError for a case that differs in something else, and while it is recorded.
  void change(Case next);

  /// A wall or nozzle goes on as this says; a run directory that is being written has it, too. Errors: InputError
  /// for a name that is none, and those of steered(); RunError, std::bad_alloc.
  void steer(const std::string& body, const Steering& steering);
  /// How often the case has become another one that the run from its start is one of as well.
  int revision() const { return revision_; }

  /// Whether a run directory is written of the steps, which has the case and refers to this one.
  void setRecorded(bool is) { isRecorded_ = is; }
  bool isRecorded() const { return isRecorded_; }

  /// Whether the memory of the simulation is lost, with its device.
  bool isLost() const { return isLost_; }

  const Case& theCase() const { return case_; }
  const AnySimulation& simulation() const { return *simulation_; }
  bool onDevice() const { return backend_ == BackendKind::Cuda; }
  const std::string& device() const { return device_; }
  /// Whether the case is at its end.
  bool atEnd() const { return case_.atEnd(simulation_->step(), simulation_->time()); }
  /// Wall-clock time that the steps themselves have taken so far, without what is made of their reports [s].
  double stepSeconds() const { return stepSeconds_; }
  /// Counts what may have moved the fields of the fluid, or put its particles into another order.
  std::int64_t version() const { return version_; }

  const RowTable& history() const { return history_; }
  const RowTable& balance() const { return balance_; }
  const RowTable& rigidBodies() const { return rigid_; }
  const RowTable& probe(std::size_t number) const { return probes_[number]; }

  /// All particles, on the host.
  AnyParticles particles() const;
  /// Viscosities of the fluid in the order of its fields [Pa s].
  std::vector<double> viscosities() const;
  /// The state as files hold it.
  Frame fluidFrame() const;
  Frame wallsFrame() const;

  std::vector<std::string> takeWarnings();

 private:
  void makeAnew(const Case& next);

  Case case_;
  int threads_;
  mutable std::recursive_mutex user_;
  BackendKind backend_ = BackendKind::Cpu;
  std::string device_;
  std::vector<std::string> warnings_;
  std::optional<AnySimulation> simulation_;
  StepReport report_;
  std::int64_t version_ = 0;
  double stepSeconds_ = 0;
  int revision_ = 0;
  bool isRecorded_ = false, isLost_ = false;

  RowTable history_, balance_, rigid_;
  std::deque<RowTable> probes_;  // per probe of the case
  std::optional<HistoryWriter> historyWriter_;
  std::optional<BalanceWriter> balanceWriter_;
  std::optional<RigidWriter> rigidWriter_;
  std::optional<ProbeRecorder> probeRecorder_;
};

}  // namespace treacle
