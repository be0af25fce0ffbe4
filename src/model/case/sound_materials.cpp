#include "case_checker.hpp"
#include "treacle/model/materials/state_table.hpp"

#include <cctype>

namespace treacle {

/// The viscosity of every shear rate must be finite, and that of a fluid at rest positive: without any it would
/// fall apart.
void requireSound(const Checker& at, const Rheology& r) {
  using enum RheologyModel;
  if (r.mostViscosity > 0 && r.mostViscosity <= r.leastViscosity)
    at.fail({"max_viscosity"},
            fmt::format("expected more than min_viscosity = {}, found {}", r.leastViscosity, r.mostViscosity));
  // What the fluid has however fast it is sheared.
  const auto [slowest, key] = r.model == Bingham || r.model == Casson
                                  ? std::pair(r.plasticViscosity, "plastic_viscosity")
                                  : std::pair(r.infiniteViscosity, "infinite_viscosity");
  if (r.mostViscosity > 0 && r.mostViscosity <= slowest)
    at.fail({"max_viscosity"}, fmt::format("expected more than {} = {}, found {}", key, slowest, r.mostViscosity));
  const bool plateaus = r.model == Cross || r.model == CarreauYasuda;
  if (plateaus && r.infiniteViscosity > r.zeroViscosity)
    at.fail({"infinite_viscosity"},
            fmt::format("expected at most zero_viscosity = {}, found {}", r.zeroViscosity, r.infiniteViscosity));
  if (plateaus && r.flowIndex > 1)
    at.fail({"flow_index"}, fmt::format("expected at most 1 between two plateaus, found {}", r.flowIndex));
  const bool power = r.model == PowerLaw || r.model == HerschelBulkley;
  if (power && r.flowIndex < 1 && r.mostViscosity == 0)
    at.fail({"max_viscosity"},
            fmt::format("expected a positive number [Pa s]: with flow_index = {} < 1 a fluid at rest would be "
                        "infinitely viscous",
                        r.flowIndex));
  if (r.model == PowerLaw && r.flowIndex > 1 && r.leastViscosity == 0)
    at.fail(
        {"min_viscosity"},
        fmt::format("expected a positive number [Pa s]: with flow_index = {} > 1 a fluid at rest would have no "
                    "viscosity",
                    r.flowIndex));
}

/// Shift factors that are defined at all temperatures, and tables that are functions.
void requireSound(const Checker& at, const ViscosityShift& s) {
  if (s.model != ShiftModel::Table && s.least > 1)
    at.fail({"min_factor"}, fmt::format("expected at most 1, the factor at the reference, found {}", s.least));
  if (s.model != ShiftModel::Table && s.most < 1)
    at.fail({"max_factor"}, fmt::format("expected at least 1, the factor at the reference, found {}", s.most));
  if (s.least >= s.most)
    at.fail({"max_factor"}, fmt::format("expected more than min_factor = {}, found {}", s.least, s.most));
  if (s.model == ShiftModel::Vft && s.divergence >= s.reference)
    at.fail({"t0"},
            fmt::format("expected less than reference_temperature = {} K, found {}", s.reference, s.divergence));
  if (s.model != ShiftModel::Table) return;
  const std::size_t rows = s.temperatures.size();
  if (rows < 2 || rows > ViscosityShift::mostRows)
    at.fail({"temperatures"}, fmt::format("expected 2 to {} numbers, found {}", ViscosityShift::mostRows, rows));
  if (s.factors.size() != rows)
    at.fail({"factors"},
            fmt::format("expected as many numbers as temperatures, {}, found {}", rows, s.factors.size()));
  at.requireRising("temperatures", "numbers", s.temperatures);
}

void requireSound(const Checker& at, const Freezing& f) {
  if (f.solidus >= f.liquidus)
    at.fail({"liquidus"}, fmt::format("expected more than solidus = {} K, found {}", f.solidus, f.liquidus));
}

void requireSound(const Checker& at, const MaterialState& s) {
  constexpr std::size_t longest = 30;
  const auto isOfName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  if (s.name.size() > longest || !std::ranges::all_of(s.name, isOfName) ||
      std::isdigit(static_cast<unsigned char>(s.name.front())))
    at.fail({"name"}, fmt::format("expected at most {} letters, digits and _, with a letter first, found '{}'",
                                  longest, s.name));
  for (const std::string_view taken : {"T", "t", "pi", "position"})
    if (s.name == taken) at.fail({"name"}, fmt::format("'{}' is the name of another variable", taken));
  for (const OutputFieldName& f : outputFieldNames)
    if (s.name == f.name) at.fail({"name"}, fmt::format("'{}' is the name of another field of frames", f.name));
  if (s.lowest() >= s.highest())
    at.fail({"max"}, fmt::format("expected more than min = {}, found {}", s.lowest(), s.highest()));
  if (!(s.start >= s.lowest() && s.start <= s.highest()))
    at.fail({"start"}, fmt::format("expected a number from {} to {}, found {}", s.lowest(), s.highest(), s.start));
  if (s.law != StateLaw::KamalSourour) return;
  if (s.a1 == 0 && s.a2 == 0) at.fail({"a1"}, "expected a1 or a2 above 0: nothing reacts");
  if (!at.wholeCase().heat && (s.e1 != 0 || s.e2 != 0))
    at.fail({s.e1 != 0 ? "e1" : "e2"}, "there are no temperatures in a case without [heat]");
}

/// Elastic stresses are sums of the accurate scheme.
void requireSoundElasticity(const Checker& at, const Material& m) {
  if (m.elastic.empty()) return;
  const Case& c = at.wholeCase();
  if (c.method.kind != MethodKind::MphI)
    at.fail({"elastic"}, fmt::format("only the method '{}' has it, found '{}'", nameOf(MethodKind::MphI),
                                     nameOf(c.method.kind)));
  if (!c.isAccurate()) at.fail({"elastic"}, "expected method.scheme = \"accurate\" beside it");
}

/// What only the whole material says: which states its expressions may read.
void requireSoundStates(const Checker& at, const Material& m) {
  const Case& c = at.wholeCase();
  if (!m.hasFormulas()) return;
  if (c.method.kind != MethodKind::MphI)
    at.fail(
        {!m.states.empty()            ? "state"
         : !m.viscosityFactor.empty() ? "viscosity_factor"
                                      : "gelling"},
        fmt::format("only the method '{}' has it, found '{}'", nameOf(MethodKind::MphI), nameOf(c.method.kind)));
  if (const std::size_t count = c.stateNames().size(); count > maxStates)
    at.fail({"state"},
            fmt::format("the materials have {} states of different names, expected at most {}", count, maxStates));
  const std::vector<std::string> variables = stateVariables(c, m);
  const auto require = [&](std::initializer_list<std::string_view> keys, const std::string& text) {
    if (text.empty()) return;
    try {
      Formula(text, variables);
    } catch (const InputError& e) {
      at.fail(keys, e.what());
    }
  };
  for (const MaterialState& s : m.states) require({"state", s.name, "rate"}, s.rateText());
  require({"viscosity_factor"}, m.viscosityFactor);
  require({"yield_factor"}, m.yieldFactor);
  if (!m.yieldFactor.empty() && !(m.rheology && m.rheology->yields()))
    at.fail({"yield_factor"}, "the material has no rheology with a yield stress");
  require({"volume_factor"}, m.volumeFactor);
  if (!m.volumeFactor.empty()) {
    if (!c.isAccurate()) at.fail({"volume_factor"}, "expected method.scheme = \"accurate\" beside it");
    if (m.thermalExpansion != 0)
      at.fail({"volume_factor"}, "the weight follows it: expected no thermal_expansion beside it");
  }
  if (!m.gelling) return;
  const auto state = std::ranges::find(m.states, m.gelling->state, &MaterialState::name);
  if (state == m.states.end())
    at.fail({"gelling", "state"}, fmt::format("unknown state '{}' of the material", m.gelling->state));
  if (state->start >= m.gelling->conversion)
    at.fail({"gelling", "conversion"}, fmt::format("expected more than what '{}' starts with, {}, found {}",
                                                   state->name, state->start, m.gelling->conversion));
}

void requireSound(const Checker& at, const Material& m) {
  requireSoundElasticity(at, m);
  requireSoundStates(at, m);
  if (m.rheology && at.wholeCase().method.kind != MethodKind::MphI) at.fail({"rheology"}, rheologyOfMphI);
  if (m.viscosityShift && !at.wholeCase().heat)
    at.fail({"viscosity_shift"}, "there are no temperatures in a case without [heat]");
  if (m.freezing && !at.wholeCase().heat)
    at.fail({"freezing"}, "there are no temperatures in a case without [heat]");
  if (m.thermalExpansion != 0 && !at.wholeCase().heat)
    at.fail({"thermal_expansion"}, "there are no temperatures in a case without [heat]");
  if (m.expansionTemperature != 0 && m.thermalExpansion == 0)
    at.fail({"expansion_temperature"}, "the material has no thermal_expansion");
  if (at.wholeCase().method.kind != MethodKind::MphI &&
      (m.surfaceTension != 0 || m.contactAngle != Material{}.contactAngle || !m.contactAngles.empty()))
    at.fail({m.surfaceTension != 0                       ? "surface_tension"
             : m.contactAngle != Material{}.contactAngle ? "contact_angle"
                                                         : "contact_angles"},
            fmt::format("only the method '{}' has surface tension, found '{}'", nameOf(MethodKind::MphI),
                        nameOf(at.wholeCase().method.kind)));
  for (const ContactAngle& a : m.contactAngles)
    if (std::ranges::find(at.wholeCase().materials, a.name, &Material::name) == at.wholeCase().materials.end())
      at.fail({"contact_angles", a.name, "name"}, fmt::format("unknown material '{}'", a.name));
  if (m.rheology && m.dynamicViscosity != 0) at.fail({"dynamic_viscosity"}, viscosityBesideRheology);
}

}  // namespace treacle
