#include "treacle/model/case/case.hpp"

#include "treacle/model/materials/state_table.hpp"

#include <algorithm>

namespace treacle {

double Case::typicalTemperature(const Material& m) const {
  for (const Body& body : bodies)
    if (body.holdsFluid() && &materials[static_cast<std::size_t>(body.material)] == &m &&
        body.temperatureExpression.empty() && !body.fileTemperatures)
      return body.temperature;
  if (!m.viscosityShift) return heat->ambient;
  const ViscosityShift& s = *m.viscosityShift;
  return s.model == ShiftModel::Table ? s.temperatures[s.temperatures.size() / 2] : s.reference;
}

std::vector<std::string> Case::stateNames() const {
  std::vector<std::string> names;
  for (const Material& m : materials)
    for (const MaterialState& s : m.states)
      if (std::ranges::find(names, s.name) == names.end()) names.push_back(s.name);
  return names;
}

std::vector<double> Case::startsOfStates(const Material& m) const {
  std::vector<double> starts;
  for (const std::string& name : stateNames()) {
    const auto own = std::ranges::find(m.states, name, &MaterialState::name);
    starts.push_back(own == m.states.end() ? 0 : own->start);
  }
  return starts;
}

double Case::typicalShift(const Material& m) const {
  return heat && m.viscosityShift ? ShiftFactor::make(*m.viscosityShift)(typicalTemperature(m)) : 1;
}

double Case::typicalViscosity(const Material& m) const {
  double factor = 1, yield = 1;
  if (m.hasFormulas()) {
    std::vector<double> x{heat ? typicalTemperature(m) : 0, 1, 0};
    const std::vector<double> starts = startsOfStates(m);
    x.insert(x.end(), starts.begin(), starts.end());
    const std::vector<std::string> variables = stateVariables(*this, m);
    const auto value = [&](const std::string& text) {
      return text.empty() ? 1 : Formula(text, variables)(x.data());
    };
    factor = value(m.viscosityFactor) * (m.gelling ? value(m.gelling->text()) : 1), yield = value(m.yieldFactor);
  }
  const double shift = typicalShift(m);
  return factor * (m.viscosity(1, shift, yield) + shift * m.elasticViscosity());
}

Vec<3> Case::meanGravity(double from, double to) const {
  Vec<3> mean = gravity;
  const double start = std::max(from, 0.0);
  for (std::size_t k = 0; k < gravityInTime.size(); ++k)
    if (const auto& f = gravityInTime[k])
      mean[static_cast<int>(k)] = to > start ? f->integral(start, to) / (to - start) : f->at(to);
  return mean;
}

}  // namespace treacle
