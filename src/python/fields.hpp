#pragma once

#include "session.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>

namespace treacle {

/// Whether the fluid has a field. Names are those of FluidField, in Python's plural. Errors: InputError for
/// others.
bool hasField(const Session& session, const std::string& name);

/// A copy of a field of the fluid as an array of NumPy's; None where the fluid does not have it.
nanobind::object copiedField(const Session& session, const std::string& name);

/// The field where it lies, by DLPack; `owner`, which keeps the session, lives as long as the array.
nanobind::object fieldInPlace(const Session& session, const std::string& name, nanobind::handle owner);

/// (address, shape, type as in __cuda_array_interface__) of the same.
nanobind::tuple fieldAddress(const Session& session, const std::string& name);

/// Numbers in the memory of the host or of the device, each None or an array of doubles in the order of C; of
/// states by name.
void giveFluid(Session& session, const nanobind::object& positions, const nanobind::object& velocities,
               const nanobind::object& temperatures, const nanobind::object& viscosityFactors,
               const nanobind::typed<nanobind::dict, nanobind::str, nanobind::object>& states);

/// Name, copied array of every field of walls, in the order of their ids.
nanobind::dict arraysOf(const Frame& frame);

}  // namespace treacle
