#!/usr/bin/env python3
"""Reference for the gravity currents: the thin-film (lubrication) equation from the box in which the fluid begins.

    thin_film.py --out thin_film.json    # half a minute

The similarity solutions of [Huppert 1982] hold when a current has forgotten its first shape, that is late. At a finite time
these solutions stand in their place:

    h_t = (g / 3 nu) r^-n (r^n h^3 h_r)_r,  n = 0 for the plane current and 1 for the axisymmetric one,

with h = H up to r = R, and 0 beyond it, at t = 0. Since h^3 h_r = (h^4 / 4)_r the fluxes between cells are differences of h^4 / 4;
finite volumes, so the volume is kept to rounding, with explicit steps at half the limit of stability. What is written is the end of
the similarity shape with the second moment that the fluid has, as the studies measure it of particles."""

import argparse
import json
from pathlib import Path

import numpy as np

gravity, viscosity = 10, 0.02  # [m/s2], kinematic [m2/s]
# Name of the study: n, radius or half the width, and height of the box [m], <r^2> / r_N^2 of the similarity shape, times [s].
currents = {
    "gravity-current": (0, 0.032, 0.016, 3 / 11, np.arange(2, 80.1, 2)),
    "gravity-current-axisymmetric": (1, 0.015, 0.007, 3 / 7, np.arange(0.5, 10.1, 0.5)),
}


def fronts(n, radius, height, moment, times, cells):
    """At the times; cells: that the box has at the start."""
    size = radius / cells
    middle, face = (np.arange(5 * cells) + 0.5) * size, np.arange(1, 5 * cells) * size
    h = np.where(middle < radius, float(height), 0.0)
    weight = middle**n  # of a cell's volume
    rate = gravity / (3 * viscosity) / size**2
    found, now, wet = [], 0.0, cells + 1
    for t in times:
        while now < t:
            step = min(0.25 / (rate * h[0] ** 3), t - now)
            flux = step * rate * face[:wet] ** n * np.diff(-h[: wet + 1] ** 4 / 4)
            change = -flux / weight[:wet]
            change[1:] += flux[:-1] / weight[1:wet]
            h[:wet] += change
            h[wet] += flux[-1] / weight[wet]
            wet += h[wet] > 0
            now += step
        found.append(np.sqrt((middle**2 * weight * h).sum() / (weight * h).sum() / moment))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cells", type=int, default=160, help="of the box at the start; half as many are run to compare")
    options = parser.parse_args()
    lines = []
    for name, (n, radius, height, moment, times) in currents.items():
        coarse, fine = (fronts(n, radius, height, moment, times, cells) for cells in (options.cells // 2, options.cells))
        change = max(abs(np.array(coarse) / fine - 1))
        print(f"{name}: {options.cells} cells, against half as many {100 * change:.3f} %")
        rows = ", ".join(f"[{t:g}, {front:.6g}]" for t, front in zip(times, fine, strict=True))
        lines.append(f'"{name}": {{"cells": {options.cells}, "change": {change:.1e}, "fronts": [{rows}]}}')
    text = '{"units": "s, m",\n' + ",\n".join(lines) + "\n}\n"
    json.loads(text)
    options.out.write_text(text)


if __name__ == "__main__":
    main()
