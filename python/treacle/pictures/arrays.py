"""Types that films, reports and curves share."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Floats = NDArray[np.float64]
Table = dict[str, Floats]
"""Columns by name, as those of history.csv."""
Place = tuple[float, float]
"""In a picture [px]."""
