#!/usr/bin/env python3
"""Reference for the stream that meets a step (study isph-step): interFoam of OpenFOAM, a volume-of-fluid method.

    step_vof.py --out step_vof.json    # four minutes

The same water, tank and step, laminar, with air of 1 kg/m3 around it and walls without friction: a boundary layer is far thinner
than the cells, and interFoam's own one (`--walls noSlip`) is made by the reconstruction of gradients beside walls. What is written for
each size of cells: the mean pressure on the face of the step, the pressures at two points before it and the depths of three columns,
each a mean over the last tenth of a second, the impulse on the face up to 0.6 s, and its pressure as means over 20 ms.

Needs interFoam, blockMesh, setFields and postProcess (Debian: apt-get install openfoam), and NumPy."""

import argparse
import json
import os
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}  # where Debian has it
tank, height = 3.225, 3.0  # [m]
step = (0.6625, 0.825, 0.1625)  # from, to, height [m]
water = (2.0, 0.55)  # from, height [m]
points = {"P1": (0.837, 0.021), "P2": (0.837, 0.061)}  # [m]
columns = {"H2": 0.99375, "H3": 1.50625, "H4": 2.64375}  # [m], in the middle of cells
end, late, impact, window = 1.0, 0.9, 0.6, 0.02  # [s]

head = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"
fixed = {
    "constant/g": ("uniformDimensionedVectorField", "dimensions [0 1 -2 0 0 0 0]; value (0 -9.81 0);"),
    "constant/turbulenceProperties": ("dictionary", "simulationType laminar;"),
    "constant/transportProperties": ("dictionary", """phases (fluid air);
fluid { transportModel Newtonian; nu 1e-6; rho 1000; }
air { transportModel Newtonian; nu 1.5e-5; rho 1; }
sigma 0;"""),
    "system/fvSchemes": ("dictionary", """ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes {
  div(rhoPhi,U) Gauss linearUpwind grad(U);
  div(phi,alpha) Gauss vanLeer;
  div(phirb,alpha) Gauss linear;
  div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }"""),
    "system/fvSolution": ("dictionary", """solvers {
  "alpha.fluid.*" { nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5;
    solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }
  "pcorr.*" { solver PCG; preconditioner DIC; tolerance 1e-5; relTol 0; }
  p_rgh { solver GAMG; smoother DIC; tolerance 1e-6; relTol 0.01; }
  p_rghFinal { solver GAMG; smoother DIC; tolerance 1e-6; relTol 0; }
}
PIMPLE { momentumPredictor no; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; }"""),
    "0/p_rgh": ("volScalarField", """dimensions [1 -1 -2 0 0 0 0]; internalField uniform 0;
boundaryField { "walls|face" { type fixedFluxPressure; value uniform 0; } top { type totalPressure; p0 uniform 0; }
  planes { type empty; } }"""),
    "0/alpha.fluid": ("volScalarField", """dimensions [0 0 0 0 0 0 0]; internalField uniform 0;
boundaryField { "walls|face" { type zeroGradient; } top { type inletOutlet; inletValue uniform 0; value uniform 0; }
  planes { type empty; } }"""),
    "system/setFieldsDict": ("dictionary", f"""defaultFieldValues ( volScalarFieldValue alpha.fluid 0 );
regions ( boxToCell {{ box ({water[0]} 0 -1) ({tank} {water[1]} 1); fieldValues ( volScalarFieldValue alpha.fluid 1 ); }} );"""),
}


def mesh(cell):
    """Five blocks around the step; "face" is its side towards the water."""
    xs, ys = (0, step[0], step[1], tank), (0, step[2], height)

    def corner(i, j, k=0):
        return 12 * k + 4 * j + i

    def side(a, b):
        return f"({a} {b} {b + 12} {a + 12})"

    def across(i, j):
        return side(corner(i, j), corner(i + 1, j))

    def along(i, j):
        return side(corner(i, j), corner(i, j + 1))

    def cells(a, b):
        return round((b - a) / cell)

    blocks, planes = [], []
    for i, j in [(0, 0), (2, 0), (0, 1), (1, 1), (2, 1)]:
        ring = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
        above = [n + 12 for n in ring]
        blocks.append(f"hex ({' '.join(map(str, ring + above))}) ({cells(*xs[i:i + 2])} {cells(*ys[j:j + 2])} 1) simpleGrading (1 1 1)")
        planes += [f"({' '.join(map(str, ring))})", f"({' '.join(map(str, above))})"]
    vertices = " ".join(f"({x} {y} {z})" for z in (0, cell) for y in ys for x in xs)
    walls = [along(0, 0), along(0, 1), along(3, 0), along(3, 1), across(0, 0), across(2, 0), along(1, 0), across(1, 1)]
    return f"""scale 1; vertices ({vertices}); blocks ({' '.join(blocks)});
boundary ( walls {{ type wall; faces ({' '.join(walls)}); }} face {{ type wall; faces ({along(2, 0)}); }}
  top {{ type patch; faces ({' '.join(across(i, 2) for i in range(3))}); }} planes {{ type empty; faces ({' '.join(planes)}); }} );"""


def control(cell):
    probes = " ".join(f"{name} {{ type probes; libs (sampling); writeControl timeStep; writeInterval 1; fields (p); "
                      f"probeLocations (({x} {y} {cell / 2})); }}" for name, (x, y) in points.items())
    return f"""application interFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end}; deltaT 1e-4;
writeControl adjustableRunTime; writeInterval 0.02; writePrecision 8; timePrecision 8; runTimeModifiable no;
adjustTimeStep yes; maxCo 0.4; maxAlphaCo 0.4; maxDeltaT 2e-3;
functions {{ {probes} face {{ type surfaceFieldValue; libs (fieldFunctionObjects); writeControl timeStep; writeInterval 1;
  writeFields false; log false; regionType patch; name face; operation areaAverage; fields (p); }} }}"""


def table(path):
    return np.array([[float(x) for x in line.split()] for line in path.read_text().splitlines() if not line.startswith("#")]).T


def cell_values(path):
    """Of a scalar field."""
    found = re.search(r"internalField\s+nonuniform List<scalar>\s*\d+\s*\(\s*(.*?)\)", path.read_text(), re.DOTALL)
    assert found, path
    return np.array(found[1].split(), float)


def impulse(time, value):
    """The integral up to each time."""
    return np.concatenate([[0], np.cumsum(np.diff(time) * (value[1:] + value[:-1]) / 2)])


def mean(time, value, since):
    """Over time, from `since` to the end."""
    kept = time >= since
    return float(impulse(time[kept], value[kept])[-1] / np.ptp(time[kept]))


def solve(cell, walls, directory):
    velocity = f"""dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0);
boundaryField {{ "walls|face" {{ type {walls}; }} top {{ type pressureInletOutletVelocity; value uniform (0 0 0); }}
  planes {{ type empty; }} }}"""
    made = {"system/blockMeshDict": ("dictionary", mesh(cell)), "system/controlDict": ("dictionary", control(cell)),
            "0/U": ("volVectorField", velocity)}
    for name, (kind, text) in (fixed | made).items():
        path = Path(directory) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(head.format(kind=kind, name=path.name) + text + "\n")
    for command in (["blockMesh"], ["setFields"], ["postProcess", "-func", "writeCellCentres", "-time", "0"], ["interFoam"]):
        subprocess.run(command, cwd=directory, env=environment, stdout=subprocess.DEVNULL, check=True)
    out = Path(directory) / "postProcessing"
    time, pressure = table(out / "face" / "0" / "surfaceFieldValue.dat")
    edges = np.linspace(0, end, round(end / window) + 1)
    so_far = impulse(time, pressure)
    values = {"face [Pa]": mean(time, pressure, late), "impulse [Pa s]": float(np.interp(impact, time, so_far)),
              "face over time [Pa]": (np.diff(np.interp(edges, time, so_far)) / window).round(1).tolist()}
    for name in points:
        time, pressure = table(out / name / "0" / "p")
        values[f"{name} [Pa]"] = mean(time, pressure, late)
    x = cell_values(Path(directory) / "0" / "Cx")
    times = sorted(float(p.name) for p in Path(directory).iterdir() if re.fullmatch(r"[\d.]+", p.name) and float(p.name) >= late - 1e-6)
    for name, place in columns.items():
        column = abs(x - place) < 0.51 * cell
        rows = len(np.unique(x[column].round(6)))
        depths = [cell_values(Path(directory) / f"{t:g}" / "alpha.fluid")[column].sum() * cell / rows for t in times]
        values[f"{name} [m]"] = mean(np.array(times), np.array(depths), late - 1e-6)
    return values


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cells", type=float, nargs="*", default=[0.0125], help="sizes [m]")
    parser.add_argument("--walls", default="slip", choices=["slip", "noSlip"])
    options = parser.parse_args()
    solved = []
    for cell in options.cells:
        with tempfile.TemporaryDirectory() as directory:
            solved.append({"cell [m]": cell} | solve(cell, options.walls, directory))
        print(solved[-1], flush=True)
        options.out.write_text(json.dumps({"walls": options.walls, "cells": solved}, indent=1) + "\n")


if __name__ == "__main__":
    main()
