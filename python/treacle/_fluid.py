"""The fluid of a simulation."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _treacle
from ._arguments import KnownNames
from ._arrays import DeviceArray, given_array
from ._toml import override_texts, quoted
from .errors import InputError

Array = NDArray[Any] | DeviceArray
"""A copy in NumPy where the CPU computes; the field itself, in the GPU's memory, where that does."""


class Fluid(KnownNames):
    """The particles of the fluid: n of them in D dimensions.

    Where the CPU computes, reading a field gives a copy of it as an array of NumPy's, which stays what it is. On the
    GPU it gives the field itself (`DeviceArray`), which holds until the next step. Particles stand in the order that
    the search likes, which changes with every step; `ids` names them for good.

    Positions, velocities, viscosities (or their factors), temperatures and states can be assigned between steps: from an array
    of the same shape in the present order, of NumPy or anything with DLPack, on the host or on the GPU that computes,
    or from one number or row for all. After other positions or velocities the flow has no memory of earlier steps, and
    the watch begins anew. Pressures and number densities stay those of the last step until the next one.
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
        copied: NDArray[Any] = self._session.copied_field(name)
        return copied

    def _field_of_some(self, name: str) -> Array | None:
        return self._field(name) if self._session.has_field(name) else None

    @property
    def positions(self) -> Array:
        """(n, D) [m]. Errors of assignment: InputError for places outside the domain; periodic ones bring them back."""
        return self._field("positions")

    @positions.setter
    def positions(self, values: Any) -> None:
        self._assign("positions", values)

    @property
    def velocities(self) -> Array:
        """(n, D) [m/s]. Errors of assignment: InputError for numbers that are not finite."""
        return self._field("velocities")

    @velocities.setter
    def velocities(self, values: Any) -> None:
        self._assign("velocities", values)

    @property
    def temperatures(self) -> Array | None:
        """(n,) [K]; None in cases without heat. Errors of assignment: InputError there, and for others than positive."""
        return self._field_of_some("temperatures")

    @temperatures.setter
    def temperatures(self, values: Any) -> None:
        self._assign("temperatures", values)

    @property
    def viscosities(self) -> NDArray[np.float64]:
        """(n,) a copy on the host [Pa s]: of shear rates, temperatures and factors where the case has them.

        Particles keep what is assigned until it is assigned again, by factors to the viscosities of their materials
        (`viscosity_factors`). One value per material, where there are no factors, makes the material another one, as
        `Simulation.change` does. Errors of assignment: InputError for others than positive numbers on the host, where
        a material has a rheology or a viscosity that follows the temperature, and with ISPH for values that differ
        within a material.
        """
        copied: NDArray[np.float64] = self._session.viscosities
        return copied

    @viscosities.setter
    def viscosities(self, values: Any) -> None:
        given = _expanded(given_array(_on_host(values), "viscosities"), (len(self),), "viscosities")
        materials = np.asarray(self._session.copied_field("materials"))
        own = np.array(self._session.newtonian_viscosities)
        if (own[materials] <= 0).any():
            name = self._session.material_names[materials[own[materials] <= 0][0]]
            raise InputError(
                f"viscosities: that of material '{name}' follows from shear rates or temperatures, or is 0; its "
                "viscosity_factors can be assigned"
            )
        if not (np.isfinite(given) & (given > 0)).all():
            raise InputError(f"viscosities: expected positive numbers [Pa s], found {given.min():g}")
        kinds = {int(m): np.unique(given[materials == m]) for m in np.unique(materials)}
        if self.viscosity_factors is None and all(len(values) == 1 for values in kinds.values()):
            names = self._session.material_names
            changes = {f"material.{quoted(names[m])}.dynamic_viscosity": float(v[0]) for m, v in kinds.items()}
            self._session.change(_treacle.parse_case(self._session.case_text, override_texts(changes)))
        else:
            self.viscosity_factors = given / own[materials]

    @property
    def viscosity_factors(self) -> Array | None:
        """(n,) by what the viscosities of the materials are multiplied [-]; None where all are 1 for good.

        Assigning them where there are none gives the fluid such a field. Errors of assignment: InputError for others
        than positive numbers, and with ISPH.
        """
        return self._field_of_some("viscosity_factors")

    @viscosity_factors.setter
    def viscosity_factors(self, values: Any) -> None:
        self._assign("viscosity_factors", values)

    @property
    def states(self) -> dict[str, Array]:
        """By name, (n,) of each state of the case's materials; 0 of particles whose material does not have it.

        `set(states={...})` assigns some of them.
        """
        return {name: self._field(f"state:{name}") for name in self._session.state_names}

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

    def _assign(self, name: str, values: Any) -> None:
        if values is None:
            raise InputError(f"{name}: expected an array of numbers, found None")
        self.set(**{name: values})

    def set(
        self,
        *,
        positions: Any = None,
        velocities: Any = None,
        temperatures: Any = None,
        viscosity_factors: Any = None,
        states: dict[str, Any] | None = None,
    ) -> None:
        """Assigns several fields at once: all of them or, with InputError, none.

        `states`: by name, those of materials that are to change.
        """
        n, d = len(self), self._session.dimensions
        given = [
            _expanded(given_array(values, what), shape, what)
            for values, shape, what in (
                (positions, (n, d), "positions"),
                (velocities, (n, d), "velocities"),
                (temperatures, (n,), "temperatures"),
                (viscosity_factors, (n,), "viscosity_factors"),
            )
        ]
        of_states = {
            name: _expanded(given_array(values, f"states[{name!r}]"), (n,), f"states[{name!r}]")
            for name, values in (states or {}).items()
        }
        x, u, warm, factors = given
        self._session.give_fluid(x, u, warm, factors, of_states)


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
