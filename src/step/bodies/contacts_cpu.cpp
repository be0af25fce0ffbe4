#include "treacle/step/bodies/contacts.hpp"

namespace treacle {

template <int D>
std::vector<Contact<D>> findContacts(Context<Cpu>&, const ContactSearch<D>& search, std::uint32_t begin,
                                     std::uint32_t end) {
  std::vector<Contact<D>> contacts;
  for (std::uint32_t i = begin; i < end; ++i)
    if (Contact<D> contact; search.find(i, contact)) contacts.push_back(contact);
  return contacts;
}

template std::vector<Contact<2>> findContacts(Context<Cpu>&, const ContactSearch<2>&, std::uint32_t,
                                              std::uint32_t);
template std::vector<Contact<3>> findContacts(Context<Cpu>&, const ContactSearch<3>&, std::uint32_t,
                                              std::uint32_t);

}  // namespace treacle
