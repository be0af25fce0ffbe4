"""Highly viscous, incompressible free-surface flow by particles, on CPU and GPU.

import treacle
sim = treacle.Simulation.from_file("case.toml", backend="auto", resolution=2)
sim.run()
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

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

if TYPE_CHECKING or find_spec("._treacle", __name__):
    from . import _treacle as _treacle
    from . import cases
    from ._arrays import DeviceArray
    from ._fluid import Fluid
    from ._frames import Frame, read_frame
    from ._simulation import Simulation
    from ._treacle import StepReport
    from ._treacle import version as __version__
    from .cases import Case
    from .errors import InputError, RunError, SimulationWarning

else:  # treacle's sources as they are: films, reports and imports need nothing that is compiled

    def __getattr__(name: str) -> None:
        if name not in __all__:
            raise AttributeError(f"module 'treacle' has no attribute '{name}'")
        raise ImportError(
            f"treacle.{name} needs the compiled part of the package, which treacle.movie, treacle.report, treacle.plot "
            "and treacle.import_case do without; expected `pip install .` in treacle's sources, or build/PRESET/python "
            "of a build with -DTREACLE_PYTHON=ON in PYTHONPATH"
        )
