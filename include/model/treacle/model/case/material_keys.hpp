#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/key.hpp"

namespace treacle::keys {

void visit(auto& v, Like<Rheology> auto& r, const Case&) {
  using enum RheologyModel;
  v({"model", "Formula of the viscosity", required}, r.model);
  if (r.yields()) {
    v({"yield_stress", "Yield stress", required, "Pa", positive}, r.yieldStress);
    v({"regularisation", "Time constant m of Papanastasiou's regularisation of the yield stress", required, "s",
       regularisation},
      r.regularisation);
  }
  if (r.model == Bingham || r.model == Casson)
    v({"plastic_viscosity", "Plastic viscosity", required, "Pa s", positive}, r.plasticViscosity);
  if (r.model == PowerLaw || r.model == HerschelBulkley)
    v({"consistency", "Consistency K", required, "Pa s^n", positive}, r.consistency);
  if (r.model == Cross || r.model == CarreauYasuda) {
    v({"zero_viscosity", "Viscosity at rest", required, "Pa s", positive}, r.zeroViscosity);
    v({"infinite_viscosity", "Viscosity of infinitely fast shear, at most zero_viscosity", optional, "Pa s",
       notNegative},
      r.infiniteViscosity);
    v({"time_constant", "Time constant k", required, "s", positive}, r.timeConstant);
  }
  if (r.hasIndex())
    v({"flow_index", "Exponent n: below 1 the fluid thins when it is sheared, above 1 it thickens", required, "",
       flowIndex},
      r.flowIndex);
  if (r.model == CarreauYasuda)
    v({"transition", "Exponent a of Yasuda; 2 is the model of Carreau", optional, "", yasuda}, r.transition);
  v({"min_viscosity", "The viscosity is at least this; a power law with n > 1 needs it", optional, "Pa s",
     notNegative},
    r.leastViscosity);
  v({"max_viscosity",
     "The viscosity is at most this, 0 being no bound; power law and Herschel-Bulkley with n < 1 need it",
     optional, "Pa s", notNegative},
    r.mostViscosity);
}

void visit(auto& v, Like<ViscosityShift> auto& s, const Case&) {
  v({"model", "Formula of the shift factor a of the viscosity", required}, s.model);
  if (s.model == ShiftModel::Table) {
    v({"temperatures", "Rising temperatures of the table, 2 to 16", required, "K", positive}, s.temperatures);
    v({"factors", "The factor a at each of them", required, "", positive}, s.factors);
    return;
  }
  v({"reference_temperature", "Temperature at which the factor is 1", required, "K", positive}, s.reference);
  if (s.model == ShiftModel::Arrhenius)
    v({"activation_energy", "Activation energy E", required, "J/mol", positive}, s.activationEnergy);
  if (s.model == ShiftModel::Vft) {
    v({"b", "Constant B", required, "K", positive}, s.slope);
    v({"t0", "Temperature T0 at which the viscosity diverges", required, "K", notNegative}, s.divergence);
  }
  if (s.model == ShiftModel::Wlf) {
    v({"c1", "Constant C1", required, "", positive}, s.c1);
    v({"c2", "Constant C2", required, "K", positive}, s.c2);
  }
  v({"min_factor", "The factor is at least this", optional, "", positive}, s.least);
  v({"max_factor", "The factor is at most this", optional, "", positive}, s.most);
}

void visit(auto& v, Like<MaterialState> auto& s, const Case& c) {
  v({"name", "Name of the state, by which expressions and frames call it", required}, s.name);
  v({"law", "How the state changes", required}, s.law);
  v({"start", "What fluid starts with of which its body says nothing else", optional}, s.start);
  const Key most{"max", "The state is at most this"};
  switch (s.law) {
    case StateLaw::Expression:
      v({"rate", "Change per second, an expression in the states, T [K], shear_rate [1/s] and t [s]", required},
        s.rate);
      v({"min", "The state is at least this"}, s.least);
      v(most, s.most);
      break;
    case StateLaw::KamalSourour:
      v({"a1", "Factor A1 of the reaction that begins by itself", optional, "1/s", notNegative}, s.a1);
      v({"e1", "Its activation energy", optional, "J/mol", notNegative}, s.e1);
      v({"a2", "Factor A2 of the reaction that what has reacted speeds up", optional, "1/s", notNegative}, s.a2);
      v({"e2", "Its activation energy", optional, "J/mol", notNegative}, s.e2);
      v({"m", "Exponent of the state", optional, "", reactionOrder}, s.m);
      v({"n", "Exponent of what is left to react", optional, "", reactionOrder}, s.n);
      v({"max_conversion", "The state at which the reaction ends", optional, "", conversion}, s.mostConversion);
      break;
    case StateLaw::Houska:
      v({"build_up", "Rate a at which structure builds up", required, "1/s", notNegative}, s.buildUp);
      v({"break_down", "Factor b of its breakdown by shear", required, "s^(exponent-1)", notNegative},
        s.breakDown);
      v({"exponent", "Exponent of the shear rate in the breakdown", optional, "", flowIndex}, s.exponent);
      break;
    case StateLaw::Roussel:
      v({"time", "Time in which the state grows by 1 at rest", required, "s", positive}, s.time);
      v({"break_down", "Factor b of the breakdown by shear", required, "", notNegative}, s.breakDown);
      v(most, s.most);
      break;
  }
  if (c.heat) v({"heat", "Heat set free per unit of the state", optional, "J/kg"}, s.heat);
}

void visit(auto& v, Like<ElasticMode> auto& e, const Case&) {
  v({"name", "Name of the mode, unique among those of the material", required}, e.name);
  v({"model", "How the stress of the mode relaxes", required}, e.model);
  v({"viscosity", "Viscosity of the mode in slow flow, beside that of the solvent", required, "Pa s", positive},
    e.viscosity);
  v({"relaxation_time", "Time in which its stress relaxes", required, "s", positive}, e.relaxationTime);
  if (e.model == ElasticModel::Giesekus)
    v({"mobility", "Mobility alpha: above 0 the viscosity falls with the shear rate", required, "", mobility},
      e.mobility);
  if (e.model == ElasticModel::LinearPtt || e.model == ElasticModel::ExponentialPtt)
    v({"extensibility", "Constant epsilon: the larger, the less the mode stretches", required, "", extensibility},
      e.extensibility);
}

void visit(auto& v, Like<Gelling> auto& g, const Case&) {
  v({"state", "Name of the state that comes to the gel point", required}, g.state);
  v({"conversion", "The state at the gel point", required, "", positive}, g.conversion);
  v({"a", "Constant a of the exponent a + b s", required, "", notNegative}, g.a);
  v({"b", "Constant b of the exponent", optional}, g.b);
  v({"max_factor", "The viscosity is multiplied by at most this, also beyond the gel point", optional, "",
     gelFactor},
    g.mostFactor);
}

void visit(auto& v, Like<Freezing> auto& f, const Case&) {
  v({"solidus", "Temperature up to which all is solid", required, "K", positive}, f.solidus);
  v({"liquidus", "Temperature from which on all is liquid, above solidus", required, "K", positive}, f.liquidus);
  v({"latent_heat", "Heat that is set free between them", required, "J/kg", notNegative}, f.latentHeat);
  v({"solid_conductivity", "Thermal conductivity of the solid; 0: that of the liquid", optional, "W/(m K)",
     notNegative},
    f.solidConductivity);
  v({"solid_specific_heat", "Specific heat capacity of the solid; 0: that of the liquid", optional, "J/(kg K)",
     notNegative},
    f.solidSpecificHeat);
  v({"solid_factor", "What the viscosity of the solid is multiplied by: under load it creeps", optional, "",
     solidFactor},
    f.solidFactor);
}

void visit(auto& v, Like<ContactAngle> auto& a, const Case&) {
  v({"name", "Name of the material of the fluid, unique among them", required}, a.name);
  v({"angle", "Angle of its free surfaces with the wall, measured in the fluid", required, "deg", {0, 180}},
    a.angle);
}

void visit(auto& v, Like<Material> auto& m, const Case& c) {
  v({"name", "Name of the material, unique among them", required}, m.name);
  v({"density", "Density", required, "kg/m3", positive}, m.density);
  if (c.method.kind == MethodKind::MphI)
    v({"rheology", "Viscosity that follows the shear rate, in place of dynamic_viscosity"}, m.rheology);
  if (!m.rheology)
    v({"dynamic_viscosity", "Shear viscosity mu", required, "Pa s", notNegative}, m.dynamicViscosity);
  if (c.method.kind != MethodKind::MphI) return;
  v({"bulk_viscosity",
     "Bulk viscosity lambda, which stands in for incompressibility; auto: 1000 times the shear viscosity, or what "
     "the step needs; of a fluid not 0 together with bulk_modulus",
     optional, "Pa s", notNegative},
    m.bulkViscosity, m.autoBulkViscosity, orAuto);
  v({"bulk_modulus",
     "Bulk modulus kappa, with which the fluid takes its volume back, at most half of bulk_viscosity over the "
     "step with the default scheme; auto: by the pressures of the case",
     optional, "Pa", notNegative},
    m.bulkModulus, m.autoBulkModulus, orAuto);
  v({"elastic",
     "Elastic modes of the fluid; its dynamic_viscosity or rheology is then that of the solvent",
     optional,
     "",
     {0, maxElasticModes}},
    m.elastic);
  v({"state", "What particles of the material carry and a law changes", optional, "", {0, maxStates}}, m.states);
  v({"viscosity_factor",
     "What the viscosity is multiplied by, an expression in the states, T [K], shear_rate [1/s] and t [s]"},
    m.viscosityFactor, keys::formula);
  v({"yield_factor", "What the yield stress of a rheology is multiplied by, likewise"}, m.yieldFactor,
    keys::formula);
  v({"volume_factor",
     "What the volume of the fluid is multiplied by, likewise, from 0.75 to 1.33; its weight per volume follows"},
    m.volumeFactor, keys::formula);
  v({"gelling", "Viscosity that grows without bound as a state comes to the gel point"}, m.gelling);
  v({"slip_length",
     "Of a fluid: how far behind the surface of a wall its velocity, extrapolated, meets the wall's; 0: no slip",
     optional, "m", notNegative},
    m.slipLength);
  v({"surface_tension", "Surface tension of the free surfaces of this fluid", optional, "N/m", notNegative},
    m.surfaceTension);
  v({"contact_angle",
     "Of a wall: angle of free surfaces with it, measured in the fluid",
     optional,
     "deg",
     {0, 180}},
    m.contactAngle);
  v({"contact_angles",
     "Of a wall: contact angles of single fluids, in place of contact_angle",
     optional,
     "",
     {0, maxMaterials}},
    m.contactAngles);
  if (!c.heat) return;
  v({"specific_heat", "Specific heat capacity", required, "J/(kg K)", positive}, m.specificHeat);
  v({"conductivity", "Thermal conductivity", required, "W/(m K)", notNegative}, m.conductivity);
  v({"emissivity", "Emissivity of free surfaces of this fluid", optional, "", {0, 1}}, m.emissivity);
  v({"viscosity_shift", "Viscosity that follows the temperature"}, m.viscosityShift);
  v({"freezing", "Fluid that freezes and melts"}, m.freezing);
  v({"thermal_expansion",
     "Thermal expansion beta by Boussinesq's approximation: weight follows the temperature, volume does not",
     optional, "1/K"},
    m.thermalExpansion);
  v({"expansion_temperature",
     "Temperature at which the weight is that of density; 0: ambient_temperature of [heat]", optional, "K",
     notNegative},
    m.expansionTemperature);
}

}  // namespace treacle::keys
