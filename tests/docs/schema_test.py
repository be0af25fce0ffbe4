"""The JSON schema of case files: all cases of the repository are valid by it, and it refuses what the program refuses.

usage: schema_test.py TREACLE SOURCE
"""

import copy
import json
import pathlib
import subprocess
import sys
import tomllib

import jsonschema

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
case = source / "cases/dam-break-2d.toml"
# What is wrong, and where: entries of lists are found by their names.
mistakes = {
    "a misspelt key at the top": (("spacings",), 1e-3),
    "a misspelt key of a body": (("body", "column", "materiel"), "fluid"),
    "a misspelt key of a table": (("solver", "krylow"), "cg"),
    "a word that does not exist": (("solver", "krylov"), "gmres"),
    "a word of the other method": (("solver", "preconditioner"), "hat-multigrid"),
    "a number that is not positive": (("spacing",), 0),
    "a number above its bound": (("time", "tolerance"), 0.6),
    "a number below its bound": (("material", "fluid", "density"), -1),
    "a whole number that is none": (("solver", "max_iterations"), 10.5),
    "a text for a number": (("time", "end"), "soon"),
    "a vector of three in two dimensions": (("gravity", "acceleration"), [0, 0, -9.81]),
    "a key of the other method": (("method", "kernel"), "cubic-spline"),
    "a key of another shape": (("body", "column", "radius"), 0.1),
    "a key of heat without heat": (("material", "fluid", "conductivity"), 1),
    "two viscosities": (("material", "fluid", "rheology"), {"model": "power-law", "consistency": 1, "flow_index": 1}),
    "a constant of another rheology": (("material", "fluid", "rheology", "yield_stress"), 1),
    "a key of automatic steps": (("time", "min_step"), 1e-6),
    "another kind of body without its keys": (("body", "column", "type"), "inflow"),
    "another shape without its keys": (("body", "column", "shape"), "sphere"),
    "another method with keys of the first": (("method", "name"), "isph"),
}


def entry(table, key):
    return table[key] if isinstance(table, dict) else next(e for e in table if e["name"] == key)


def changed(document, path, value):
    document = copy.deepcopy(document)
    table = document
    for key in path[:-1]:
        if isinstance(table, dict):
            table.setdefault(key, {})
        table = entry(table, key)
    table[path[-1]] = value
    return document


def toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(v)}" for key, v in value.items()) + "}"
    return json.dumps(value)


def run(*arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


schema = json.loads(run("schema").stdout)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
failures, count = [], 0
for folder in ("cases", "tests/validation/cases"):
    for path in sorted((source / folder).rglob("*.toml")):
        count += 1
        for error in validator.iter_errors(tomllib.loads(path.read_text())):
            failures.append(f"{path}: {'.'.join(map(str, error.path))}: {error.message[:200]}")

base = tomllib.loads(case.read_text())
for what, (way, value) in mistakes.items():
    if validator.is_valid(changed(base, way, value)):
        failures.append(f"{what} is taken by the schema")
    if run("check", str(case), "--set", f"{'.'.join(way)}={toml(value)}").returncode != 2:
        failures.append(f"{what} is taken by the program")
for key in ("dimensions", "material", "time"):
    if validator.is_valid({k: v for k, v in base.items() if k != key}):
        failures.append(f"a case without {key} is taken by the schema")
if not validator.is_valid({"base": "dam-break-2d.toml", "material": [{"name": "fluid", "dynamic_viscosity": 20}]}):
    failures.append("a case with a base is refused")
if validator.is_valid({"base": "dam-break-2d.toml", "spacing": -1}):
    failures.append("a wrong number in a case with a base is taken")

warm = tomllib.loads((source / "cases/glass-gob-2d.toml").read_text())
fluid = next(b["name"] for b in warm["body"] if b["type"] == "fluid")
of_file = {
    "name": fluid,
    "type": "fluid",
    "material": entry(warm["body"], fluid)["material"],
    "shape": "particles",
    "file": "a.csv",
}
others = [b for b in warm["body"] if b["name"] != fluid]
for keys, valid in (
    ({}, False),
    ({"temperature": 1400}, True),
    ({"file_temperatures": True}, True),
    ({"file_temperatures": True, "temperature": 1400}, False),
):
    if validator.is_valid(warm | {"body": others + [of_file | keys]}) != valid:
        failures.append(f"fluid of a file with {keys} is {'refused' if valid else 'taken'}")

# The program writes out every key of a case; what it writes is valid, too.
for name in ("dam-break-2d", "isph-dam-break-2d", "glass-gob-2d", "bottle"):
    written = run("check", str(source / f"cases/{name}.toml"), "--set", "resolution=0.5")
    count += 1
    for error in validator.iter_errors(tomllib.loads(written.stdout)):
        failures.append(f"{name}, written out: {'.'.join(map(str, error.path))}: {error.message[:200]}")

print(f"{count} cases valid, {len(mistakes)} mistakes refused" if not failures else "\n".join(failures))
sys.exit(bool(failures) or count < 50)
