"""What a validation study is: one case file, run at several resolutions and held against an exact or published solution."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

cases = Path(__file__).parent / "cases"
usual_order, small = 0.9, 0.01  # least observed order, and the error from which on none is asked for


@dataclass
class Outcome:
    """What one run gave. errors: relative to the exact solution's size; values: measured numbers worth a column, with their
    unit in the name; curves: for the picture, name to (x, y); exact: likewise for the exact solution."""

    errors: dict
    values: dict = field(default_factory=dict)
    curves: dict = field(default_factory=dict)
    exact: dict = field(default_factory=dict)


@dataclass
class Level:
    """One run of a study: the resolution of the case file, further overrides, and what tables call these."""

    resolution: float
    settings: tuple = ()
    name: str = ""

    @property
    def label(self):
        return f"x{self.resolution:g} " + self.name if self.name else " ".join([f"x{self.resolution:g}", *self.settings])


def spacing_of(level):
    """Over that of the case file."""
    return 1 / level.resolution


@dataclass
class Study:
    """levels: from coarse to fine; the first, and the second where it takes little time, are what continuous integration runs. bars:
    largest error allowed at the first, and at the second where it has orders, by the names of Outcome.errors; every bar must be met,
    whatever the scheme; published: those of them that are others for the scheme of that name, which does not converge. orders: least
    observed order from the first level to the second of the errors for which it is not usual_order; only the accurate scheme is judged
    by orders, and only until an error is small. ranges: by the scheme of the case, least and largest of Outcome.values at the first
    level: where a scheme itself is off by more than a wrong constant would be, a bar alone would let that pass. They say what this
    scheme gives, not what is right, so better physics need a scheme of their own. measure: takes a Run (treacle_data) to an Outcome.
    size: what orders are counted in, a function of the level; particle spacing unless told. refined: false where
    levels are other flows, so that there are no orders."""

    name: str
    title: str
    levels: list
    bars: dict
    measure: Callable
    x_label: str
    y_label: str
    settings: tuple = ()
    published: dict = field(default_factory=dict)
    orders: dict = field(default_factory=dict)
    ranges: dict = field(default_factory=dict)
    case: str = ""
    size: Callable = spacing_of
    refined: bool = True

    @property
    def case_file(self):
        return cases / (self.case or self.name + ".toml")

    def bars_of(self, scheme):
        return self.bars | self.published if scheme == "published" else self.bars

    def orders_of(self, scheme):
        if scheme != "accurate" or not self.refined:
            return {}
        return {name: self.orders.get(name, usual_order) for name in self.bars}

    def ranges_of(self, scheme):
        """None where the study has ranges, but says nothing of this scheme; where the bars are enough for it, it says {}."""
        return self.ranges.get(scheme) if self.ranges else {}


def scheme_in(text):
    """[method] scheme in the text of a case; a case without one is by the accurate scheme, one of ISPH by "isph"."""
    method = text.partition("\n[method]\n")[2].partition("\n[")[0]

    def word(key, default):
        return (re.search(rf'^{key} *= *"([^"]*)"', method, re.MULTILINE) or (None, default))[1]

    return "isph" if word("name", "mph-i") == "isph" else word("scheme", "accurate")


def order(error_coarse, error_fine, size_coarse, size_fine):
    """Observed order of convergence between two runs; None where an error is zero."""
    if not (error_coarse > 0 and error_fine > 0):
        return None
    return math.log(error_coarse / error_fine) / math.log(size_coarse / size_fine)
