"""Highly viscous, incompressible free-surface flow by particles, on CPU and GPU.

import treacle
sim = treacle.Simulation.from_file("case.toml", backend="auto", resolution=2)
sim.run()
"""

from __future__ import annotations

try:
    from . import _treacle as _treacle
except ImportError as error:
    if "libcusparse" not in str(error):
        raise
    raise ImportError(
        f"{error}: this treacle computes on GPUs and needs NVIDIA's cuSPARSE; expected that of the CUDA toolkit in the "
        "search path of libraries, or `pip install nvidia-cusparse` (CUDA 13) or nvidia-cusparse-cu12 (CUDA 12)"
    ) from None

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
