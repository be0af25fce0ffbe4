#pragma once

#include "treacle/core/atomic.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/step/bodies/contacts.hpp"
#include "treacle/step/flow/gas_contact.hpp"
#include "treacle/step/flow/outflow.hpp"
#include "treacle/step/method/buoyancy_terms.hpp"
#include "treacle/step/method/elastic_terms.hpp"
#include "treacle/step/method/first_guess.hpp"
#include "treacle/step/method/freezing_terms.hpp"
#include "treacle/step/method/heat_terms.hpp"
#include "treacle/step/method/move_particles.hpp"
#include "treacle/step/method/set_each.hpp"
#include "treacle/step/method/state_terms.hpp"
#include "treacle/step/readings/balance_sums.hpp"
#include "treacle/step/readings/probe_sums.hpp"
#include "treacle/step/readings/step_change.hpp"
#include "treacle/step/readings/wall_patch.hpp"
#include "treacle/step/walls/wall_motion.hpp"

#include <bit>
#include <functional>

namespace treacle {

// What a step does with each particle by itself, and sums over them, for the sources of both backends, which
// instantiate it. A thread of a device has one particle; there are no atomics but those of the reductions and the
// counts that are made by them.

template <int D, class Backend>
void setWallVelocities(Context<Backend>& context, const MovingWalls<D>& walls, std::span<Vec<D>> velocity) {
  forEach(context, velocity.size(), [=] TREACLE_HD(std::size_t k) {
    velocity[k] = walls.motion[walls.body[k]].velocityAt(walls.position[k]);
  });
}

template <int D, class Backend>
void setWallChords(Context<Backend>& context, const MovingWalls<D>& walls, std::span<Vec<D>> chord) {
  forEach(context, chord.size(),
          [=] TREACLE_HD(std::size_t k) { chord[k] = walls.motion[walls.body[k]].chordAt(walls.position[k]); });
}

template <int D, class Backend>
void addToColumns(Context<Backend>& context, const NozzleColumns<D>& columns, std::span<const std::uint8_t> body,
                  std::span<const Vec<D>> position, std::span<Vec<D>> vector) {
  forEach(context, vector.size(), [=] TREACLE_HD(std::size_t k) {
    if (body[k] == columns.body) vector[k] += columns.each[columns.placeOf(position[k])];
  });
}

template <int D, class Backend>
void shiftColumns(Context<Backend>& context, const CellGrid<D>& grid, const NozzleColumns<D>& columns,
                  std::span<const std::uint8_t> body, std::span<Vec<D>> position) {
  forEach(context, position.size(), [=] TREACLE_HD(std::size_t k) {
    if (body[k] != columns.body) return;
    Vec<D> moved = position[k] + columns.each[columns.placeOf(position[k])];
    grid.wrap(moved);
    position[k] = moved;
  });
}

template <int D, class Backend>
void extrapolate(Context<Backend>& context, const Extrapolation<D>& next, std::span<const Vec<D>> u,
                 FlowMemory<D> memory, std::span<Vec<D>> guess) {
  forEach(context, guess.size(),
          [=] TREACLE_HD(std::size_t i) { guess[i] = next(u[i], memory.acceleration[i], memory.jerk[i]); });
}

template <int D, class Backend>
void updateFlowMemory(Context<Backend>& context, double dt, double lastStep, std::span<const Vec<D>> before,
                      std::span<const Vec<D>> after, FlowMemory<D> memory) {
  forEach(context, after.size(), [=] TREACLE_HD(std::size_t i) {
    const auto r = MotionDerivatives<D>::make(dt, lastStep, before[i], after[i], memory.acceleration[i]);
    memory.acceleration[i] = r.acceleration;
    memory.jerk[i] = r.jerk;
  });
}

/// The largest complement of an index belongs to the first particle, and zero to nobody.
template <int D, class Backend>
std::uint32_t moveParticles(Context<Backend>& context, const CellGrid<D>& grid, double dt,
                            std::span<const Vec<D>> x, std::span<const Vec<D>> u, std::span<Vec<D>> moved) {
  auto* firstOut = static_cast<std::uint32_t*>(context.scratch(sizeof(std::uint32_t)));
  clearValues(context, std::span(firstOut, 1));
  forEach(context, moved.size(), [=] TREACLE_HD(std::size_t i) {
    Vec<D> place;
    if (!moveParticle(grid, dt, x[i], u[i], place)) raiseAtomically(*firstOut, ~static_cast<std::uint32_t>(i));
    moved[i] = place;
  });
  return ~valueOnHost(context, firstOut);
}

template <int D, class Backend>
std::vector<std::uint32_t> markOutflow(Context<Backend>& context, const OutflowTest<D>& test,
                                       std::span<std::uint8_t> gone) {
  std::vector<std::uint32_t> counts(test.regions.size() * maxMaterials);
  auto* sums = static_cast<std::uint32_t*>(context.scratch(counts.size() * sizeof(std::uint32_t)));
  clearValues(context, std::span(sums, counts.size()));
  forEach(context, gone.size(), [=] TREACLE_HD(std::size_t i) {
    const std::uint8_t region = regionOf(test.regions.data(), test.regions.size(), test.position[i]);
    gone[i] = region;
    if (region > 0) addAtomically(sums[(region - 1u) * maxMaterials + test.material[i]], 1);
  });
  copyToHost(context, std::span<const std::uint32_t>(sums, counts.size()), counts.data());
  return counts;
}

template <int D, class Backend>
std::vector<ReserveParticle<D>> findReserves(Context<Backend>& context, std::span<const OpeningForce<D>> openings,
                                             std::span<const Vec<D>> position, std::span<const Vec<D>> velocity,
                                             std::span<const std::uint8_t> gone) {
  Buffer<std::uint32_t, Backend> list(context, position.size());
  std::uint32_t* const particle = list.data();
  const std::uint32_t count = listWhere(
      context, 0, static_cast<std::uint32_t>(position.size()),
      [=] TREACLE_HD(std::uint32_t i) {
        return gone[i] == 0 && openingAt(openings.data(), openings.size(), position[i]) < openings.size();
      },
      particle);
  Buffer<ReserveParticle<D>, Backend> found(context, count);
  ReserveParticle<D>* const to = found.data();
  forEach(context, count, [=] TREACLE_HD(std::size_t k) {
    const Vec<D>& x = position[particle[k]];
    const std::size_t opening = openingAt(openings.data(), openings.size(), x);
    const OpeningForce<D>& o = openings[opening];
    to[k] = {static_cast<std::uint32_t>(opening), o.behind(x), dot(velocity[particle[k]], o.direction), x};
  });
  std::vector<ReserveParticle<D>> particles(count);
  copyToHost(context, std::span<const ReserveParticle<D>>(found), particles.data());
  return particles;
}

template <int D, class Backend>
void straightenTails(Context<Backend>& context, std::span<const OpeningForce<D>> openings,
                     std::span<const Vec<D>> position, std::span<const Vec<D>> u, std::span<Vec<D>> straight) {
  forEach(context, straight.size(), [=] TREACLE_HD(std::size_t i) {
    straight[i] = u[i];
    for (const OpeningForce<D>& o : openings)
      if (o.isInTail(position[i])) straight[i] = dot(u[i], o.direction) * o.direction;
  });
}

template <int D, class Backend>
double openingFlow(Context<Backend>& context, const OpeningForce<D>& opening, std::span<const Vec<D>> position,
                   std::span<const Vec<D>> u) {
  const auto sums = sumEach<1>(context, position.size(), [=] TREACLE_HD(std::size_t i, double* sum) {
    const double rise = opening.rise(position[i]);
    if (rise > 0) sum[0] += rise * dot(u[i], opening.direction);
  });
  return std::pow(opening.spacing, D) * sums[0];
}

template <int D, class Backend>
double meanInReserve(Context<Backend>& context, const OpeningForce<D>& opening, std::span<const Vec<D>> position,
                     std::span<const Vec<D>> vector) {
  const auto sums = sumEach<2>(context, position.size(), [=] TREACLE_HD(std::size_t i, double* to) {
    if (!opening.isInReserve(position[i])) return;
    to[0] += dot(vector[i], opening.direction);
    to[1] += 1;
  });
  return sums[1] > 0 ? sums[0] / sums[1] : 0;
}

template <int D, class Backend>
void addGasForces(Context<Backend>& context, std::span<const GasContact<D>> contacts,
                  std::span<const double> pressure, double volume, std::span<Vec<D>> force) {
  forEach(context, contacts.size(), [=] TREACLE_HD(std::size_t k) {
    const GasContact<D>& c = contacts[k];
    force[c.particle] += (pressure[c.pocket] / volume) * c.area;
  });
}

template <int D, class Backend>
void setOutside(Context<Backend>& context, std::span<const GasContact<D>> contacts,
                std::span<const double> pressure, std::span<double> outside) {
  forEach(context, contacts.size(), [=] TREACLE_HD(std::size_t k) {
    if (contacts[k].isNear()) outside[contacts[k].particle] = pressure[contacts[k].pocket];
  });
}

template <int D, class Backend>
double gasRate(Context<Backend>& context, std::span<const GasContact<D>> contacts, std::uint32_t pocket,
               std::span<const Vec<D>> u) {
  return sumEach<1>(context, contacts.size(), [=] TREACLE_HD(std::size_t k, double* sum) {
    if (contacts[k].pocket == pocket) sum[0] += dot(contacts[k].area, u[contacts[k].particle]);
  })[0];
}

/// What is found is found once more when it is known how many there are.
template <int D, class Backend>
std::vector<Contact<D>> findContacts(Context<Backend>& context, const ContactSearch<D>& search,
                                     std::uint32_t begin, std::uint32_t end) {
  Buffer<std::uint32_t, Backend> list(context, end - begin);
  std::uint32_t* const particle = list.data();
  const std::uint32_t count = listWhere(
      context, begin, end - begin,
      [=] TREACLE_HD(std::uint32_t i) {
        Contact<D> contact;
        return search.find(i, contact);
      },
      particle);
  Buffer<Contact<D>, Backend> found(context, count);
  Contact<D>* const contact = found.data();
  forEach(context, count, [=] TREACLE_HD(std::size_t k) { search.find(particle[k], contact[k]); });
  std::vector<Contact<D>> contacts(count);
  copyToHost(context, std::span<const Contact<D>>(found), contacts.data());
  return contacts;
}

template <class Terms, class Backend>
void setEach(Context<Backend>& context, const Terms& terms, std::size_t count) {
  forEach(context, count, [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <class Backend>
std::array<double, HeatSums::count> sumHeat(Context<Backend>& context, const HeatSums& terms) {
  return sumEach<HeatSums::count>(context, terms.next.size(),
                                  [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); });
}

template <class Backend>
std::array<double, FreezingTerms::count> sumFreezing(Context<Backend>& context, const FreezingTerms& terms) {
  return sumEach<FreezingTerms::count>(context, terms.T.size(),
                                       [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); });
}

template <class Backend>
std::array<double, StateTerms::count> advanceStates(Context<Backend>& context, const StateTerms& terms) {
  return sumEach<StateTerms::count>(context, terms.rate.size(),
                                    [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); });
}

template <int D, class Backend>
void setImplicitViscosity(Context<Backend>& context, const ImplicitViscosity<D>& terms) {
  forEach(context, terms.viscosity.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <int D, class Backend>
void expectStress(Context<Backend>& context, const ExpectedStress<D>& terms) {
  forEach(context, terms.carried.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <int D, class Backend>
double advanceModes(Context<Backend>& context, const AdvancedModes<D>& terms) {
  return sumEach<1>(context, terms.state.material.size(),
                    [=] TREACLE_HD(std::size_t i, double* sum) { terms.add(i, sum); })[0];
}

template <int D, class Backend>
std::array<double, PowerTerms<D>::count> sumPowers(Context<Backend>& context, const PowerTerms<D>& terms,
                                                   std::size_t active) {
  return sumEach<PowerTerms<D>::count>(context, active, [=] TREACLE_HD(std::size_t i, double* sums) {
    if (i < terms.ownFluid || i >= terms.fluidCount) terms.add(i, sums);
  });
}

template <int D, class Backend>
PartSums sumPart(Context<Backend>& context, const PartTerms<D>& terms) {
  return std::bit_cast<PartSums>(sumEach<PartSums::count>(
      context, terms.position.size(), [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); }));
}

template <int D, class Backend>
double patchPressure(Context<Backend>& context, const PatchTerms<D>& terms) {
  using Terms = PatchTerms<D>;
  const auto sums = sumEach<Terms::count>(context, terms.body.size(),
                                          [=] TREACLE_HD(std::size_t i, double* to) { terms.add(i, to); });
  if (sums[Terms::Shares] == 0) return std::numeric_limits<double>::quiet_NaN();
  double into = 0;
  for (int k = 0; k < D; ++k) into += sums[Terms::Force + k] * terms.patch.normal[k];
  return std::copysign(into, into * sums[Terms::Side]) * std::pow(terms.patch.spacing, D) / terms.patch.area();
}

template <int D, class Backend>
StepChange stepChange(Context<Backend>& context, const StepChangeTerms<D>& terms) {
  const auto all = sumEach<StepChangeTerms<D>::count>(
      context, terms.after.size(), [=] TREACLE_HD(std::size_t i, double* sums) { terms.add(i, sums); });
  return StepChange::mean(all, joinedOverProcesses(context, terms.after.size(), std::plus<>()));
}

#define TREACLE_EACH_PARTICLE(D, Backend)                                                                        \
  template void setWallVelocities(Context<Backend>&, const MovingWalls<D>&, std::span<Vec<D>>);                  \
  template void setWallChords(Context<Backend>&, const MovingWalls<D>&, std::span<Vec<D>>);                      \
  template void addToColumns(Context<Backend>&, const NozzleColumns<D>&, std::span<const std::uint8_t>,          \
                             std::span<const Vec<D>>, std::span<Vec<D>>);                                        \
  template void shiftColumns(Context<Backend>&, const CellGrid<D>&, const NozzleColumns<D>&,                     \
                             std::span<const std::uint8_t>, std::span<Vec<D>>);                                  \
  template void extrapolate(Context<Backend>&, const Extrapolation<D>&, std::span<const Vec<D>>, FlowMemory<D>,  \
                            std::span<Vec<D>>);                                                                  \
  template void updateFlowMemory(Context<Backend>&, double, double, std::span<const Vec<D>>,                     \
                                 std::span<const Vec<D>>, FlowMemory<D>);                                        \
  template std::uint32_t moveParticles(Context<Backend>&, const CellGrid<D>&, double, std::span<const Vec<D>>,   \
                                       std::span<const Vec<D>>, std::span<Vec<D>>);                              \
  template std::vector<std::uint32_t> markOutflow(Context<Backend>&, const OutflowTest<D>&,                      \
                                                  std::span<std::uint8_t>);                                      \
  template std::vector<ReserveParticle<D>> findReserves(Context<Backend>&, std::span<const OpeningForce<D>>,     \
                                                        std::span<const Vec<D>>, std::span<const Vec<D>>,        \
                                                        std::span<const std::uint8_t>);                          \
  template void straightenTails(Context<Backend>&, std::span<const OpeningForce<D>>, std::span<const Vec<D>>,    \
                                std::span<const Vec<D>>, std::span<Vec<D>>);                                     \
  template double openingFlow(Context<Backend>&, const OpeningForce<D>&, std::span<const Vec<D>>,                \
                              std::span<const Vec<D>>);                                                          \
  template double meanInReserve(Context<Backend>&, const OpeningForce<D>&, std::span<const Vec<D>>,              \
                                std::span<const Vec<D>>);                                                        \
  template void addGasForces(Context<Backend>&, std::span<const GasContact<D>>, std::span<const double>, double, \
                             std::span<Vec<D>>);                                                                 \
  template void setOutside(Context<Backend>&, std::span<const GasContact<D>>, std::span<const double>,           \
                           std::span<double>);                                                                   \
  template double gasRate(Context<Backend>&, std::span<const GasContact<D>>, std::uint32_t,                      \
                          std::span<const Vec<D>>);                                                              \
  template std::vector<Contact<D>> findContacts(Context<Backend>&, const ContactSearch<D>&, std::uint32_t,       \
                                                std::uint32_t);                                                  \
  template void setImplicitViscosity(Context<Backend>&, const ImplicitViscosity<D>&);                            \
  template void expectStress(Context<Backend>&, const ExpectedStress<D>&);                                       \
  template double advanceModes(Context<Backend>&, const AdvancedModes<D>&);                                      \
  template std::array<double, PowerTerms<D>::count> sumPowers(Context<Backend>&, const PowerTerms<D>&,           \
                                                              std::size_t);                                      \
  template PartSums sumPart(Context<Backend>&, const PartTerms<D>&);                                             \
  template double patchPressure(Context<Backend>&, const PatchTerms<D>&);                                        \
  template StepChange stepChange(Context<Backend>&, const StepChangeTerms<D>&);
#define TREACLE_EACH_TEMPERATURE(Backend)                                                                 \
  template void setEach(Context<Backend>&, const AddBuoyancy<2>&, std::size_t);                           \
  template void setEach(Context<Backend>&, const AddBuoyancy<3>&, std::size_t);                           \
  template void setEach(Context<Backend>&, const HeatSystemTerms&, std::size_t);                          \
  template void setEach(Context<Backend>&, const Sum&, std::size_t);                                      \
  template void setEach(Context<Backend>&, const Difference&, std::size_t);                               \
  template void setEach(Context<Backend>&, const Slowness&, std::size_t);                                 \
  template void setEach(Context<Backend>&, const Scaled&, std::size_t);                                   \
  template void setEach(Context<Backend>&, const HeatResult&, std::size_t);                               \
  template void setEach(Context<Backend>&, const ConductivityTerms&, std::size_t);                        \
  template void setEach(Context<Backend>&, const FreezingUpdate&, std::size_t);                           \
  template void setEach(Context<Backend>&, const FreezingResult&, std::size_t);                           \
  template std::array<double, FreezingTerms::count> sumFreezing(Context<Backend>&, const FreezingTerms&); \
  template std::array<double, HeatSums::count> sumHeat(Context<Backend>&, const HeatSums&);               \
  template std::array<double, StateTerms::count> advanceStates(Context<Backend>&, const StateTerms&);

}  // namespace treacle
