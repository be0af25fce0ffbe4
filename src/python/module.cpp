#include "arrays.hpp"
#include "case_tables.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "recording.hpp"
#include "session_caster.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/frames/pvtp.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/model/case/names.hpp"

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

namespace treacle {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using Quiet = nb::call_guard<nb::gil_scoped_release>;
using Arrays = nb::typed<nb::dict, nb::str, nb::any>;  // by name

template <class E>
E wordOf(const std::string& word, const char* what, std::initializer_list<std::pair<const char*, E>> words) {
  std::vector<std::string_view> known;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    known.push_back(name);
  }
  throw InputError(fmt::format("{}: {}", what, wrongWord(known, word)));
}

std::unique_ptr<Session> makeSession(const Case& c, const std::string& backend, const std::string& precision,
                                     std::optional<int> threads, const std::string& checkpoint) {
  Session::Options options;
  options.backend = wordOf<BackendChoice>(
      backend, "backend",
      {{"auto", BackendChoice::Auto}, {"cpu", BackendChoice::Cpu}, {"cuda", BackendChoice::Cuda}});
  if (!precision.empty())
    options.precision =
        wordOf<Precision>(precision, "precision", {{"mixed", Precision::Mixed}, {"double", Precision::Double}});
  if (threads && *threads < 1)
    throw InputError(fmt::format("threads: expected a whole number of at least 1, found {}", *threads));
  options.threads = threads.value_or(0);
  options.checkpoint = checkpoint;
  return std::make_unique<Session>(c, options);
}

Arrays tableOf(const RowTable& table) {
  Arrays arrays;
  for (std::size_t k = 0; k < table.names.size(); ++k) arrays[table.names[k].c_str()] = arrayOf(table.columns[k]);
  return arrays;
}

Arrays probeOf(const Session& session, const std::string& name) {
  std::vector<std::string_view> known;
  for (std::size_t k = 0; k < session.theCase().probes.size(); ++k) {
    if (session.theCase().probes[k].name == name) return tableOf(session.probe(k));
    known.push_back(session.theCase().probes[k].name);
  }
  throw InputError(known.empty() ? fmt::format("probe '{}': the case has no probes", name)
                                 : fmt::format("probe: {}", wrongWord(known, name)));
}

void steer(Session& session, const std::string& body, const std::optional<std::vector<double>>& velocity,
           std::optional<double> spin, std::optional<double> speed, std::optional<double> flowRate) {
  Steering steering{.spin = spin, .speed = speed, .flowRate = flowRate};
  const auto dimensions = static_cast<std::size_t>(session.theCase().dimensions);
  if (velocity && velocity->size() != dimensions)
    throw InputError(fmt::format("velocity: expected {} numbers, found {}", dimensions, velocity->size()));
  if (velocity) {
    steering.velocity.emplace();
    for (std::size_t k = 0; k < dimensions; ++k) (*steering.velocity)[static_cast<int>(k)] = (*velocity)[k];
  }
  session.steer(body, steering);
}

std::uint64_t writeFrame(const Session& session, const std::filesystem::path& path, bool walls) {
  const OutputSettings& output = session.theCase().output;
  return writeVtp(path, walls ? session.wallsFrame() : session.fluidFrame(), output.fields, output.precision,
                  output.compression);
}

void writeCheckpointOf(const Session& session, const std::filesystem::path& path) {
  session.particles().visit([&](const auto& p) {
    writeCheckpoint(path, p, session.simulation().step(), session.simulation().time(),
                    session.theCase().method.kind, StateNames::of(session.theCase()));
  });
}

using TableOfKeys =
    nb::typed<nb::tuple, nb::str, nb::typed<nb::list, nb::typed<nb::tuple, nb::str, nb::str, nb::str>>>;

nb::typed<nb::list, TableOfKeys> tables() {
  nb::list all;
  for (const CaseTable& table : caseTables()) {
    nb::list keys;
    for (const TableKey& key : table.keys) keys.append(nb::make_tuple(key.name, key.type, key.unit));
    all.append(nb::make_tuple(table.name, keys));
  }
  return all;
}

nb::typed<nb::list, nb::typed<nb::tuple, nb::str, int, int, int, bool>> devices() {
  nb::list all;
  for (const DeviceInfo& device : cudaDevices())
    all.append(
        nb::make_tuple(device.name, device.computeMajor, device.computeMinor, device.memory, device.hasCode));
  return all;
}

void bindReport(nb::module_& m) {
  nb::class_<StepReport>(m, "StepReport", "What a time step has told.")
      .def_ro("step", &StepReport::step, "Number of steps done.")
      .def_ro("time", &StepReport::time, "Time after the step [s].")
      .def_ro("time_step", &StepReport::timeStep, "Length of the step [s].")
      .def_ro("error", &StepReport::error, "By which automatic steps are chosen [-].")
      .def_ro("rejected", &StepReport::rejected, "Longer steps that were tried before.")
      .def_ro("iterations", &StepReport::iterations, "Of all linear solves of the step.")
      .def_ro("residual", &StepReport::residual, "|r|^2 / |b|^2 at the end of the last solve.")
      .def_ro("fallbacks", &StepReport::fallbacks, "Ways of the linear solver that failed.")
      .def_ro("failures", &StepReport::failures, "Which ways those are, and why they failed.")
      .def_ro("warnings", &StepReport::warnings, "What the watch has noticed in the step.")
      .def_prop_ro(
          "kinetic_energy", [](const StepReport& r) { return r.diagnostics.kineticEnergy; },
          "[J; per metre of depth in 2D]")
      .def_prop_ro(
          "potential_energy", [](const StepReport& r) { return r.diagnostics.potentialEnergy; },
          "[J; per metre of depth in 2D]")
      .def_prop_ro(
          "front_x", [](const StepReport& r) { return r.diagnostics.frontX; }, "Largest x of the fluid [m].")
      .def_prop_ro(
          "top", [](const StepReport& r) { return r.diagnostics.top; },
          "Largest coordinate of the fluid against gravity [m].")
      .def_prop_ro(
          "max_speed", [](const StepReport& r) { return r.diagnostics.maxSpeed; }, "[m/s]")
      .def_prop_ro(
          "seconds", [](const StepReport& r) { return r.seconds.total(); }, "Wall-clock time of the step [s].")
      .def("__repr__", [](const StepReport& r) {
        return fmt::format("StepReport(step={}, time={:g}, time_step={:g}, iterations={})", r.step, r.time,
                           r.timeStep, r.iterations);
      });
}

void bindSession(nb::module_& m) {
  nb::class_<Session>(m, "Session", "A case, its simulation and what its steps have told.")
      .def_static("make", &makeSession, "case"_a, "backend"_a, "precision"_a, "threads"_a.none(), "checkpoint"_a,
                  Quiet())
      .def("advance", &Session::advance, Quiet(), nb::rv_policy::copy)
      .def("change", &Session::change, "case"_a, Quiet())
      .def("steer", &steer, "body"_a, "velocity"_a.none(), "spin"_a.none(), "speed"_a.none(), "flow_rate"_a.none(),
           Quiet())
      .def("take_warnings",
           [](Session& s) {
             std::vector<std::string> texts = s.takeWarnings();
             for (std::string& text : texts) text = forPython(std::move(text));
             return texts;
           })
      .def_prop_ro("step", [](const Session& s) { return s.simulation().step(); })
      .def_prop_ro("time", [](const Session& s) { return s.simulation().time(); })
      .def_prop_ro("at_end", &Session::atEnd)
      .def_prop_ro("version", &Session::version)
      .def_prop_ro("step_seconds", &Session::stepSeconds)
      .def_prop_ro("on_device", &Session::onDevice)
      .def_prop_ro("device", &Session::device)
      .def_prop_ro("case_text", [](const Session& s) { return caseText(s.theCase()); })
      .def_prop_ro("dimensions", [](const Session& s) { return s.theCase().dimensions; })
      .def_prop_ro("title", [](const Session& s) { return s.theCase().title; })
      .def_prop_ro("spacing", [](const Session& s) { return s.theCase().spacing; })
      .def_prop_ro("end", [](const Session& s) { return s.theCase().time.end; })
      .def_prop_ro("step_length", [](const Session& s) { return s.theCase().time.step; })
      .def_prop_ro("steps_vary", [](const Session& s) { return s.theCase().time.stepsVary(); })
      .def_prop_ro("fluid_count", [](const Session& s) { return s.simulation().numbers().fluid; })
      .def_prop_ro("wall_count", [](const Session& s) { return s.simulation().numbers().wall; })
      .def_prop_ro("bytes", [](const Session& s) { return s.simulation().bytes(); })
      .def_prop_ro("newtonian_viscosities",
                   [](const Session& s) {
                     std::vector<double> viscosities;  // 0 where it follows from something
                     for (const Material& material : s.theCase().materials)
                       viscosities.push_back(material.hasOwnViscosities() ? 0 : material.dynamicViscosity);
                     return viscosities;
                   })
      .def_prop_ro("state_names", [](const Session& s) { return s.theCase().stateNames(); })
      .def_prop_ro("material_names",
                   [](const Session& s) {
                     std::vector<std::string> names;
                     for (const Material& material : s.theCase().materials) names.push_back(material.name);
                     return names;
                   })
      .def_prop_ro("body_names",
                   [](const Session& s) {
                     std::vector<std::string> names;
                     for (const Body& body : s.theCase().bodies) names.push_back(body.name);
                     return names;
                   })
      .def_prop_ro("probe_names",
                   [](const Session& s) {
                     std::vector<std::string> names;
                     for (const Probe& probe : s.theCase().probes) names.push_back(probe.name);
                     return names;
                   })
      .def_prop_ro("history", [](const Session& s) { return tableOf(s.history()); })
      .def_prop_ro("balance", [](const Session& s) { return tableOf(s.balance()); })
      .def_prop_ro("rigid_bodies", [](const Session& s) { return tableOf(s.rigidBodies()); })
      .def("probe", &probeOf, "name"_a)
      .def("has_field", &hasField, "name"_a)
      .def(
          "copied_field",
          [](const Session& s, const std::string& name) { return nb::borrow<nb::any>(copiedField(s, name)); },
          "name"_a)
      .def(
          "field_in_place",
          [](const Session& s, const std::string& name) {
            return nb::borrow<nb::any>(fieldInPlace(s, name, nb::find(s)));
          },
          "name"_a)
      .def(
          "field_address",
          [](const Session& s, const std::string& name) {
            return nb::typed<nb::tuple, int, nb::typed<nb::tuple, int, nb::ellipsis>, nb::str>(
                fieldAddress(s, name));
          },
          "name"_a)
      .def("give_fluid", &giveFluid, "positions"_a.none(), "velocities"_a.none(), "temperatures"_a.none(),
           "viscosity_factors"_a.none(), "states"_a)
      .def_prop_ro("viscosities", [](const Session& s) { return nb::borrow<nb::any>(arrayOf(s.viscosities())); })
      .def_prop_ro("walls", [](const Session& s) { return Arrays(arraysOf(s.wallsFrame())); })
      .def("write_frame", &writeFrame, "path"_a, "walls"_a, Quiet())
      .def("write_checkpoint", &writeCheckpointOf, "path"_a, Quiet());
}

}  // namespace
}  // namespace treacle

NB_MODULE(_treacle, m) {
  using namespace treacle;
  namespace nb = nanobind;
  m.doc() = "The program's rooms, as the package treacle uses them.";
  registerErrors();
  nb::class_<Case>(m, "CaseData", "A case that has been read and checked.")
      .def_prop_ro(
          "text", [](const Case& c) { return caseText(c); }, "The case as TOML, every key explicit.");
  m.def(
      "read_case",
      [](const std::filesystem::path& path, const std::vector<std::string>& overrides) {
        return readCase(path, overrides);
      },
      "path"_a, "overrides"_a, Quiet());
  m.def(
      "parse_case",
      [](const std::string& text, const std::vector<std::string>& overrides) {
        return readCaseText(text, overrides);
      },
      "text"_a, "overrides"_a, Quiet());
  bindReport(m);
  bindSession(m);
  nb::class_<Recording>(m, "Recording", "The run directory of a session's steps.")
      .def(nb::init<Session&, const std::filesystem::path&, bool>(), "session"_a, "directory"_a, "force"_a,
           nb::keep_alive<1, 2>(), Quiet())
      .def("record", &Recording::record, Quiet())
      .def("finish", &Recording::finish, "failure"_a, Quiet())
      .def("take_warnings", &Recording::takeWarnings);
  m.def(
      "read_frame",
      [](const std::filesystem::path& path) {
        const Frame frame = readFrame(path);
        return nb::typed<nb::tuple, double, int, Arrays>(
            nb::make_tuple(frame.time, frame.dimensions, arraysOf(frame)));
      },
      "path"_a);
  m.def("case_tables", &tables, "(name, [(key, type, unit), ...]) of every table that a case can have.");
  m.def("cuda_devices", &devices);
  m.attr("version") = buildInfo().version;
  m.attr("commit") = buildInfo().commit;
  m.attr("cuda_compiled") = cudaCompiled;
}
