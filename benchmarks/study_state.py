#!/usr/bin/env python3
"""Turns states of the solver study (.npz) into files that solve_benchmark reads.

    study_state.py TO_DIRECTORY FILE.npz...

NAME.npz becomes TO_DIRECTORY/NAME.state: the bytes "treacle1", three 64-bit integers (dimensions, fluid particles, all
particles), two doubles (spacing [m], time step [s]), then doubles: positions of all particles [m], fluid first;
velocities of the fluid particles [m/s], which are the first guess; their right-hand side, to check what
solve_benchmark makes of the positions. Needs numpy.
"""
import pathlib
import sys

import numpy as np


def convert(source, target):
    z = np.load(source)
    d, fluid = int(z["d"]), int(z["nf"])
    position = z["posall"]
    if position.shape[1] != d or not np.array_equal(position[:fluid], z["X"]):
        sys.exit(f"study_state: {source}: the fluid particles are not the first ones of posall")
    numbers = [np.array([z["spacing"], z["dt"]]), position, z["x0"], z["b"]]
    if z["x0"].size != d * fluid or z["b"].size != d * fluid:
        sys.exit(f"study_state: {source}: x0 and b must have {d * fluid} values")
    with open(target, "wb") as out:
        out.write(b"treacle1" + np.array([d, fluid, len(position)], dtype="<i8").tobytes())
        for values in numbers:
            out.write(np.ascontiguousarray(values, dtype="<f8").tobytes())
    print(f"{target}: {d}D, {fluid} fluid of {len(position)} particles, {target.stat().st_size} B")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    directory = pathlib.Path(sys.argv[1])
    directory.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[2:]:
        convert(name, directory / (pathlib.Path(name).stem + ".state"))
