"""The fluid of a simulation."""

from __future__ import annotations

from typing import Any, Union

import numpy as np

from . import _treacle
from ._arrays import DeviceArray, given_array
from ._toml import override_texts, quoted
from .errors import InputError

Array = Union[np.ndarray, DeviceArray]
"""A copy in NumPy where the CPU computes; the field itself, in the GPU's memory, where that does."""


class Fluid:
    """The particles of the fluid: n of them in D dimensions.

    Where the CPU computes, reading a field gives a copy of it as an array of NumPy's, which stays what it is. On the
    GPU it gives the field itself (`DeviceArray`), which holds until the next step. Particles stand in the order that
    the search likes, which changes with every step; `ids` names them for good.

    Positions, velocities, viscosities and temperatures can be assigned between steps: from an array of the same shape
    in the present order, of NumPy or anything with DLPack, on the host or on the GPU that computes, or from one number
    or row for all. The flow then has no memory of earlier steps, and the watch begins anew. Pressures and number
    densities stay those of the last step until the next one.
    """

    def __init__(self, session: _treacle.Session) -> None:
        self._session = session

    def __len__(self) -> int:
        return self._session.fluid_count

    def __repr__(self) -> str:
        return f"Fluid({len(self)} particles in {self._session.dimensions} dimensions)"

    def _field(self, name: str) -> Array:
        if self._session.on_device:
            return DeviceArray(self._session, name)
        copied: np.ndarray = self._session.copied_field(name)
        return copied

    def _field_of_some(self, name: str) -> Array | None:
        if self._session.field_address(name)[0] == 0:
            return None
        return self._field(name)

    @property
    def positions(self) -> Array:
        """(n, D) [m]. Errors of assignment: InputError for places outside the domain; periodic ones bring them back."""
        return self._field("positions")

    @positions.setter
    def positions(self, values: Any) -> None:
        self.set(positions=values)

    @property
    def velocities(self) -> Array:
        """(n, D) [m/s]. Errors of assignment: InputError for numbers that are not finite."""
        return self._field("velocities")

    @velocities.setter
    def velocities(self, values: Any) -> None:
        self.set(velocities=values)

    @property
    def temperatures(self) -> Array | None:
        """(n,) [K]; None in cases without heat. Errors of assignment: InputError there, and for others than positive."""
        return self._field_of_some("temperatures")

    @temperatures.setter
    def temperatures(self, values: Any) -> None:
        self.set(temperatures=values)

    @property
    def viscosities(self) -> np.ndarray:
        """(n,) a copy on the host [Pa s]: of shear rates and temperatures where materials have a rheology or follow them.

        A fluid has the viscosity of its material: an assigned array has one value per material, for which
        `Simulation.change` makes it go on with other constants. Errors: InputError for values that differ within a
        material, are negative, or are those of a rheology or of a viscosity that follows the temperature.
        """
        copied: np.ndarray = self._session.viscosities
        return copied

    @viscosities.setter
    def viscosities(self, values: Any) -> None:
        given = _expanded(given_array(_on_host(values), "viscosities"), (len(self),), "viscosities")
        if self._session.has_own_viscosities:
            raise InputError(
                "viscosities: they follow from shear rates and temperatures in this case; expected one without a "
                "rheology and without a viscosity that follows the temperature"
            )
        materials = np.asarray(self._session.copied_field("materials"))
        changes = {}
        for number, name in enumerate(self._session.material_names):
            of_material = given[materials == number]
            if len(of_material) == 0:
                continue
            if not (of_material == of_material[0]).all():
                raise InputError(
                    f"viscosities: expected one value for all particles of material '{name}', found "
                    f"{of_material.min():g} to {of_material.max():g}: a fluid has the viscosity of its material"
                )
            changes[f"material.{quoted(name)}.dynamic_viscosity"] = float(of_material[0])
        self._session.change(_treacle.parse_case(self._session.case_text, override_texts(changes)))

    @property
    def pressures(self) -> Array:
        """(n,) [Pa], of the last step."""
        return self._field("pressures")

    @property
    def number_densities(self) -> Array:
        """(n,) [-], of the last step."""
        return self._field("number_densities")

    @property
    def shear_rates(self) -> Array | None:
        """(n,) [1/s], of the last step; None in cases whose viscosities do not follow them."""
        return self._field_of_some("shear_rates")

    @property
    def materials(self) -> Array:
        """(n,) indices into `Simulation.materials`."""
        return self._field("materials")

    @property
    def bodies(self) -> Array:
        """(n,) indices into `Simulation.bodies`: the body that a particle started in, or came from."""
        return self._field("bodies")

    @property
    def ids(self) -> Array:
        """(n,) names that particles keep for good."""
        return self._field("ids")

    def set(self, *, positions: Any = None, velocities: Any = None, temperatures: Any = None) -> None:
        """Assigns several fields at once: all of them or, with InputError, none."""
        n, d = len(self), self._session.dimensions
        given = [
            _expanded(given_array(values, what), shape, what)
            for values, shape, what in (
                (positions, (n, d), "positions"),
                (velocities, (n, d), "velocities"),
                (temperatures, (n,), "temperatures"),
            )
        ]
        self._session.give_fluid(*given)


def _expanded(values: Any, shape: tuple[int, ...], what: str) -> Any:
    """Of that shape; one number or row of NumPy's is that of all particles."""
    if values is None or tuple(values.shape) == shape:
        return values
    if isinstance(values, np.ndarray) and values.shape in ((), shape[1:]):
        return np.ascontiguousarray(np.broadcast_to(values, shape))
    raise InputError(f"{what}: expected an array of shape {shape}, found {tuple(values.shape)}")


def _on_host(values: Any) -> Any:
    if isinstance(values, DeviceArray) or not hasattr(values, "__dlpack_device__"):
        return np.asarray(values)
    if values.__dlpack_device__()[0] == 1:
        return values
    raise InputError("viscosities: expected an array in the memory of the host")
