#include "treacle/mph/particle_viscosity.hpp"

#include "core/launch.hpp"
#include "core/reduce_many.cuh"

namespace treacle {

/// One thread per fluid particle; reads its material, rate and share, writes its viscosities. No atomics.
void setViscosities(Context<Cuda>& context, const ViscosityTerms& terms) {
  forEach(context, terms.rate.size(), [terms] __device__(std::size_t i) { terms.set(i); });
}

/// One thread per active particle; reads its material and viscosity, writes its class. No atomics.
void setClasses(Context<Cuda>& context, const ClassTerms& terms) {
  forEach(context, terms.kind.size(), [terms] __device__(std::size_t i) { terms.set(i); });
}

/// By reduceMany: one thread per fluid particle, grid-stride; reads its rates, writes the next one and two sums.
double nextRates(Context<Cuda>& context, const RateTerms& terms) {
  constexpr int count = RateTerms::count;
  using Sums = std::array<double, count>;
  auto* result = static_cast<double*>(context.scratch(sizeof(Sums)));
  reduceMany<count>(
      context, terms.found.size(), [terms] __device__(std::size_t i, double* sums) { terms.add(i, sums); },
      [result] __device__(const double* sums, int lane) {
        if (lane < count) result[lane] = sums[lane];
      });
  return RateTerms::change(valueOnHost(context, reinterpret_cast<const Sums*>(result)));
}

}  // namespace treacle
