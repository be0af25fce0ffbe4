#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/key.hpp"

namespace treacle::keys {

void visit(auto& v, Like<Rheology> auto& r, const Case&) {
  using enum RheologyModel;
  v({"model", required}, r.model);
  if (r.yields()) {
    v({"yield_stress", required, "Pa", positive}, r.yieldStress);
    v({"regularisation", required, "s", regularisation}, r.regularisation);
  }
  if (r.model == Bingham || r.model == Casson)
    v({"plastic_viscosity", required, "Pa s", positive}, r.plasticViscosity);
  if (r.model == PowerLaw || r.model == HerschelBulkley)
    v({"consistency", required, "Pa s^n", positive}, r.consistency);
  if (r.model == Cross || r.model == CarreauYasuda) {
    v({"zero_viscosity", required, "Pa s", positive}, r.zeroViscosity);
    v({"infinite_viscosity", optional, "Pa s", notNegative}, r.infiniteViscosity);
    v({"time_constant", required, "s", positive}, r.timeConstant);
  }
  if (r.hasIndex()) v({"flow_index", required, "", flowIndex}, r.flowIndex);
  if (r.model == CarreauYasuda) v({"transition", optional, "", positive}, r.transition);
  v({"min_viscosity", optional, "Pa s", notNegative}, r.leastViscosity);
  v({"max_viscosity", optional, "Pa s", notNegative}, r.mostViscosity);
}

void visit(auto& v, Like<ViscosityShift> auto& s, const Case&) {
  v({"model", required}, s.model);
  if (s.model == ShiftModel::Table) {
    v({"temperatures", required, "K", positive}, s.temperatures);
    v({"factors", required, "", positive}, s.factors);
    return;
  }
  v({"reference_temperature", required, "K", positive}, s.reference);
  if (s.model == ShiftModel::Arrhenius) v({"activation_energy", required, "J/mol", positive}, s.activationEnergy);
  if (s.model == ShiftModel::Vft) {
    v({"b", required, "K", positive}, s.slope);
    v({"t0", required, "K", notNegative}, s.divergence);
  }
  if (s.model == ShiftModel::Wlf) {
    v({"c1", required, "", positive}, s.c1);
    v({"c2", required, "K", positive}, s.c2);
  }
  v({"min_factor", optional, "", positive}, s.least);
  v({"max_factor", optional, "", positive}, s.most);
}

void visit(auto& v, Like<Material> auto& m, const Case& c) {
  v({"name", required}, m.name);
  v({"density", required, "kg/m3", positive}, m.density);
  if (c.method.kind == MethodKind::MphI) v({"rheology"}, m.rheology);
  if (!m.rheology) v({"dynamic_viscosity", required, "Pa s", notNegative}, m.dynamicViscosity);
  if (c.method.kind != MethodKind::MphI) return;
  v({"bulk_viscosity", required, "Pa s", notNegative}, m.bulkViscosity);
  v({"bulk_modulus", required, "Pa", notNegative}, m.bulkModulus);
  v({"slip_length", optional, "m", notNegative}, m.slipLength);
  v({"surface_tension", optional, "N/m", notNegative}, m.surfaceTension);
  v({"contact_angle", optional, "deg", {0, 180}}, m.contactAngle);
  if (!c.heat) return;
  v({"specific_heat", required, "J/(kg K)", positive}, m.specificHeat);
  v({"conductivity", required, "W/(m K)", notNegative}, m.conductivity);
  v({"emissivity", optional, "", {0, 1}}, m.emissivity);
  v({"viscosity_shift"}, m.viscosityShift);
}

}  // namespace treacle::keys
