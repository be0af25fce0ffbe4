#include "case_checker.hpp"

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

void requireSound(const Checker& at, const Material& m) {
  if (m.rheology && at.wholeCase().method.kind != MethodKind::MphI) at.fail({"rheology"}, rheologyOfMphI);
  if (m.viscosityShift && !at.wholeCase().heat)
    at.fail({"viscosity_shift"}, "there are no temperatures in a case without [heat]");
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
