"""Reads what the commands of treacle print and write, beyond what treacle_data does."""

import csv
import re
import tomllib

import numpy as np
from treacle_data import searched


def parameters(text):
    """The numbers of a case, from what `treacle check` prints."""
    case = tomllib.loads(text)
    number = r"(-?[\d.]+(?:e[+-]?\d+)?)"
    found = {name: re.search(name + r" = " + number, text) for name in ("d_mu", "d_lambda")}
    material = case["material"][0]
    return {
        "spacing": case["spacing"] / case.get("resolution", 1),
        "step": case["time"]["step"] / case.get("resolution", 1),
        "gravity": max(abs(v) for v in case["gravity"]["acceleration"]),
        "dimensions": case["dimensions"],
        **{k: material[k] for k in ("density", "dynamic_viscosity", "bulk_viscosity", "bulk_modulus") if k in material},
        **{k: v for k, v in case["method"].items() if not isinstance(v, (str, bool))},
        "tolerance": case["solver"]["tolerance"],
        "particles": int(searched(r"particles: (\d+) fluid", text)),
        "steps": int(searched(r"steps: (\d+)", text)),
        **{name: float(m[1]) for name, m in found.items() if m},
    }


def read_quoted(path):
    """Rows of a CSV file with quoted text, as dictionaries of strings."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def bucket_levels(position, low, extent, edge):
    """Highest level of the bucket hierarchy of [K23 sect. 3.2] as treacle builds it: buckets tile the domain, their edge is at
    least `edge`, and levels go on until one bucket is left."""
    count = np.floor(extent / edge)
    bucket = np.floor((position - low) / extent * count).astype(np.int64) % count.astype(np.int64)
    level = 0
    while (bucket != bucket[0]).any():
        bucket >>= 1
        level += 1
    return level
