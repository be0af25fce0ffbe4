#include "treacle/step/readings/probe_sums.hpp"
#include "treacle/step/readings/wall_patch.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace treacle {

namespace {

/// Of the domain; 0: none [m].
template <int D>
Vec<D> periodsOf(const Case& c) {
  Vec<D> period{};
  for (int k = 0; k < D; ++k)
    if (c.domain.periodic[static_cast<std::size_t>(k)]) period[k] = c.domain.max[k] - c.domain.min[k];
  return period;
}

}  // namespace

template <int D>
PartWeight<D> PartWeight<D>::of(const Probe& probe, const Case& c) {
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  PartWeight w;
  w.low = probe.box ? resized<D>(probe.box->min) : Vec<D>::filled(-everywhere);
  w.high = probe.box ? resized<D>(probe.box->max) : Vec<D>::filled(everywhere);
  w.inverseSpacing = 1 / c.spacing;
  w.period = periodsOf<D>(c);
  if (const double length = norm(probe.normal); length > 0) {
    w.plane = probe.kind == ProbeKind::Flow ? Across : Behind;
    w.point = resized<D>(probe.point), w.normal = resized<D>((1 / length) * probe.normal);
  }
  if (!probe.material.empty())
    w.material =
        static_cast<int>(std::ranges::find(c.materials, probe.material, &Material::name) - c.materials.begin());
  return w;
}

template <int D>
WallPatch<D> WallPatch<D>::of(const Probe& probe, const Case& c) {
  WallPatch patch;
  const auto body = std::ranges::find(c.bodies, probe.body, &Body::name);
  patch.body = static_cast<std::uint8_t>(body - c.bodies.begin());
  patch.corner = resized<D>(probe.corner);
  patch.width = norm(probe.along);
  patch.along = resized<D>((1 / patch.width) * probe.along);
  if constexpr (D == 3) {
    patch.height = norm(probe.up);
    patch.up = (1 / patch.height) * probe.up;
    patch.normal = cross(patch.along, patch.up);
  } else {
    patch.normal = {-patch.along[1], patch.along[0]};
  }
  patch.period = periodsOf<D>(c);
  patch.depth = c.interactionRadius();
  patch.spacing = c.spacing;
  return patch;
}

template struct PartWeight<2>;
template struct PartWeight<3>;
template struct WallPatch<2>;
template struct WallPatch<3>;

}  // namespace treacle
