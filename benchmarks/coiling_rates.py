#!/usr/bin/env python3
"""benchmarks/coiling_rates.py [--turns N] [--csv FILE] RUN...

How fast the ropes of runs of cases/coiling-rope-viscous.toml go round, from the slices of their probes: a row for each run, and the slope
of rate against height over all runs. A row has means over whole turns of the rope that ended at the end of the run, N at most (4), their
scatter (standard deviation), and in the last columns

    rate H / U        U: of the rope, of its flow and its radius a at 0.35 H over the pile
    rate H a^2 / Q    (Ribe 2004); over that of a thin rope without gravity and inertia

--csv writes the turns one by one. Needs Python 3.11 and NumPy; case.toml, history.csv and probes/ are all it reads of a run."""

import argparse
import sys
import tomllib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scripts"))
from treacle_data import read_table


class ThinRope:
    """Steady coiling of a thin rope without gravity and inertia, H = U = 1: the viscous limit of Ribe (2004). In the frame that goes
    round with the coil, per arc length: tangent d' = (w - rate ez) x d, spin w of the rope by its moment M = 3 w'_across + 2 w'_along,
    M' = N x d, force N constant. At the nozzle the rope is vertical and does not spin; where it is laid down it is horizontal and rests."""

    def __init__(self):
        self.unknowns = np.array([16.52, 0, 1.088, -22.11, 39.09, 157.2, 4.0, 1.4006])  # M at the nozzle, N, rate, length
        for _ in range(20):
            residual = self.residual(self.unknowns)
            steps = 1e-6 * np.maximum(1, abs(self.unknowns))
            columns = [(self.residual(self.unknowns + s * e) - residual) / s for s, e in zip(steps, np.eye(8), strict=True)]
            change = np.linalg.solve(np.transpose(columns), -residual)
            self.unknowns = self.unknowns + change
            if abs(change).max() < 1e-9:
                break
        else:
            raise ArithmeticError("no solution for the thin rope")
        self.rate, self.length = self.unknowns[6:]

    @staticmethod
    def slopes(state, force, rate):
        tangent, spin, moment = state[3:6], state[6:9], state[9:]
        along = (moment @ tangent) * tangent
        turning = np.cross(spin - [0, 0, rate], tangent)
        return np.concatenate([tangent, turning, (moment - along) / 3 + along / 2, np.cross(force, tangent)])

    def path(self, unknowns, steps=200):
        """Places, tangents, spins and moments from the nozzle on, by the classical Runge-Kutta method."""
        force, rate, h = unknowns[3:6], unknowns[6], unknowns[7] / steps
        states = [np.concatenate([[0, 0, 1], [0, 0, -1], [0, 0, 0], unknowns[:3]])]
        for _ in range(steps):
            y = states[-1]
            k1 = self.slopes(y, force, rate)
            k2 = self.slopes(y + h / 2 * k1, force, rate)
            k3 = self.slopes(y + h / 2 * k2, force, rate)
            k4 = self.slopes(y + h * k3, force, rate)
            states.append(y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
        return np.array(states)

    def residual(self, unknowns):
        end = self.path(unknowns)[-1]
        x, tangent, spin = end[:3], end[3:6], end[6:9]
        radius = np.hypot(x[0], x[1])
        return np.array([x[2], tangent[2], *spin, x[:2] @ tangent[:2], radius - 1 / unknowns[6], unknowns[1]])  # the last: where it begins


class Coiling:
    """What the slices of one run say, at the times that they were read."""

    def __init__(self, run):
        run = Path(run)
        case = tomllib.loads((run / "case.toml").read_text())
        nozzle = next(b for b in case["body"] if b["type"] == "inflow")
        self.nozzle = nozzle["nozzle"]["center"]
        slices = [p for p in case["probe"] if p["type"] == "region"]
        slices.sort(key=lambda p: p["box"]["min"][2])
        low, high = (np.array([p["box"][end][2] for p in slices]) for end in ("min", "max"))
        tables = [read_table(run / "probes" / f"{p['name']}.csv") for p in slices]
        rows = min(len(t["time"]) for t in tables)

        def column(name):
            return np.array([t[name][:rows] for t in tables]).T

        self.time, self.z = tables[0]["time"][:rows], (low + high) / 2
        self.area = column("volume") / (high - low)  # of the fluid at a height
        self.x, self.y = column("center_x") - self.nozzle[0], column("center_y") - self.nozzle[1]
        history = read_table(run / "history.csv")
        second = history["time"] > history["time"][-1] / 2
        self.flow = np.polyfit(history["time"][second], history["inflow_volume"][second], 1)[0]
        self.outlet = np.sqrt(self.flow / np.pi / nozzle["speed"])

    def pile(self, i):
        """The height at which the fluid is half of what the pile has: where the centre of the rope is laid down, since half of the coil on
        top stands higher than that, half lower."""
        wide = np.flatnonzero(self.area[i] > 4 * np.pi * self.outlet**2)
        if not len(wide):
            return np.nan
        top = wide[-1]
        inside = self.area[i, max(0, top - 8) : top + 1]
        half = np.median(inside[inside > inside.max() / 2]) / 2
        k = np.flatnonzero(self.area[i] > half)[-1]
        a, b = self.area[i, k : k + 2]
        return self.z[k] + (self.z[k + 1] - self.z[k]) * (a - half) / (a - b)

    def rope(self, i, z):
        """Radius of the rope and its distance from the axis at a height: slices of a slanting rope have more fluid."""
        across = np.hypot(np.gradient(self.x[i], self.z), np.gradient(self.y[i], self.z))
        radius = np.sqrt(self.area[i] / np.sqrt(1 + across**2) / np.pi)
        return np.interp(z, self.z, radius), np.interp(z, self.z, np.hypot(self.x[i], self.y[i]))

    def turns(self, part=0.35):
        """Of the whole turns of the rope, counted from the end, one row each: time, height over the pile, its rate at a part of this
        height, and at twice that, radius of the rope at 1.5 diameters over the pile, distance from the axis at that part."""
        pile = np.array([self.pile(i) for i in range(len(self.time))])
        height = self.nozzle[2] - pile
        touched = np.flatnonzero(np.isnan(pile))[-1] + 1 if np.isnan(pile).any() else 0
        rows = np.arange(touched, len(self.time))
        if len(rows) < 8:
            return np.empty((0, 6))

        def phase(part):
            at = [np.argmin(abs(self.z - (pile[i] + part * height[i]))) for i in rows]
            return np.unwrap(np.arctan2(self.y[rows, at], self.x[rows, at]))

        low, high = phase(part), phase(2 * part)
        found: list[list[float]] = []
        end = len(rows) - 1
        while True:
            before = np.flatnonzero(abs(low[end] - low[: end + 1]) >= 2 * np.pi)
            if not len(before):
                return np.array(found[::-1]).reshape(-1, 6)
            begin = before[-1]
            turn = rows[begin : end + 1]
            rate = [abs(np.polyfit(self.time[turn], p[begin : end + 1], 1)[0]) for p in (low, high)]
            ropes = [self.rope(i, pile[i] + part * height[i]) for i in turn]
            found.append([self.time[turn].mean(), height[turn].mean(), *rate, *np.mean(ropes, 0)])
            end = begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--turns", type=int, default=4)
    parser.add_argument("--csv")
    parser.add_argument("run", nargs="+")
    options = parser.parse_args()
    theory, rows, lines = ThinRope(), [], ["run,time,height,rate,rate_higher,radius,distance"]
    print(f"thin rope without gravity and inertia: rate H / U = {theory.rate:.4f}, rate H a^2 / Q = {theory.rate / np.pi:.4f}")
    print("run                  turns  H [mm]  +-    H/2a  a [mm]  rate [1/s]  +-     higher  rate H/U  rate H a^2/Q  over the thin rope's")
    for run in options.run:
        coiling = Coiling(run)
        turns = coiling.turns()
        lines += [",".join([run, *(f"{v:.6g}" for v in turn)]) for turn in turns]
        if not len(turns):
            print(f"{Path(run).name:20} no whole turn")
            continue
        last = turns[-options.turns :]
        _, height, rate, higher, radius, _ = last.mean(0)
        scaled = (last[:, 1] * last[:, 2] * last[:, 4] ** 2).mean() / coiling.flow
        rows.append([height, rate, radius])
        print(f"{Path(run).name:20} {len(last):5}  {1e3 * height:6.2f}  {1e3 * last[:, 1].std():4.2f}  {height / radius / 2:4.1f}"
              f"  {1e3 * radius:6.3f}  {rate:10.3f}  {last[:, 2].std():5.3f}  {higher:6.3f}"
              f"  {np.pi * scaled:8.3f}  {scaled:12.3f}  {np.pi * scaled / theory.rate:6.3f}")
    if len(rows) > 1:
        height, rate, radius = np.log(np.transpose(rows))
        slope, _ = np.polyfit(height, rate, 1)
        print(f"rate as H to the power {slope:.3f}; rate a^2 to the power {np.polyfit(height, rate + 2 * radius, 1)[0]:.3f}")
    if options.csv:
        Path(options.csv).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
