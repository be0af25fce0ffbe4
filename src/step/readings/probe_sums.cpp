#include "treacle/step/readings/probe_sums.hpp"

#include <algorithm>
#include <limits>

namespace treacle {

template <int D>
PartWeight<D> PartWeight<D>::of(const Probe& probe, const Case& c) {
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  PartWeight w;
  w.low = probe.box ? resized<D>(probe.box->min) : Vec<D>::filled(-everywhere);
  w.high = probe.box ? resized<D>(probe.box->max) : Vec<D>::filled(everywhere);
  w.inverseSpacing = 1 / c.spacing;
  if (const double length = norm(probe.normal); length > 0) {
    w.plane = probe.kind == ProbeKind::Flow ? Across : Behind;
    w.point = resized<D>(probe.point), w.normal = resized<D>((1 / length) * probe.normal);
  }
  if (!probe.material.empty())
    w.material =
        static_cast<int>(std::ranges::find(c.materials, probe.material, &Material::name) - c.materials.begin());
  return w;
}

template struct PartWeight<2>;
template struct PartWeight<3>;

}  // namespace treacle
