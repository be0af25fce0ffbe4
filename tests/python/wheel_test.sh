#!/usr/bin/env bash
# tests/python/wheel_test.sh WHEEL PYTHON: installs the wheel, which may have 60 MB, into an empty virtual environment and runs
# a case by the module and by the program, where PATH has nothing else: no compiler, no tool. What is loaded with the module, beyond what an empty
# interpreter has, must be the environment's own or the C and C++ runtime: nothing of this machine's packages.
set -euo pipefail

if [ $# -ne 2 ]; then
  echo "usage: tests/python/wheel_test.sh WHEEL PYTHON" >&2
  exit 2
fi
wheel=$(realpath "$1")
bytes=$(stat -c %s "$wheel")
if [ "$bytes" -gt 60000000 ]; then
  echo "wheel_test: error: $wheel has $bytes bytes; expected at most 60 MB" >&2
  exit 1
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$2" -m venv "$folder/env"
"$folder/env/bin/python" -m pip --disable-pip-version-check -q install "$wheel"
cd "$folder"
cat >run.py <<'CODE'
import subprocess, sys, time
from pathlib import Path

def loaded():
    lines = Path("/proc/self/maps").read_text().splitlines()
    return {line.split(maxsplit=5)[5] for line in lines if ".so" in line}

import hashlib, ssl, ctypes, numpy, tqdm.auto, json, random
before = loaded()
start = time.time()
import treacle
print(f"import: {time.time() - start:.2f} s")

Path("drop.toml").write_text('''
dimensions = 2
spacing = 1e-3
domain = {min = [-0.03, -0.005], max = [0.03, 0.03]}
gravity = {acceleration = [0, -9.81]}
time = {step = 1e-3, end = 0.02}
output = {interval = 0.01}
material = [{name = "honey", density = 1400, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6}]
body = [
  {name = "drop", type = "fluid", material = "honey", shape = "sphere", center = [0, 0.01], radius = 0.008},
  {name = "floor", type = "wall", material = "honey", shape = "box", min = [-0.03, -0.005], max = [0.03, 0]},
]
''')
sim = treacle.Simulation.from_file("drop.toml")
sim.run(output="by-module", progress=False)
assert sim.at_end and len(sim.history["step"]) == 20
system = ("ld-linux", "libc.", "libm.", "libdl.", "libpthread.", "librt.", "libresolv.", "libgcc_s.", "libstdc++.")
own = (sys.prefix, sys.base_prefix + "/lib/python")
foreign = {path for path in loaded() - before if not path.startswith(own) and not Path(path).name.startswith(system)}
assert sim.backend == "cuda" or not foreign, foreign
command = Path(sys.prefix) / "bin/treacle"
subprocess.run([command, "run", "drop.toml", "-o", "by-program", "--quiet"], check=True)
subprocess.run([command, "compare", "by-program", "by-module", "--quiet"], check=True)
info = subprocess.run([command, "info"], check=True, capture_output=True, text=True).stdout
print(*[line for line in info.splitlines() if line.startswith("CUDA")])
print(f"{treacle.__version__} on Python {sys.version.split()[0]}, {sim.backend}: {len(loaded())} libraries, run and compared")
CODE
env -i PATH="$folder/env/bin" HOME="$folder" "$folder/env/bin/python" run.py
