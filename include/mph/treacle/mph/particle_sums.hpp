#pragma once

#include "treacle/mph/gradient_moment.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/particle_viscosity.hpp"
#include "treacle/mph/renormalisation.hpp"
#include "treacle/mph/viscous_moment.hpp"
#include "treacle/mph/wall_surfaces.hpp"

namespace treacle {

// What a step finds out about each particle by itself, or by one simple sum, for the sources of both backends,
// which instantiate it: mph_particles.hpp, particle_viscosity.hpp, renormalisation.hpp, viscosity_scale.hpp and
// wall_surfaces.hpp.

template <int D, class Backend>
void elasticPressure(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic) {
  forEachParticle(context, pairs, elastic.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    elastic[i] = elasticPressureOf(of, i, n[i], adhesion);
  });
}

template <int D, class Backend>
void inertiaAndGravity(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                       const FrameForce<D>& frame, std::span<Vec<D>> b) {
  forEachParticle(context, pairs, b.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    b[i] = inertiaAndGravityOf(of, i, u[i], frame);
  });
}

template <int D, class Backend>
void wallFriction(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Block<D>> block,
                  std::span<const Vec<D>> u, std::span<Vec<D>> force) {
  forEachParticle(context, pairs, force.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    force[i] = of.inertia(i) * u[i] - block[i] * u[i];
  });
}

template <int D, class Backend>
void bulkPressure(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure) {
  forEachParticle(context, pairs, pressure.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    pressure[i] = bulkPressureOf(of, i, div[i], elastic.empty() ? 0.0 : elastic[i]);
  });
}

template <class Backend>
void setViscosities(Context<Backend>& context, const ViscosityTerms& terms) {
  forEach(context, terms.rate.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <class Backend>
double countUnsound(Context<Backend>& context, std::span<const double> viscosity) {
  return sumEach<1>(context, viscosity.size(), [=] TREACLE_HD(std::size_t i, double* sum) {
    if (!(viscosity[i] >= 0 && viscosity[i] - viscosity[i] == 0)) sum[0] += 1;
  })[0];
}

template <class Backend>
double setVolumes(Context<Backend>& context, const VolumeTerms& terms) {
  return sumEach<1>(context, terms.rate.size(),
                    [=] TREACLE_HD(std::size_t i, double* sum) { terms.add(i, sum); })[0];
}

template <class Backend>
void setClasses(Context<Backend>& context, const ClassTerms& terms) {
  forEach(context, terms.kind.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <class Backend>
double nextRates(Context<Backend>& context, const RateTerms& terms) {
  return RateTerms::change(sumEach<RateTerms::count>(
      context, terms.found.size(), [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); }));
}

template <int D, class Backend>
void placeSurfaces(Context<Backend>& context, const KnownSurfaces<D>& known, std::span<const std::uint8_t> body,
                   std::span<WallSurface<D>> placed) {
  forEach(context, placed.size(), [=] TREACLE_HD(std::size_t k) { placed[k] = placedSurface(known, k, body[k]); });
}

template <int D, class Backend>
void viscosityScale(Context<Backend>& context, const MphPairs<D>& pairs, double correction,
                    std::span<double> scale) {
  sumOnFluid(context, pairs, ViscousMoment<D>{correction, scale.data()});
}

template <int D, class Backend>
void renormalisation(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b) {
  sumOnFluid(context, pairs, GradientMoment<D, MphTerms<D>, false>{pairs.terms, b.data()});
  if (pairs.slips()) return renormaliseAlongWalls(context, pairs, b);
  forEach(context, b.size(), [=] TREACLE_HD(std::size_t i) { b[i] = renormalisationOf(b[i]); });
}

#define TREACLE_PARTICLE_SUMS(D, Backend)                                                                \
  template void elasticPressure(Context<Backend>&, const MphPairs<D>&, std::span<const double>,          \
                                std::span<const Adhesion<D>>, std::span<double>);                        \
  template void inertiaAndGravity(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>,        \
                                  const FrameForce<D>&, std::span<Vec<D>>);                              \
  template void wallFriction(Context<Backend>&, const MphPairs<D>&, std::span<const Block<D>>,           \
                             std::span<const Vec<D>>, std::span<Vec<D>>);                                \
  template void bulkPressure(Context<Backend>&, const MphPairs<D>&, std::span<const double>,             \
                             std::span<const double>, std::span<double>);                                \
  template void placeSurfaces(Context<Backend>&, const KnownSurfaces<D>&, std::span<const std::uint8_t>, \
                              std::span<WallSurface<D>>);                                                \
  template void viscosityScale(Context<Backend>&, const MphPairs<D>&, double, std::span<double>);        \
  template void renormalisation(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>>);

}  // namespace treacle
