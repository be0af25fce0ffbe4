"""Cases as dataclasses. Every class is a table of a case file, every field a key of it, and None one that is not given.

Checks and defaults are those of case files: docs/cases.md. Written by scripts/python-cases from the program's keys.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Literal

from ._arguments import KnownNames


@dataclass(kw_only=True)
class TimeTable(KnownNames):
    """A number that follows the time by straight lines, from lists or from two columns of a file."""

    times: Sequence[float] | None = None
    """[s]"""
    values: Sequence[float] | None = None
    file: str | PathLike[str] | None = None
    column: str | None = None


@dataclass(kw_only=True)
class Domain(KnownNames):
    min: Sequence[float] | None = None
    """[m]"""
    max: Sequence[float] | None = None
    """[m]"""
    periodic: bool | Sequence[bool] | None = None


@dataclass(kw_only=True)
class Gravity(KnownNames):
    acceleration: Sequence[float | str | TimeTable] | None = None
    """[m/s2]"""


@dataclass(kw_only=True)
class Rotation(KnownNames):
    center: Sequence[float] | None = None
    """[m]"""
    speed: float | None = None
    """[rad/s]"""
    angle: float | str | TimeTable | None = None
    """[rad]"""
    axis: Sequence[float] | None = None
    """[any unit]"""


@dataclass(kw_only=True)
class Rheology(KnownNames):
    model: Literal["power-law", "cross", "carreau-yasuda", "bingham", "herschel-bulkley", "casson"] | None = None
    consistency: float | None = None
    """[Pa s^n]"""
    flow_index: float | None = None
    min_viscosity: float | None = None
    """[Pa s]"""
    max_viscosity: float | None = None
    """[Pa s]"""
    zero_viscosity: float | None = None
    """[Pa s]"""
    infinite_viscosity: float | None = None
    """[Pa s]"""
    time_constant: float | None = None
    """[s]"""
    transition: float | None = None
    yield_stress: float | None = None
    """[Pa]"""
    regularisation: float | None = None
    """[s]"""
    plastic_viscosity: float | None = None
    """[Pa s]"""


@dataclass(kw_only=True)
class ElasticMode(KnownNames):
    name: str | None = None
    model: Literal["oldroyd-b", "giesekus", "linear-ptt", "exponential-ptt"] | None = None
    viscosity: float | None = None
    """[Pa s]"""
    relaxation_time: float | None = None
    """[s]"""
    mobility: float | None = None
    extensibility: float | None = None


@dataclass(kw_only=True)
class MaterialState(KnownNames):
    name: str | None = None
    law: Literal["expression", "kamal-sourour", "houska", "roussel"] | None = None
    start: float | None = None
    rate: str | None = None
    min: float | None = None
    max: float | None = None
    a1: float | None = None
    """[1/s]"""
    e1: float | None = None
    """[J/mol]"""
    a2: float | None = None
    """[1/s]"""
    e2: float | None = None
    """[J/mol]"""
    m: float | None = None
    n: float | None = None
    max_conversion: float | None = None
    build_up: float | None = None
    """[1/s]"""
    break_down: float | None = None
    """[s^(exponent-1)]"""
    exponent: float | None = None
    time: float | None = None
    """[s]"""
    heat: float | None = None
    """[J/kg]"""


@dataclass(kw_only=True)
class Gelling(KnownNames):
    state: str | None = None
    conversion: float | None = None
    a: float | None = None
    b: float | None = None
    max_factor: float | None = None


@dataclass(kw_only=True)
class ContactAngle(KnownNames):
    name: str | None = None
    angle: float | None = None
    """[deg]"""


@dataclass(kw_only=True)
class ViscosityShift(KnownNames):
    model: Literal["arrhenius", "vft", "wlf", "table"] | None = None
    reference_temperature: float | None = None
    """[K]"""
    activation_energy: float | None = None
    """[J/mol]"""
    min_factor: float | None = None
    max_factor: float | None = None
    b: float | None = None
    """[K]"""
    t0: float | None = None
    """[K]"""
    c1: float | None = None
    c2: float | None = None
    """[K]"""
    temperatures: Sequence[float] | None = None
    """[K]"""
    factors: Sequence[float] | None = None


@dataclass(kw_only=True)
class Freezing(KnownNames):
    solidus: float | None = None
    """[K]"""
    liquidus: float | None = None
    """[K]"""
    latent_heat: float | None = None
    """[J/kg]"""
    solid_conductivity: float | None = None
    """[W/(m K)]"""
    solid_specific_heat: float | None = None
    """[J/(kg K)]"""
    solid_factor: float | None = None


@dataclass(kw_only=True)
class Material(KnownNames):
    name: str | None = None
    density: float | None = None
    """[kg/m3]"""
    rheology: Rheology | None = None
    dynamic_viscosity: float | None = None
    """[Pa s]"""
    bulk_viscosity: float | Literal["auto"] | None = None
    """[Pa s]"""
    bulk_modulus: float | Literal["auto"] | None = None
    """[Pa]"""
    elastic: Sequence[ElasticMode] | None = None
    state: Sequence[MaterialState] | None = None
    viscosity_factor: str | None = None
    yield_factor: str | None = None
    volume_factor: str | None = None
    gelling: Gelling | None = None
    slip_length: float | None = None
    """[m]"""
    surface_tension: float | None = None
    """[N/m]"""
    contact_angle: float | None = None
    """[deg]"""
    contact_angles: Sequence[ContactAngle] | None = None
    specific_heat: float | None = None
    """[J/(kg K)]"""
    conductivity: float | None = None
    """[W/(m K)]"""
    emissivity: float | None = None
    viscosity_shift: ViscosityShift | None = None
    freezing: Freezing | None = None
    thermal_expansion: float | None = None
    """[1/K]"""
    expansion_temperature: float | None = None
    """[K]"""


@dataclass(kw_only=True)
class StateStart(KnownNames):
    name: str | None = None
    value: float | str | None = None


@dataclass(kw_only=True)
class Transform(KnownNames):
    scale: float | None = None
    angle: float | None = None
    """[deg]"""
    center: Sequence[float] | None = None
    """[m]"""
    translate: Sequence[float] | None = None
    """[m]"""
    axis: Sequence[float] | None = None
    """[any unit]"""
    angles: Sequence[float] | None = None
    """[deg]"""


@dataclass(kw_only=True)
class Oscillation(KnownNames):
    amplitude: Sequence[float] | None = None
    """[m]"""
    period: float | None = None
    """[s]"""
    phase: float | None = None
    """[rad]"""


@dataclass(kw_only=True)
class Nozzle(KnownNames):
    shape: Literal["disc", "rectangle", "polygon"] | None = None
    center: Sequence[float] | None = None
    """[m]"""
    direction: Sequence[float] | None = None
    """[any unit]"""
    radius: float | None = None
    """[m]"""
    inner_radius: float | None = None
    """[m]"""
    width: float | None = None
    """[m]"""
    points: Sequence[Sequence[float]] | None = None
    """[m]"""
    height: float | None = None
    """[m]"""
    up: Sequence[float] | None = None
    """[any unit]"""


@dataclass(kw_only=True)
class Hinge(KnownNames):
    point: Sequence[float] | None = None
    """[m]"""
    axis: Sequence[float] | None = None
    """[any unit]"""


@dataclass(kw_only=True)
class Spring(KnownNames):
    name: str | None = None
    to: str | None = None
    anchor: Sequence[float] | None = None
    """[m]"""
    arm: Sequence[float] | None = None
    """[m]"""
    length: float | None = None
    """[m]"""
    stiffness: float | None = None
    """[N/m2]"""
    damping: float | None = None
    """[N s/m2]"""


@dataclass(kw_only=True)
class Body(KnownNames):
    name: str | None = None
    type: Literal["fluid", "wall", "inflow", "rigid"] | None = None
    material: str | None = None
    shape: Literal["box", "sphere", "cylinder", "cone", "torus", "polygon", "polyline", "mesh", "particles"] | None = None
    where: str | None = None
    subtract: Sequence[str] | None = None
    velocity: Sequence[float | str] | Sequence[float] | None = None
    """[m/s]"""
    disorder: float | None = None
    """[spacings]"""
    viscosity_factor: float | str | None = None
    state: Sequence[StateStart] | None = None
    min: Sequence[float] | None = None
    """[m]"""
    max: Sequence[float] | None = None
    """[m]"""
    transform: Transform | None = None
    center: Sequence[float] | None = None
    """[m]"""
    radius: float | None = None
    """[m]"""
    inner_radius: float | None = None
    """[m]"""
    start: Sequence[float] | None = None
    """[m or s]"""
    end: Sequence[float] | None = None
    """[m or s]"""
    start_radius: float | None = None
    """[m]"""
    end_radius: float | None = None
    """[m]"""
    inner_start_radius: float | None = None
    """[m]"""
    inner_end_radius: float | None = None
    """[m]"""
    tube_radius: float | None = None
    """[m]"""
    points: Sequence[Sequence[float]] | None = None
    """[m]"""
    fill: Literal["inside", "shell", "outside", "sheet", "thin-sheet"] | None = None
    thickness: float | None = None
    """[m]"""
    file: str | PathLike[str] | None = None
    checksum: str | None = None
    flip: bool | None = None
    file_velocities: bool | None = None
    oscillation: Oscillation | None = None
    displacement: Sequence[float | str | TimeTable] | None = None
    """[m]"""
    rotation: Rotation | None = None
    friction: float | None = None
    restitution: float | None = None
    nozzle: Nozzle | None = None
    speed: float | str | TimeTable | None = None
    """[m/s]"""
    flow_rate: float | str | TimeTable | None = None
    """[m2/s or m3/s]"""
    profile: str | None = None
    mass: float | None = None
    """[kg/m]"""
    translates: bool | Sequence[bool] | None = None
    angular_velocity: float | Sequence[float] | None = None
    """[rad/s]"""
    rotates: bool | bool | Sequence[bool] | None = None
    hinge: Hinge | None = None
    release: float | None = None
    """[s]"""
    force: Sequence[float | str | TimeTable] | None = None
    """[N/m]"""
    torque: float | str | TimeTable | Sequence[float | str | TimeTable] | None = None
    """[N or N m]"""
    damping: float | None = None
    """[kg/(m s) or kg/s]"""
    angular_damping: float | None = None
    """[kg m/s or kg m2/s]"""
    springs: Sequence[Spring] | None = None
    temperature: float | str | None = None
    """[K]"""
    file_temperatures: bool | None = None
    wall_conductance: float | None = None
    """[W/(m2 K)]"""
    axis: Sequence[float] | None = None
    """[any unit]"""
    bottom: float | None = None
    """[m]"""
    top: float | None = None
    """[m]"""


@dataclass(kw_only=True)
class Outflow(KnownNames):
    name: str | None = None
    shape: Literal["box", "plane"] | None = None
    min: Sequence[float] | None = None
    """[m]"""
    max: Sequence[float] | None = None
    """[m]"""
    point: Sequence[float] | None = None
    """[m]"""
    normal: Sequence[float] | None = None
    """[any unit]"""


@dataclass(kw_only=True)
class Opening(KnownNames):
    name: str | None = None
    material: str | None = None
    face: Nozzle | None = None
    pressure: float | str | TimeTable | None = None
    """[Pa]"""
    flow_rate: float | str | TimeTable | None = None
    """[m2/s or m3/s]"""
    viscosity_factor: float | None = None
    temperature: float | None = None
    """[K]"""


@dataclass(kw_only=True)
class Time(KnownNames):
    step: float | Literal["auto"] | None = None
    """[s]"""
    end: float | None = None
    """[s]"""
    courant: float | None = None
    tolerance: float | None = None
    min_step: float | None = None
    """[s]"""
    max_step: float | None = None
    """[s]"""


@dataclass(kw_only=True)
class Method(KnownNames):
    name: Literal["mph-i", "isph"] | None = None
    scheme: Literal["accurate", "published"] | None = None
    pressure_radius: float | None = None
    """[spacings]"""
    density_radius: float | None = None
    """[spacings]"""
    viscosity_radius: float | None = None
    """[spacings]"""
    viscosity_correction: float | None = None
    tension_limit: float | None = None
    """[Pa]"""
    background_pressure: float | None = None
    """[Pa]"""
    kernel: Literal["cubic-spline", "wendland-c2"] | None = None
    smoothing_ratio: float | None = None
    """[spacings]"""
    alpha: float | None = None
    walls: Literal["no-slip", "free-slip"] | None = None
    viscosity: Literal["auto", "explicit", "implicit"] | None = None
    smagorinsky: float | None = None
    shifting: float | None = None
    negative_pressure: bool | None = None


@dataclass(kw_only=True)
class RheologyIteration(KnownNames):
    iterations: int | None = None
    tolerance: float | None = None


@dataclass(kw_only=True)
class Heat(KnownNames):
    ambient_temperature: float | None = None
    """[K]"""
    heat_transfer: float | None = None
    """[W/(m2 K)]"""
    viscous_heating: bool | None = None
    tolerance: float | None = None
    max_iterations: int | None = None


@dataclass(kw_only=True)
class Vent(KnownNames):
    name: str | None = None
    min: Sequence[float] | None = None
    """[m]"""
    max: Sequence[float] | None = None
    """[m]"""


@dataclass(kw_only=True)
class Gas(KnownNames):
    pressure: float | None = None
    """[Pa]"""
    exponent: float | None = None
    vents: Sequence[Vent] | None = None


@dataclass(kw_only=True)
class Multigrid(KnownNames):
    finest_sweeps: int | None = None
    middle_sweeps: int | None = None
    coarsest_sweeps: int | None = None
    particle_diagonal: Literal["jacobi", "extended-jacobi"] | None = None
    coarse_operators: Literal["auto", "direct", "spgemm"] | None = None


@dataclass(kw_only=True)
class Projected(KnownNames):
    pressure_degree: int | None = None
    grid_degree: int | None = None
    velocity_degree: int | None = None
    iteration_bound: int | None = None


@dataclass(kw_only=True)
class Cells(KnownNames):
    levels: int | None = None
    sweeps: int | None = None


@dataclass(kw_only=True)
class Hats(KnownNames):
    grid_degree: int | None = None
    iteration_bound: int | None = None


@dataclass(kw_only=True)
class Solver(KnownNames):
    krylov: Literal["cg", "cr"] | None = None
    preconditioner: Literal["projected-multigrid", "bucket-multigrid", "block-jacobi", "hat-multigrid", "cell-multigrid", "jacobi", "none"] | None = None
    tolerance: float | None = None
    max_iterations: int | None = None
    precision: Literal["mixed", "double"] | None = None
    first_guess: Literal["quadratic", "linear", "last"] | None = None
    divided_nodes: int | None = None
    operator: Literal["matrix-free", "assembled"] | None = None
    neighbours: Literal["lists", "ranges"] | None = None
    deflation: int | None = None
    multigrid: Multigrid | None = None
    projected: Projected | None = None
    cells: Cells | None = None
    hats: Hats | None = None


@dataclass(kw_only=True)
class Output(KnownNames):
    interval: float | None = None
    """[s]"""
    checkpoint_interval: float | None = None
    """[s]"""
    fields: Sequence[Literal["velocity", "pressure", "number_density", "nearest_distance", "material", "body", "id", "dynamic_viscosity", "shear_rate", "temperature", "viscosity_factor"]] | None = None
    format: Literal["vtp"] | None = None
    precision: Literal["single", "double"] | None = None
    compression: Literal["zlib", "none"] | None = None
    pieces: Literal["auto", "one", "each"] | None = None
    surface: bool | None = None
    balance: bool | None = None


@dataclass(kw_only=True)
class ProbeBox(KnownNames):
    min: Sequence[float] | None = None
    """[m]"""
    max: Sequence[float] | None = None
    """[m]"""


@dataclass(kw_only=True)
class Probe(KnownNames):
    name: str | None = None
    type: Literal["point", "line", "plane", "height", "flow", "region", "load", "wall-pressure"] | None = None
    interval: float | None = None
    """[s]"""
    moves_with: str | None = None
    point: Sequence[float] | None = None
    """[m]"""
    from_: Sequence[float] | None = None
    """[m]"""
    to: Sequence[float] | None = None
    """[m]"""
    count: int | None = None
    corner: Sequence[float] | None = None
    """[m]"""
    along: Sequence[float] | None = None
    """[m]"""
    up: Sequence[float] | None = None
    """[m]"""
    columns: int | None = None
    rows: int | None = None
    normal: Sequence[float] | None = None
    """[any unit]"""
    box: ProbeBox | None = None
    material: str | None = None
    body: str | None = None


@dataclass(kw_only=True)
class Watch(KnownNames):
    energy: float | None = None
    courant: float | None = None
    inside_walls: float | None = None
    density: float | None = None


@dataclass(kw_only=True)
class Width(KnownNames):
    axis: Literal["x", "y", "z"] | None = None
    from_: float | None = None
    """[m]"""
    to: float | None = None
    """[m]"""
    factor: float | None = None


@dataclass(kw_only=True)
class Case(KnownNames):
    base: str | None = None
    title: str | None = None
    dimensions: int | None = None
    spacing: float | None = None
    """[m]"""
    resolution: float | None = None
    domain: Domain | None = None
    gravity: Gravity | None = None
    frame: Rotation | None = None
    material: Sequence[Material] | None = None
    body: Sequence[Body] | None = None
    outflow: Sequence[Outflow] | None = None
    opening: Sequence[Opening] | None = None
    time: Time | None = None
    method: Method | None = None
    rheology: RheologyIteration | None = None
    heat: Heat | None = None
    gas: Gas | None = None
    solver: Solver | None = None
    output: Output | None = None
    probe: Sequence[Probe] | None = None
    watch: Watch | None = None
    width: Width | None = None
