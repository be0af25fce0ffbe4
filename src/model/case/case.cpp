#include "treacle/model/case/case.hpp"

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

double Case::typicalShift(const Material& m) const {
  return heat && m.viscosityShift ? ShiftFactor::make(*m.viscosityShift)(typicalTemperature(m)) : 1;
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
