"""Highly viscous, incompressible free-surface flow by particles, on CPU and GPU.

import treacle
sim = treacle.Simulation.from_file("case.toml", backend="auto", resolution=2)
sim.run()
"""

from __future__ import annotations

from . import cases
from ._arrays import DeviceArray
from ._fluid import Fluid
from ._frames import Frame, read_frame
from ._simulation import Simulation
from ._treacle import StepReport
from ._treacle import version as __version__
from .cases import Case
from .errors import InputError, RunError, SimulationWarning

__all__ = [
    "Case",
    "DeviceArray",
    "Fluid",
    "Frame",
    "InputError",
    "RunError",
    "Simulation",
    "SimulationWarning",
    "StepReport",
    "__version__",
    "cases",
    "read_frame",
]
