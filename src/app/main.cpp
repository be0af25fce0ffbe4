#include "commands.hpp"
#include "interrupt.hpp"
#include "manual.hpp"
#include "memory.hpp"
#include "print.hpp"
#include "threads.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/case/case_reference.hpp"
#include "treacle/model/case/names.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <new>
#include <span>
#include <string>
#include <utility>

namespace {

using namespace treacle;

constexpr Named<BackendChoice> backendNames[] = {
    {"auto", BackendChoice::Auto}, {"cpu", BackendChoice::Cpu}, {"cuda", BackendChoice::Cuda}};
constexpr Named<PictureField> fieldNames[] = {{"speed", PictureField::Speed},
                                              {"pressure", PictureField::Pressure},
                                              {"number_density", PictureField::NumberDensity},
                                              {"nearest_distance", PictureField::NearestDistance},
                                              {"material", PictureField::Material},
                                              {"temperature", PictureField::Temperature},
                                              {"dynamic_viscosity", PictureField::DynamicViscosity},
                                              {"shear_rate", PictureField::ShearRate}};

constexpr Named<Shell> shellNames[] = {{"bash", Shell::Bash}, {"zsh", Shell::Zsh}, {"fish", Shell::Fish}};
constexpr Named<SurfaceFormat> formatNames[] = {{"vtp", SurfaceFormat::Vtp}, {"ply", SurfaceFormat::Ply}};

template <class E>
std::string listOf(std::span<const Named<E>> words) {
  std::string list;
  for (const Named<E>& w : words) list += fmt::format("{}{}", list.empty() ? "" : "|", w.name);
  return list;
}

template <class E>
E valueOf(const std::string& option, std::span<const Named<E>> words, const std::string& word) {
  for (const Named<E>& w : words)
    if (w.name == word) return w.value;
  throw CLI::ValidationError(option, fmt::format("expected {}, found '{}'", listOf(words), word));
}

/// An option that takes one of some words and stores the value that the word stands for.
template <class E, class Target>
void addChoice(CLI::App& command, const std::string& option, std::span<const Named<E>> words, Target& target,
               const std::string& help) {
  const auto store = [option, words, &target](const std::string& word) { target = valueOf(option, words, word); };
  command.add_option_function<std::string>(option, store, help)->type_name(listOf(words));
}

/// The same for an option that can be given several times; the first time replaces the default.
template <class E>
void addChoices(CLI::App& command, const std::string& option, std::span<const Named<E>> words,
                std::vector<E>& target, const std::string& help) {
  const auto store = [option, words, &target](const std::vector<std::string>& given) {
    target.clear();
    for (const std::string& word : given) target.push_back(valueOf(option, words, word));
  };
  command.add_option_function<std::vector<std::string>>(option, store, help)
      ->type_name(listOf(words))
      ->allow_extra_args(false);
}

bool isNumber(const std::string& text, double& x) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(x);
}

CLI::Validator positive() {
  const auto check = [](const std::string& text) {
    double x = 0;
    const bool good = isNumber(text, x) && x > 0;
    return good ? std::string{} : fmt::format("expected a positive number, found '{}'", text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator threadNumber() {
  const auto check = [](const std::string& text) {
    double x = 0;
    const bool good = isNumber(text, x) && x >= 1 && x <= mostThreads && x == std::floor(x);
    return good ? std::string{}
                : fmt::format("expected a whole number from 1 to {}, found '{}'", mostThreads, text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator cellEdge() {
  const auto check = [](const std::string& text) {
    double x = 0;
    const bool good = isNumber(text, x) && x >= 0.25 && x <= 1;
    return good ? std::string{} : fmt::format("expected a number from 0.25 to 1, found '{}'", text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator notNegative() {
  const auto check = [](const std::string& text) {
    double x = 0;
    const bool good = isNumber(text, x) && x >= 0;
    return good ? std::string{} : fmt::format("expected a number not less than 0, found '{}'", text);
  };
  return CLI::Validator(check, "");
}

void addCase(CLI::App& command, CaseOptions& options) {
  command.add_option("CASE", options.file, "Case file (TOML)")->required();
  command
      .add_option("--set", options.overrides, "Override a key, e.g. --set fluid.dynamic_viscosity=5; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// A variable of the shell that is not set must not be taken for an option that is not there.
CLI::Validator notEmpty() {
  return {[](const std::string& text) { return text.empty() ? "expected a name, found \"\"" : std::string(); },
          ""};
}

/// What a case is computed with, and from where on.
template <class Options>
void addMachine(CLI::App& command, Options& options) {
  addChoice<BackendChoice>(command, "--backend", backendNames, options.backend,
                           "auto: a GPU where there is one, else the CPU");
  command.add_option("--threads", options.threads, "Number of threads")->type_name("N")->check(threadNumber());
  addChoice<Precision>(command, "--precision", namesOf<Precision>, options.precision,
                       "mixed: preconditioner in single precision; default: solver.precision of the case");
  command.add_option("--resume", options.resume, "Checkpoint to continue from")
      ->type_name("FILE")
      ->check(notEmpty());
}

void addEndTime(CLI::App& command, std::optional<double>& end) {
  command.add_option("--end-time", end, "End of the run instead of time.end [s]")
      ->type_name("T")
      ->check(positive());
}

void addRun(CLI::App& app, RunOptions& options, const Communicator& job) {
  CLI::App* run = app.add_subcommand("run", "Run a case");
  addCase(*run, options.input);
  run->add_option("-o,--output", options.directory, "Run directory; default: the case's name with -run")
      ->type_name("DIR")
      ->check(notEmpty());
  addMachine(*run, options);
  addEndTime(*run, options.endTime);
  run->add_flag("--timings", options.timings, "Seconds of each phase of a step in history.csv");
  run->add_flag("--force", options.force, "Replace the run that the directory holds");
  run->add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
  run->callback([&options, &job] { runCommand(options, job); });
}

void addCheck(CLI::App& app, CheckOptions& options) {
  CLI::App* check =
      app.add_subcommand("check", "Check a case; prints it with all keys, counts, stability and advice");
  addCase(*check, options.input);
  addEndTime(*check, options.endTime);
  check->add_flag("--estimate", options.estimate, "Make some steps and tell how long all of them will take");
  check
      ->add_option("--processes", options.processes,
                   "Tell the memory of each of so many processes that share the case")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000));
  addChoice<BackendChoice>(*check, "--backend", backendNames, options.backend,
                           "Of --estimate; auto: a GPU where there is one, else the CPU");
  check->add_option("--threads", options.threads, "Number of threads")->type_name("N")->check(threadNumber());
  check->callback([&options] { checkCommand(options); });
}

/// Commands that print what the program knows of its cases and of itself.
void addTexts(CLI::App& app, Shell& shell) {
  app.add_subcommand("keys", "Print all keys of case files as Markdown")->callback([] {
    printText(keyReference());
  });
  app.add_subcommand("schema", "Print a JSON schema of case files, for editors")->callback([] {
    printText(caseSchema());
  });
  CLI::App* completion = app.add_subcommand("completion", "Print a script that completes commands in a shell");
  addChoice<Shell>(*completion, "SHELL", shellNames, shell, "The shell");
  completion->get_option("SHELL")->required();
  completion->callback([&app, &shell] { printText(completionScript(app, shell)); });
  app.add_subcommand("man", "Print the manual page")->callback([&app] { printText(manPage(app)); });
}

void addConvergence(CLI::App& app, ConvergenceOptions& options) {
  CLI::App* command = app.add_subcommand("convergence", "Compare solvers on one linear system of a case");
  addCase(*command, options.input);
  command->add_option("--at", options.at, "Time of the system [s]; default: the first step")
      ->type_name("T")
      ->check(notNegative());
  command
      ->add_option("--solver", options.solvers,
                   "A solver: what it has other than the case, as keys of [solver]; repeatable; default: some of "
                   "the method")
      ->type_name("\"KEY=VALUE ...\"")
      ->allow_extra_args(false);
  command->add_option("-o,--output", options.directory, "Directory; default: the case's name with -convergence")
      ->type_name("DIR");
  addMachine(*command, options);
  command->callback([&options] { convergenceCommand(options); });
}

void addPlot(CLI::App& app, PlotOptions& options) {
  CLI::App* plot = app.add_subcommand("plot", "Draw a frame, the history or a probe of a run as PNG");
  plot->add_option("DIR", options.directory, "Run directory")->required();
  plot->add_option("--frame", options.frame, "Number of the frame, or last")->type_name("N");
  const auto storeField = [&options](const std::string& word) {
    const auto* known = std::ranges::find(fieldNames, word, &Named<PictureField>::name);
    options.field = known == std::end(fieldNames) ? PictureField::State : known->value;
    options.state = word;
  };
  plot->add_option_function<std::string>("--field", storeField,
                                         "What the colours show, or the name of a state; default: speed")
      ->type_name(listOf<PictureField>(fieldNames));
  plot->add_flag("--history", options.history, "Curves of iterations, energies and extents over time");
  plot->add_option("--probe", options.probe, "What a probe of the case has read")->type_name("NAME");
  plot->add_option("-o,--output", options.output, "PNG file; default: in the run directory")->type_name("FILE");
  plot->callback([&options] { plotCommand(options, options.state.empty() ? "speed" : options.state); });
}

void addSurface(CLI::App& app, SurfaceOptions& options) {
  CLI::App* surface =
      app.add_subcommand("surface", "Make triangles of the free surface of the fluid in the frames of a run");
  surface->add_option("DIR", options.directory, "Run directory")->required();
  surface->add_option("--frame", options.frame, "Number of the frame, or last; default: all")->type_name("N");
  addChoice<SurfaceFormat>(*surface, "--format", formatNames, options.format,
                           "vtp: for ParaView, with an index; ply: for renderers; default: vtp");
  surface
      ->add_option("--cell", options.cell,
                   "Edge of the cells that triangles are found in, in particle spacings, 0.25 to 1; default: 0.5")
      ->type_name("X")
      ->check(cellEdge());
  surface->add_option("--threads", options.threads, "Number of threads")->type_name("N")->check(threadNumber());
  surface->callback([&options] { surfaceCommand(options); });
}

/// `agree`: what the command found.
void addCompare(CLI::App& app, CompareOptions& options, bool& agree) {
  CLI::App* compare = app.add_subcommand("compare", "Compare two runs, or a run and particles in a CSV file");
  compare->add_option("A", options.a, "Run directory or CSV file")->required();
  compare->add_option("B", options.b, "Run directory or CSV file of the reference")->required();
  compare
      ->add_option("--bound", options.bound, "Largest relative difference that counts as agreement; default: 1e-5")
      ->type_name("X")
      ->check(notNegative());
  addChoices<ComparedField>(*compare, "--field", namesOf<ComparedField>, options.fields,
                            "Field that the bound applies to; repeatable; default: position and velocity");
  compare
      ->add_option("--time", options.time,
                   "With a CSV file: the frame of the run nearest to this time [s]; default: the last")
      ->type_name("T")
      ->check(notNegative());
  compare->add_option("--csv", options.csv, "Write the table as CSV")->type_name("FILE");
  compare->add_flag("-q,--quiet", options.quiet, "Print the verdict only");
  compare->callback([&options, &agree] { agree = compareCommand(options); });
}

void addImport(CLI::App& app, ImportOptions& options) {
  CLI::App* command =
      app.add_subcommand("import", "Write a case from the files of the program of the method's authors");
  command->add_option("DATA", options.parameters, "Parameters (.data)")->required();
  command->add_option("PARTICLES", options.geometry, "Particles (.grid) or cuboids (.boid)")->required();
  command
      ->add_option("-o,--output", options.output,
                   "Case file; default: the name of DATA with .toml, in the current "
                   "directory")
      ->type_name("FILE");
  command->add_flag("--force", options.force, "Replace files that are there");
  command->callback([&options] {
    std::vector<std::string> words;
    if (!options.output.empty()) words.push_back("--output=" + options.output.string());
    if (options.force) words.emplace_back("--force");
    words.insert(words.end(), {"--", options.parameters.string(), options.geometry.string()});
    pythonCommand("import", "import_case", words);
  });
}

/// Commands that a module of the Python package carries out, with their help. All words after the name are the
/// module's, --help and names of other commands too, so that they do not come to the parser.
constexpr std::pair<const char*, const char*> pythonCommands[] = {
    {"movie", "Make a film of a run (Python; pip install '.[pictures]')"},
    {"report", "Write a run's summary, curves and frames as one HTML page (likewise)"}};

/// Does not return where the first word is one of these commands.
void becomePython(int argc, char** argv) {
  for (const auto& [name, help] : pythonCommands)
    if (argc > 1 && std::string(argv[1]) == name) pythonCommand(name, name, {argv + 2, argv + argc});
}

/// "run, check, plot"
std::string commandList(const CLI::App& app) {
  std::string list;
  for (const CommandText& command : commandTexts(app))
    if (!command.name.empty()) list += (list.empty() ? "" : ", ") + command.name;
  return list;
}

int report(const std::string& text, ExitCode code) {
  printError(fmt::format("treacle: error: {}\n", text));
  return static_cast<int>(code);
}

/// At a process that is not the first: it has taken part in a run. What it has met the first one has met as well,
/// and reports it; else the others would wait for it.
int follow(int argc, char** argv, const Communicator& job) {
  RunOptions run;
  CLI::App app;
  addRun(app, run, job);
  app.allow_extras();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return e.get_exit_code() == 0 ? 0 : static_cast<int>(ExitCode::BadInput);
  } catch (const InputError&) {
    return static_cast<int>(ExitCode::BadInput);
  } catch (const RunError&) {
    return static_cast<int>(ExitCode::RunFailed);
  } catch (const std::exception& e) {
    job.abort(e.what(), static_cast<int>(ExitCode::RunFailed));
  }
  return 0;
}

int execute(int argc, char** argv, const Communicator& job) {
  CLI::App app("Particle solver for highly viscous, incompressible free-surface flow", "treacle");
  app.set_version_flag("--version", fmt::format("treacle {} ({})", buildInfo().version, buildInfo().commit));
  app.footer("Exit codes: 0 done, 1 compared runs differ, 2 bad input, 3 the run failed.");
  RunOptions run;
  CheckOptions check;
  PlotOptions plot;
  SurfaceOptions surface;
  CompareOptions compare;
  ConvergenceOptions convergence;
  ImportOptions importOptions;
  bool agree = true;
  addRun(app, run, job);
  addCheck(app, check);
  addPlot(app, plot);
  addSurface(app, surface);
  addCompare(app, compare, agree);
  addConvergence(app, convergence);
  addImport(app, importOptions);
  for (const auto& [name, help] : pythonCommands) app.add_subcommand(name, help);
  Shell shell = Shell::Bash;
  addTexts(app, shell);
  app.add_subcommand("info", "Version, build options and devices")->callback([] { infoCommand(); });

  try {
    becomePython(argc, argv);
    app.parse(argc, argv);
    if (app.get_subcommands().empty())
      throw InputError(fmt::format("expected a command: {}; treacle --help tells more", commandList(app)));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // help and version
    std::string text = e.what();                     // "--threads: At Most 1 required but received 2"
    if (const std::size_t at = text.find(": At Most 1 required"); at != text.npos)
      text = text.substr(0, at) + " is given more than once";
    if (dynamic_cast<const CLI::ExtrasError*>(&e))  // whose words are in reverse order
      text = fmt::format("not expected: {}", fmt::join(app.remaining(true), " "));
    return report(fmt::format("{}; --help tells more", text), ExitCode::BadInput);
  } catch (const InputError& e) {
    return report(e.what(), ExitCode::BadInput);
  } catch (const DeviceMemoryExhausted& e) {
    return report(exhaustedText(e.numbers()), ExitCode::RunFailed);
  } catch (const std::bad_alloc&) {
    return report("memory exhausted", ExitCode::RunFailed);
  } catch (const std::exception& e) {
    return report(e.what(), ExitCode::RunFailed);
  }
  return agree ? static_cast<int>(ExitCode::Done) : runsDiffer;
}

}  // namespace

int main(int argc, char** argv) {
  openClosedStreams();
  ignoreFileSizeSignal();
  const Communicator job = Communicator::ofJob();
  if (job.rank() > 0) return follow(argc, argv, job);
  const int code = execute(argc, argv, job);
  flushPrinted();
  const std::string failure = printFailure();
  if (failure.empty() || code > runsDiffer) return code;
  return report(fmt::format("cannot write to stdout: {}", failure), ExitCode::RunFailed);
}
