#pragma once

#include "run/flow_state.hpp"
#include "treacle/search/sorted_particles.hpp"
#include "treacle/step/bodies/contacts.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace treacle {

/// The contacts of rigid bodies in a step, those of all processes at each of them, in the order of particles' ids.
/// On the cells of the step. `surface`: of the active walls, as they are; empty: not known. Collective.
template <int D, class Backend>
std::vector<Contact<D>> rigidContacts(FlowState<D, Backend>& state, const SortedParticles<D>& sorted,
                                      std::span<const WallSurface<D>> surface) {
  const Particles<D, Backend>& p = state.particles;
  const ContactSearch<D> search{
      sorted.grid,       sorted.cells,         p.position.data(),
      p.body.data(),     p.id.data(),          surface.empty() ? nullptr : surface.data(),
      sorted.fluidCount, rigidBodies(p.rigid), sorted.spacing};
  std::vector<Contact<D>> contacts = findContacts<D>(state.context, search, sorted.fluidCount, sorted.ownEnd());
  if (const Communicator* processes = state.context.communicator) {
    const auto parts = processes->swap(std::vector(static_cast<std::size_t>(processes->size()), contacts));
    contacts.clear();
    for (const auto& part : parts) contacts.insert(contacts.end(), part.begin(), part.end());
  }
  std::ranges::sort(contacts, {}, &Contact<D>::id);
  return contacts;
}

}  // namespace treacle
