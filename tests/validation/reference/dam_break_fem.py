#!/usr/bin/env python3
"""Mesh-based reference for the front of the two-dimensional dam break of [K23] (cases/dam-break-2d.toml).

Equations. An incompressible fluid, rho Dv/Dt = -grad p + div(2 mu eps(v)) + rho g and div v = 0, at rest at first in a
square of 20 mm; no slip on the floor y = 0 and the wall x = 0, no stress on the free surface, no surface tension. Inside,
lengths are millimetres and everything is divided by mu, so that the constants left are nu and g.

Method. Taylor-Hood elements (P2 velocity, P1 pressure) on triangles with straight edges. Vertices move with the fluid; what
the middle of an edge lags behind the fluid is in the convective term. Velocity: BDF2, its first step implicit Euler. Geometry:
a step predicts positions from the last two velocities, solves there once, and corrects them by the trapezoidal rule. Both are
second order while the set of nodes at walls stays the same. Nothing is stiff in the positions (there is no surface tension),
so they need no iteration.

Contact lines. Walls hold the fluid, so the front advances by rolling: the vertices of the free surface next to the contact
line come down ahead of it, and one that reaches the floor stays where it crossed it, as a vertex of the floor. Elements grow
in proportion to the distance from the contact lines. The fluid that sinks along the wall leaves a film, by the same rule.

Check on the way: `energy_missing` of the record is what of the potential energy released so far is neither kinetic nor
dissipated, `mass_error` the change of the area.

Meshes. Triangle meshes the fluid anew when an element has lost shape or an edge of the free surface has become too long for its
place. The vertices of the free surface stay material points; new ones come in on the cubic through their neighbours, and
those too close go. Velocities of the last two steps are interpolated in the old P2 functions.

To run it (versions of the record: scikit-fem 12.0.2, triangle 20250106, scipy 1.17.1, numpy 2.4.6, Python 3.11):

    python3 -m venv reference-venv
    reference-venv/bin/pip install scikit-fem triangle scipy numpy
    reference-venv/bin/python tests/validation/reference/dam_break_fem.py --mesh 1 --step 5e-4 --out run.json
    reference-venv/bin/python tests/validation/reference/dam_break_fem.py --join dam_break_fem.json run.json other.json
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg
import triangle
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2, ElementVector, LinearForm, MeshTri
from skfem.helpers import ddot, div, dot, grad, mul, sym_grad

side = 20.0  # of the column [mm]
viscosity = 10 / 1000 * 1e6  # mu / rho [mm2/s]
gravity = 10e3  # [mm/s2]


@BilinearForm
def mass_form(u, v, _):
    return dot(u, v)


@BilinearForm
def shear_form(u, v, _):
    return 2 * ddot(sym_grad(u), sym_grad(v))


@BilinearForm
def divergence_form(u, q, _):
    return -div(u) * q


@LinearForm
def weight_form(v, _):
    return -gravity / viscosity * v[1]


@LinearForm
def convection_form(v, w):
    return -dot(mul(grad(w["velocity"]), w["lag"]), v) / viscosity


class Sizes:
    """Lengths of elements [mm]; `mesh` divides them all, the growth with the distance included, and `contact` those at the
    contact lines once more."""

    def __init__(self, mesh, contact):
        self.bulk, self.surface, self.front, self.top, self.growth = (h / mesh for h in (1.0, 0.3, 0.02, 0.05, 0.2))
        self.front, self.top = self.front / contact, self.top / contact

    def along_surface(self, points, front, top):
        to_front = np.linalg.norm(points - front, axis=-1)
        to_top = np.linalg.norm(points - top, axis=-1)
        return np.minimum(self.surface,
                          np.minimum(self.front + self.growth * to_front, self.top + self.growth * to_top))

    def along_wall(self, length, finest):
        """Distances from the contact line at one end, to a wall's other end."""
        s = [0.0]
        while s[-1] < length:
            s.append(s[-1] + min(self.bulk, finest + self.growth * s[-1]))
        return np.array(s) * (length / s[-1])


def turns(points):
    """Angles by which a curve turns at its points, 0 at its ends."""
    d = np.diff(points, axis=0)
    angle = np.zeros(len(points))
    angle[1:-1] = abs(np.arctan2(d[:-1, 0] * d[1:, 1] - d[:-1, 1] * d[1:, 0], (d[:-1] * d[1:]).sum(axis=1)))
    return angle


sharp = np.radians(40)  # turn of a kink


def between(points, k, turned):
    """The point half-way along edge k, on the polynomial through up to four neighbours that no kink divides."""
    first = k - 1 if k > 0 and turned[k] < sharp else k
    last = k + 2 if k + 2 < len(points) and turned[k + 1] < sharp else k + 1
    near = points[first:last + 1]
    s = np.r_[0, np.cumsum(np.linalg.norm(np.diff(near, axis=0), axis=1))]
    at = (s[k - first] + s[k - first + 1]) / 2
    weight = [np.prod([(at - s[j]) / (s[i] - s[j]) for j in range(len(s)) if j != i]) for i in range(len(s))]
    return np.array(weight) @ near


def resample(points, sizes):
    """The free surface, from the wall to the floor, with edges as long as they should be."""
    for _ in range(8):
        middle = (points[1:] + points[:-1]) / 2
        long = np.linalg.norm(np.diff(points, axis=0), axis=1) > 1.4 * sizes.along_surface(middle, points[-1], points[0])
        if not long.any():
            break
        turned = turns(points)
        new = {k: between(points, k, turned) for k in np.flatnonzero(long)}
        points = np.array([p for k in range(len(points)) for p in ([points[k], new[k]] if k in new else [points[k]])])
        points[:, 1] = np.maximum(points[:, 1], 0)
    target, turned = sizes.along_surface(points, points[-1], points[0]), turns(points)
    kept = [points[0]]
    for k in range(1, len(points) - 1):
        gap = np.linalg.norm(points[k + 1] - kept[-1])
        if gap > 0.9 * target[k] or turned[k] > np.radians(25):
            kept.append(points[k])
    return np.array(kept + [points[-1]])


def shapes(x, t):
    """4 sqrt(3) area / sum of squared edges: 1 for an equilateral triangle, negative for one turned over."""
    a, b, c = x[t[0]], x[t[1]], x[t[2]]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return 2 * np.sqrt(3) * area / (((b - a) ** 2).sum(1) + ((c - b) ** 2).sum(1) + ((a - c) ** 2).sum(1))


class Fluid:
    """A mesh, and the velocities of the last two steps in its P2 nodes: vertices first, then middles of edges."""

    def __init__(self, surface, sizes, old=None):
        self.sizes = sizes
        self.build(surface)
        nodes = self.nodes(self.x)
        self.velocity = old.interpolate(nodes, old.velocity) if old else np.zeros_like(nodes)
        self.before = old.interpolate(nodes, old.before) if old else np.zeros_like(nodes)
        if old:
            for v in (self.velocity, self.before):
                v[self.held_nodes()] = 0

    def build(self, surface):
        top, front = surface[0], surface[-1]
        floor = front[0] - self.sizes.along_wall(front[0], self.sizes.front)[1:]
        wall = top[1] - self.sizes.along_wall(top[1], self.sizes.top)[1:-1][::-1]
        outline = np.vstack([surface, np.column_stack([floor, 0 * floor]), np.column_stack([0 * wall, wall])])
        n = len(outline)
        loop = np.column_stack([np.arange(n), np.roll(np.arange(n), -1)])
        out = triangle.triangulate({"vertices": outline, "segments": loop}, f"pq30Ya{0.43 * self.sizes.bulk ** 2:.9f}")
        self.x = np.array(out["vertices"], dtype=float)
        self.surface = np.arange(len(surface))
        self.held = np.zeros(len(self.x), dtype=bool)
        self.held[len(surface):n] = True
        self.held[[0, len(surface) - 1]] = True
        t = np.ascontiguousarray(np.array(out["triangles"]).T)
        self.mesh = MeshTri(np.ascontiguousarray(self.x.T), t)
        self.t = t
        self.shape = shapes(self.x, t)

    def nodes(self, x):
        return np.vstack([x, (x[self.mesh.facets[0]] + x[self.mesh.facets[1]]) / 2])

    def held_nodes(self):
        ends = self.mesh.facets
        edge = self.held[ends[0]] & self.held[ends[1]]
        edge[np.setdiff1d(np.arange(ends.shape[1]), self.mesh.boundary_facets())] = False
        return np.r_[self.held, edge]

    def interpolate(self, points, values):
        """Values at points; the functions of the nearest element go on a little outside of the mesh."""
        corners, middles = self.mesh.t, self.mesh.t2f + len(self.x)
        a, b, c = (self.x[corners[i]] for i in range(3))
        det = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        result = np.empty((len(points), 2))
        # Every element against a block of points: there are only thousands of both, so no search tree is needed.
        for start in range(0, len(points), 1000):
            p = points[start:start + 1000]
            dx, dy = p[:, :1] - a[:, 0], p[:, 1:] - a[:, 1]
            l1 = (dx * (c - a)[:, 1] - dy * (c - a)[:, 0]) / det
            l2 = (dy * (b - a)[:, 0] - dx * (b - a)[:, 1]) / det
            best = np.argmax(np.minimum(np.minimum(l1, l2), 1 - l1 - l2), axis=1)
            row = np.arange(len(p))
            l1, l2 = l1[row, best], l2[row, best]
            l0 = 1 - l1 - l2
            weights = [l0 * (2 * l0 - 1), l1 * (2 * l1 - 1), l2 * (2 * l2 - 1), 4 * l0 * l1, 4 * l1 * l2, 4 * l0 * l2]
            node = [*corners[:, best], *middles[:, best]]
            result[start:start + 1000] = sum(w[:, None] * values[i] for w, i in zip(weights, node, strict=True))
        return result

    def moved(self, displacement):
        """Positions after a displacement of the vertices, and who is held there: a vertex of the free surface that crosses the
        floor or the wall stays where it does, and so do those between it and the contact line."""
        x, held = self.x + displacement, self.held.copy()
        for axis, order in ((1, self.surface[::-1]), (0, self.surface)):
            crossed = np.flatnonzero((x[order, axis] <= 0) & ~held[order])
            if not len(crossed):
                continue
            landed = order[:crossed[-1] + 1]
            landed = landed[~held[landed]]
            part = np.where(x[landed, axis] < 0, self.x[landed, axis] / (self.x[landed, axis] - x[landed, axis]), 1)
            x[landed] = self.x[landed] + part[:, None] * displacement[landed]
            x[landed, axis] = 0
            held[landed] = True
        return x, held

    def predicted(self, dt):
        n = len(self.x)
        return self.moved(dt * (1.5 * self.velocity[:n] - 0.5 * self.before[:n]))

    def outline(self):
        """The free surface as far as it is free, with its contact lines: what a new mesh starts from."""
        points, held = self.x[self.surface], self.held[self.surface]
        free = np.flatnonzero(~held)
        return points[free[0] - 1:free[-1] + 2]

    def worn(self, x):
        points = self.outline()
        middle = (points[1:] + points[:-1]) / 2
        length = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return (shapes(x, self.t) < 0.5 * self.shape).any() or (
            length > 1.9 * self.sizes.along_surface(middle, points[-1], points[0])).any()

    def advance(self, dt, first):
        n = len(self.x)
        x, held = self.predicted(dt)
        free, start = self.held, self.x
        self.held = held
        mesh = MeshTri(np.ascontiguousarray(x.T), self.t)
        velocities = Basis(mesh, ElementVector(ElementTriP2()), intorder=4)
        pressures = Basis(mesh, ElementTriP1(), intorder=4)
        dofs = np.hstack([velocities.nodal_dofs, velocities.facet_dofs])  # x and y components of all nodes
        as_vector = np.empty(velocities.N)

        def vector(values):
            as_vector[dofs] = values.T
            return as_vector.copy()

        mass = mass_form.assemble(velocities)
        rate = (1.0 if first else 1.5) / dt / viscosity
        shear = shear_form.assemble(velocities)
        a = shear + rate * mass
        b = divergence_form.assemble(velocities, pressures)
        history = self.velocity if first else 2 * self.velocity - 0.5 * self.before
        guess = 2 * self.velocity - self.before
        lag = guess - self.nodes(guess[:n])
        load = weight_form.assemble(velocities) + mass @ vector(history) / (dt * viscosity) + convection_form.assemble(
            velocities, velocity=velocities.interpolate(vector(guess)), lag=velocities.interpolate(vector(lag)))

        open_dofs = np.setdiff1d(np.arange(velocities.N), dofs[:, self.held_nodes()])
        b = b[:, open_dofs]
        system = sparse.bmat([[a[open_dofs][:, open_dofs], b.T], [b, None]], format="csc")
        right = np.r_[load[open_dofs], np.zeros(pressures.N)]
        # A small compressibility keeps pivots on the diagonal, in an order with less fill; refinement takes it out again.
        soft = system - sparse.diags(np.r_[np.zeros(len(open_dofs)), 1e-7 * np.asarray(abs(b).sum(axis=1)).ravel()], format="csc")
        factors = linalg.splu(soft, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        solution = factors.solve(right)
        for _ in range(6):
            residual = right - system @ solution
            if np.linalg.norm(residual) < 1e-10 * np.linalg.norm(right):
                break
            solution += factors.solve(residual)
        self.residual = np.linalg.norm(right - system @ solution) / np.linalg.norm(right)

        flow = np.zeros(velocities.N)
        flow[open_dofs] = solution[:len(open_dofs)]
        self.dissipation, self.kinetic = flow @ shear @ flow, flow @ mass @ flow / (2 * viscosity)
        v = flow[dofs].T
        landed = held & ~free
        displacement = dt * (v[:n] + (0 if first else 1) * self.velocity[:n]) / (1 if first else 2)
        # What the prediction saw come down is at the wall; only others can still come down now.
        displacement[landed] = x[landed] - start[landed]
        self.before, self.velocity = self.velocity, v
        self.x, self.held = self.moved(displacement)
        self.velocity[self.held_nodes()] = 0
        self.mesh = MeshTri(np.ascontiguousarray(self.x.T), self.t)
        self.unknowns = system.shape[0]

    def moments(self):
        """The area and the integral of the height over it."""
        a, b, c = (self.x[self.t[i]] for i in range(3))
        area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
        return area.sum(), (area * (a + b + c)[:, 1] / 3).sum()

    def front(self):
        """The largest x of the fluid, on a parabola through three vertices, and its height."""
        points = self.x[self.surface]
        k = int(np.argmax(points[:, 0]))
        if not 0 < k < len(points) - 1 or turns(points)[k] > 0.5:
            return tuple(points[k])
        (x0, y0), (x1, y1), (x2, y2) = points[k - 1:k + 2]
        c = ((x2 - x1) / (y2 - y1) - (x1 - x0) / (y1 - y0)) / (y2 - y0)
        slope = (x1 - x0) / (y1 - y0) + c * (y1 - y0)
        if abs(slope) < 1e-14 or c >= 0:
            return x1, y1
        return x1 - slope ** 2 / (4 * c), y1 - slope / (2 * c)


def solve(mesh, step, end, contact=1):
    sizes = Sizes(mesh, contact)
    fluid = Fluid(resample(np.array([[0, side], [side, side], [side, 0]]), sizes), sizes)
    steps, meshes, began = round(end / step), 1, time.time()
    rows, elements, unknowns, residual = [], [], [], 0.0
    dissipated, dissipation = 0.0, 0.0
    for i in range(1, steps + 1):
        if fluid.worn(fluid.predicted(step)[0]):
            fluid = Fluid(resample(fluid.outline(), sizes), sizes, fluid)
            meshes += 1
        fluid.advance(step, first=i == 1)
        elements.append(fluid.t.shape[1])
        unknowns.append(fluid.unknowns)
        residual = max(residual, float(fluid.residual))
        dissipated += step * (dissipation + fluid.dissipation) / 2
        dissipation = fluid.dissipation
        if abs(i * step / 0.01 - round(i * step / 0.01)) < 1e-6:
            x, y = fluid.front()
            outline = fluid.outline()
            area, height = fluid.moments()
            released = gravity / viscosity * (side ** 3 / 2 - height)
            missing = 1 - (dissipated + fluid.kinetic) / released
            rows.append({"time": round(i * step, 9), "front_x": x * 1e-3, "front_y": y * 1e-3, "contact_x": outline[-1, 0] * 1e-3,
                         "mass_error": float(area / side ** 2 - 1),
                         "energy_missing": float(missing)})
            print(f"t = {i * step:.3f} s  front {x:.4f} mm at {y:.3f} mm  contact {outline[-1, 0]:.4f} mm  "
                  f"mass {rows[-1]['mass_error']:+.1e}  energy {missing:+.1e}  {elements[-1]} triangles  {meshes} meshes  "
                  f"residual {residual:.0e}  {time.time() - began:.0f} s", flush=True)
    return {"mesh": mesh, "step": step, "sizes_mm": {k: round(v, 6) for k, v in vars(sizes).items()},
            "triangles": [min(elements), max(elements)], "unknowns": [min(unknowns), max(unknowns)], "meshes": meshes,
            "largest_residual": float(residual), "seconds": round(time.time() - began, 1),
            "table": [{k: float(f"{v:.8g}") for k, v in row.items()} for row in rows]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesh", type=float, default=1, help="divides all lengths of elements")
    parser.add_argument("--contact", type=float, default=1, help="divides those at the contact lines once more")
    parser.add_argument("--step", type=float, default=5e-4, help="time step [s]")
    parser.add_argument("--end", type=float, default=0.2, help="end [s]")
    parser.add_argument("--out", type=Path, help="JSON record of the run")
    parser.add_argument("--join", nargs="+", type=Path, metavar="JSON", help="one record (the first) of the runs in the others")
    args = parser.parse_args()
    if args.join:
        runs = [json.loads(path.read_text())["runs"][0] for path in args.join[1:]]
        write(args.join[0], runs)
        return
    run = solve(args.mesh, args.step, args.end, args.contact)
    if args.out:
        write(args.out, [run])


def write(path, runs):
    """A line for each value of a run and for each row of its table."""
    blocks = []
    for run in runs:
        lines = [f"  {json.dumps(k)}: {json.dumps(v)}" for k, v in run.items() if k != "table"]
        rows = ",\n".join("   " + json.dumps(row) for row in run["table"])
        blocks.append(" {\n" + ",\n".join(lines) + ',\n  "table": [\n' + rows + "]}")
    head = '{"case": "cases/dam-break-2d.toml", "units": "s, m; sizes_mm in mm", "runs": [\n'
    path.write_text(head + ",\n".join(blocks) + "\n]}\n")


if __name__ == "__main__":
    main()
