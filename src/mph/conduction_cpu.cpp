#include "lane_sums.hpp"
#include "treacle/mph/conduction_sums.hpp"

namespace treacle {

std::vector<WallHeat> wallHeat(const Case& c) {
  std::vector<WallHeat> walls;
  for (const Body& body : c.bodies)
    walls.push_back({body.kind == BodyKind::Fluid ? 0 : body.temperature,
                     body.wallConductance > 0 ? 1 / body.wallConductance : 0});
  return walls;
}

HeatTable HeatTable::make(const Case& c) {
  HeatTable t{};
  for (std::size_t a = 0; a < c.materials.size(); ++a) {
    const Material& m = c.materials[a];
    t.conductivity[a] = m.conductivity;
    t.capacity[a] = m.density * m.specificHeat;
    t.emissivity[a] = m.emissivity;
    for (std::size_t b = 0; b < c.materials.size(); ++b) {
      const double other = c.materials[b].conductivity, sum = m.conductivity + other;
      t.pairConductivity[a][b] = sum > 0 ? 2 * m.conductivity * other / sum : 0;
    }
  }
  return t;
}

TREACLE_CONDUCTION_SUMS(2, Cpu)
TREACLE_CONDUCTION_SUMS(3, Cpu)

}  // namespace treacle
