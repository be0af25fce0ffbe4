#include "treacle/model/materials/state_table.hpp"

#include "treacle/model/case/case.hpp"

#include <algorithm>
#include <limits>

namespace treacle {
namespace {

/// Adds the steps of an expression; none for none.
StateTable::Part add(const std::string& text, const std::vector<std::string>& variables,
                     std::vector<FormulaStep>& steps) {
  if (text.empty()) return {};
  const std::vector<FormulaStep> own = Formula(text, variables).steps();
  const StateTable::Part part{static_cast<int>(steps.size()), static_cast<int>(own.size())};
  steps.insert(steps.end(), own.begin(), own.end());
  return part;
}

}  // namespace

std::vector<std::string> stateVariables(const Case& c, const Material& m) {
  std::vector<std::string> variables{c.heat ? "T" : "", "shear_rate", "t"};
  for (const std::string& name : c.stateNames())
    variables.push_back(std::ranges::find(m.states, name, &MaterialState::name) == m.states.end() ? "" : name);
  return variables;
}

StateTable StateTable::make(const Case& c, std::vector<FormulaStep>& steps) {
  StateTable t{};
  const std::vector<std::string> names = c.stateNames();
  for (std::size_t m = 0; m < c.materials.size(); ++m) {
    const Material& material = c.materials[m];
    const std::vector<std::string> variables = stateVariables(c, material);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto s = std::ranges::find(material.states, names[k], &MaterialState::name);
      if (s == material.states.end()) continue;
      t.rate[m][k] = add(s->rateText(), variables, steps);
      t.least[m][k] = s->lowest(), t.most[m][k] = s->highest();
      if (!c.heat) continue;
      t.heat[m][k] = material.density * s->heat;
      t.warming[m][k] = s->heat / material.specificHeat;
    }
    t.viscosity[m] = add(material.viscosityFactor, variables, steps);
    t.yield[m] = add(material.yieldFactor, variables, steps);
    t.volume[m] = add(material.volumeFactor, variables, steps);
    if (material.gelling) t.gelling[m] = add(material.gelling->text(), variables, steps);
  }
  return t;
}

}  // namespace treacle
