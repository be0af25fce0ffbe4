#include "treacle/method/neighbourhood.hpp"

#include <algorithm>

namespace treacle {

template <int D>
Neighbourhood<D>::Neighbourhood(const Case& c) {
  Vec<D, bool> periodic{};
  for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[k];
  const double hp = c.pressureRadius(), hv = c.viscosityRadius();
  pairs_.grid =
      CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, std::max(hv, 2 * hp));
  pairs_.images = periodicImages(pairs_.grid);
  pairs_.pressureWeight = Weight<D>::make(hp, c.spacing);
  pairs_.viscosityWeight = Weight<D>::make(hv, c.spacing);
  pairs_.pressure = PairTerm::pressure(pairs_.pressureWeight);
  pairs_.viscosity = PairTerm::viscosity(pairs_.viscosityWeight);
  pairs_.materials = MaterialTable::make(c);
  pairs_.fluidList = &fluidList_;
  pairs_.wallList = &wallList_;
}

template <int D>
void Neighbourhood<D>::sort(Context<Cpu>& context, Particles<D>& particles) {
  sortByCell(context, pairs_.grid, particles, ranges_, workspace_);
}

template <int D>
void Neighbourhood<D>::buildLists(Context<Cpu>& context, const Particles<D>& particles) {
  pairs_.fluidCount = particles.fluidCount;
  pairs_.activeCount = ranges_.activeCount;
  pairs_.position = particles.position;
  pairs_.material = particles.material;
  const double hp = pairs_.pressureWeight.radius, hv = pairs_.viscosityWeight.radius;
  buildClusterList<D>(context, pairs_.grid, ranges_, pairs_.position, 0, pairs_.fluidCount,
                      {hp, std::max(hv, 2 * hp)}, false, fluidList_);
  buildClusterList<D>(context, pairs_.grid, ranges_, pairs_.position, pairs_.fluidCount, pairs_.activeCount,
                      {hp, 0}, true, wallList_);
}

template <int D>
std::size_t Neighbourhood<D>::bytes() const {
  return ranges_.bytes() + workspace_.keyed.bytes() + workspace_.field.bytes() + workspace_.hasFluid.bytes() +
         fluidList_.bytes() + wallList_.bytes();
}

template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace treacle
