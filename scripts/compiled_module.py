"""The compiled module of the package, for the scripts that write files of the package from it."""

import importlib
import sys
from pathlib import Path
from types import ModuleType


def native() -> ModuleType:
    """The module without the package around it, which needs what these scripts write. Ends the script where there is none."""
    sys.path[:0] = [str(Path(folder, "treacle")) for folder in sys.path]
    try:
        return importlib.import_module("_treacle")
    except ImportError:
        script = Path(sys.argv[0]).name
        sys.exit(f"{script}: treacle/_treacle is not in PYTHONPATH; expected build/PRESET/python there")
