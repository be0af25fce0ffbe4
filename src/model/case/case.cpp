#include "treacle/model/case/case.hpp"

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

double Case::typicalShift(const Material& m) const {
  return heat && m.viscosityShift ? ShiftFactor::make(*m.viscosityShift)(typicalTemperature(m)) : 1;
}

}  // namespace treacle
