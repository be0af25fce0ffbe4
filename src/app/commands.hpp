#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/io/compare/compare.hpp"
#include "treacle/io/picture/picture.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "treacle/model/case/case.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace treacle {

enum class BackendChoice { Auto, Cpu, Cuda };

/// A case file with what the command line changes in it.
struct CaseOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  // "key=value"
};

struct RunOptions {
  CaseOptions input;
  std::filesystem::path directory;  // empty: "<case name>-run" in the current directory
  BackendChoice backend = BackendChoice::Auto;
  int threads = 0;                     // 0: as many as OpenMP takes by itself
  std::optional<Precision> precision;  // default: the case's
  std::optional<double> endTime;       // [s] default: the case's
  std::filesystem::path resume;        // checkpoint to continue from; empty: start from the case's bodies
  bool timings = false;                // seconds of the phases in history.csv
  bool force = false;
  bool quiet = false;
};

struct CheckOptions {
  CaseOptions input;
  std::optional<double> endTime;  // [s] default: the case's
  bool estimate = false;          // makes some steps
  int processes = 1;              // whose memory is told
  BackendChoice backend = BackendChoice::Auto;
  int threads = 0;  // 0: as many as OpenMP takes by itself
};

struct PlotOptions {
  std::filesystem::path directory;
  std::string frame = "last";  // or a number
  PictureField field = PictureField::Speed;
  std::string state{};           // the name of a State
  bool history = false;          // the curves of history.csv instead of a frame
  std::string probe;             // what it has read instead of a frame
  std::filesystem::path output;  // empty: into the run directory
};

struct SurfaceOptions {
  std::filesystem::path directory;
  std::optional<std::string> frame;  // its number, or "last"; missing: all
  SurfaceFormat format = SurfaceFormat::Vtp;
  double cell = 0.5;  // of the grid [spacings]
  int threads = 0;    // 0: as many as OpenMP takes by itself
};

struct CompareOptions {
  std::filesystem::path a, b;  // run directories or CSV files of particles; b is the reference
  std::vector<ComparedField> fields{ComparedField::Position, ComparedField::Velocity};
  double bound = 1e-5;         // on relative differences
  std::optional<double> time;  // [s] of the frame that is compared with a file; default: the last
  std::filesystem::path csv;   // empty: no table is written
  bool quiet = false;
};

struct ConvergenceOptions {
  CaseOptions input;
  std::optional<double> at;          // [s] default: the start, or the checkpoint's time
  std::vector<std::string> solvers;  // "key=value key=value" of [solver]; empty: some of the method
  std::filesystem::path directory;   // empty: "<case name>-convergence" in the current directory
  BackendChoice backend = BackendChoice::Auto;
  int threads = 0;                     // 0: as many as OpenMP takes by itself
  std::optional<Precision> precision;  // default: the case's
  std::filesystem::path resume;        // checkpoint to start from; empty: the case's bodies
};

struct ImportOptions {
  std::filesystem::path parameters, geometry;  // .data, and .grid or .boid
  std::filesystem::path output;                // case file; empty: "<name of the parameters>.toml"
  bool force = false;
};

/// Exit code of `compare` for runs that differ by more than the bound.
inline constexpr int runsDiffer = 1;

/// The commands of the program. They print to stdout, warnings to stderr.
/// Errors: InputError, RunError, std::bad_alloc.
/// `processes`: those that run it together, all of which call this.
void runCommand(const RunOptions& options, const Communicator& processes);
void checkCommand(const CheckOptions& options);
void infoCommand();
/// `field`: the word for that of the options.
void plotCommand(const PlotOptions& options, std::string_view field);
void surfaceCommand(const SurfaceOptions& options);
void convergenceCommand(const ConvergenceOptions& options);
/// Becomes the Python interpreter that runs a module of the package treacle with these arguments; does not return.
/// `command`: its name in messages. Errors: InputError where there is no interpreter.
void pythonCommand(const std::string& command, const std::string& module,
                   const std::vector<std::string>& arguments);
/// Runs it in a child process. Returns whether it succeeded.
bool tryPythonCommand(const std::string& command, const std::string& module,
                      const std::vector<std::string>& arguments);
/// Likewise: draws a table of a directory, with options of treacle.plot that say which.
void drawCurves(const std::filesystem::path& directory, const std::filesystem::path& picture,
                std::vector<std::string> options);
bool tryDrawCurves(const std::filesystem::path& directory, const std::filesystem::path& picture,
                   std::vector<std::string> options);
/// Whether the runs agree within the bound.
bool compareCommand(const CompareOptions& options);

}  // namespace treacle
