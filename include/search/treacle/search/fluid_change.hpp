#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Takes out the own fluid particles that are marked, `gone` != 0, with all their fields, and puts those of
/// `added`, which are on the host and fluid alone, behind the others, which keep their order. `gone`: per own
/// fluid particle, in the backend's memory; empty: all stay. Ghosts are gone afterwards. New particles have no
/// memory of an earlier flow, and zero in the modes. Errors: std::bad_alloc.
template <int D, class Backend>
void changeFluid(Context<Backend>&, std::span<const std::uint8_t> gone, const Particles<D>& added,
                 Particles<D, Backend>& particles);

}  // namespace treacle
