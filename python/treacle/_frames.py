"""Particles at one instant, as files hold them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _treacle


@dataclass(frozen=True)
class Frame:
    """One group of particles, fluid or walls, at one instant, in the order of their ids.

    n is the number of particles, D that of dimensions. Fields that a file does not hold are None.
    """

    time: float
    """[s]"""
    dimensions: int
    positions: NDArray[np.float64]
    """(n, D) [m]"""
    velocities: NDArray[np.float64] | None
    """(n, D) [m/s]"""
    pressures: NDArray[np.float64] | None
    """(n,) [Pa]"""
    number_densities: NDArray[np.float64] | None
    """(n,) [-]"""
    nearest_distances: NDArray[np.float64] | None
    """(n,) to the nearest other particle, over the spacing [-]; of fluid"""
    viscosities: NDArray[np.float64] | None
    """(n,) [Pa s]; of fluid where particles have their own"""
    shear_rates: NDArray[np.float64] | None
    """(n,) [1/s]; likewise"""
    temperatures: NDArray[np.float64] | None
    """(n,) [K]; of fluid in cases with heat"""
    viscosity_factors: NDArray[np.float64] | None
    """(n,) [-]; of fluid where particles have them"""
    states: dict[str, NDArray[np.float64]]
    """By name, (n,) of each state of the materials; of fluid"""
    materials: NDArray[np.int32] | None
    """(n,) indices into the materials of the case"""
    bodies: NDArray[np.int32] | None
    """(n,) indices into the bodies of the case"""
    ids: NDArray[np.uint32] | None
    """(n,) names that particles keep for good"""

    def __len__(self) -> int:
        return len(self.positions)


def frame_of(time: float, dimensions: int, arrays: dict[str, Any]) -> Frame:
    return Frame(
        time=time,
        dimensions=dimensions,
        positions=arrays["position"],
        velocities=arrays["velocity"],
        pressures=arrays["pressure"],
        number_densities=arrays["number_density"],
        nearest_distances=arrays["nearest_distance"],
        viscosities=arrays["dynamic_viscosity"],
        shear_rates=arrays["shear_rate"],
        temperatures=arrays["temperature"],
        viscosity_factors=arrays["viscosity_factor"],
        states=arrays["states"],
        materials=arrays["material"],
        bodies=arrays["body"],
        ids=arrays["id"],
    )


def read_frame(path: str | os.PathLike[str]) -> Frame:
    """Reads a frame of `treacle run` or `Simulation.write_frame` (.vtp, .pvtp).

    Errors: InputError for a file that is missing, foreign or damaged.
    """
    return frame_of(*_treacle.read_frame(os.fspath(path)))
