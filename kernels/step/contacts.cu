#include "treacle/step/bodies/contacts.hpp"

#include "core/launch.hpp"
#include "core/list_where.cuh"
#include "treacle/core/copy_values.hpp"

namespace treacle {

/// One thread per wall particle, and another per contact, which finds it once more; reads the walls around its
/// particle, writes the contact; atomics no.
template <int D>
std::vector<Contact<D>> findContacts(Context<Cuda>& context, const ContactSearch<D>& search, std::uint32_t begin,
                                     std::uint32_t end) {
  Buffer<std::uint32_t, Cuda> particle(context, end - begin);
  const std::uint32_t count = listWhere(
      context, begin, end - begin,
      [search] __device__(std::uint32_t i) {
        Contact<D> contact;
        return search.find(i, contact);
      },
      particle.data());
  Buffer<Contact<D>, Cuda> found(context, count);
  forEach(context, count, [search, particle = particle.data(), found = found.data()] __device__(std::size_t k) {
    Contact<D> contact;
    search.find(particle[k], contact);
    found[k] = contact;
  });
  std::vector<Contact<D>> contacts(count);
  if (count > 0) copyToHost(context, std::span<const Contact<D>>(found), contacts.data());
  return contacts;
}

template std::vector<Contact<2>> findContacts(Context<Cuda>&, const ContactSearch<2>&, std::uint32_t,
                                              std::uint32_t);
template std::vector<Contact<3>> findContacts(Context<Cuda>&, const ContactSearch<3>&, std::uint32_t,
                                              std::uint32_t);

}  // namespace treacle
