#pragma once

#include "session.hpp"

#include <nanobind/nanobind.h>

#include <cstdint>
#include <optional>

/// Every function of the module that takes a session uses it alone, from here to its end. Errors: those of
/// Session::Use.
template <>
struct nanobind::detail::type_caster<treacle::Session> : type_caster_base<treacle::Session> {
  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) {
    if (!type_caster_base::from_python(source, flags, cleanup)) return false;
    if (const treacle::Session* session = *this) use_.emplace(*session);
    return true;
  }

 private:
  std::optional<treacle::Session::Use> use_;
};
