"""The case that parameters and particles or cuboids become."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

from .._toml import quoted
from ..cases import Case, Domain, Gravity, Material, Method, Output, Time
from ..errors import InputError
from .bodies import add_bodies, name_of_type
from .case_file import case_file_text
from .geometry import Geometry, read_geometry
from .lines import number_text, read_file
from .parameters import Parameters, read_parameters


@dataclass
class Imported:
    """A case, the files of its particles by their names, and warnings of what has no counterpart and is left out."""

    case: Case
    origin: str
    tables: dict[str, str] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """Of the case file."""
        return case_file_text(self.case, self.origin)


def import_files(parameters: str, geometry: str, name: str) -> Imported:
    """name: that of the case file, without its ending. Raises InputError that begins with the path, and with the line
    where there is one, and says what was found and expected."""
    g = read_geometry(geometry)
    return converted(read_parameters(parameters, read_file(parameters)), g, name)


def converted(p: Parameters, g: Geometry, name: str) -> Imported:
    """name: that of the case file, without its ending. Raises InputError."""
    warnings = list(p.warnings)
    dimensions = 2 if is_flat(g) else 3
    domain = _domain(p, g, dimensions, warnings)
    gravity = p["Gravity"][:dimensions]
    if dimensions == 2 and p["Gravity"][2] != 0:
        warnings.append(
            f"{p.place('Gravity')} along z is {number_text(p['Gravity'][2])} and left out: the particles are one layer"
        )
    time = _time(p, g, warnings)
    _note_surface_tension(p, g, warnings)
    case = Case(
        title=name,
        dimensions=dimensions,
        spacing=g.spacing,
        domain=domain,
        gravity=Gravity(acceleration=gravity),
        material=[_material(p, type) for type in g.used_types()],
        time=time,
        method=Method(
            scheme="published", pressure_radius=p.number("RadiusRatioP"), viscosity_radius=p.number("RadiusRatioV")
        ),
        output=Output(interval=p.number("VtkOutputInterval"), checkpoint_interval=p.number("OutputInterval")),
    )
    files = [quoted(os.path.basename(path)) for path in (p.path, g.path)]
    imported = Imported(case, f"The case of {files[0]} and {files[1]}, by treacle import", warnings=warnings)
    case.body, imported.tables = add_bodies(p, g, dimensions, name, warnings)
    return imported


def is_flat(g: Geometry) -> bool:
    """Whether all particles are one layer in z, as those of the program's cases in two dimensions."""
    slack = 1e-6 * g.spacing
    heights = [(cuboid.lower[2] + cuboid.upper[2]) / 2 for cuboid in g.cuboids]
    for numbers in g.numbers:
        heights += numbers[2::6]
    thin = all(cuboid.upper[2] - cuboid.lower[2] < 1.5 * g.spacing for cuboid in g.cuboids)
    return thin and all(abs(height - heights[0]) < slack for height in heights)


def _domain(p: Parameters, g: Geometry, dimensions: int, warnings: list[str]) -> Domain:
    """The program's domain is periodic; here a periodic axis has three search cells at least."""
    edge = max(p.number("RadiusRatioV") * g.spacing, 2 * (p.number("RadiusRatioP") * g.spacing))
    periodic = []
    for k in range(dimensions):
        length = g.upper[k] - g.lower[k]
        periodic.append(edge == 0 or length / edge >= 3)
        if not periodic[k]:
            warnings.append(
                f"{g.path}: the domain is {number_text(length)} long along {'xyz'[k]}, less than three search cells of "
                f"{number_text(edge)}, and so open there and not periodic"
            )
    return Domain(min=g.lower[:dimensions], max=g.upper[:dimensions], periodic=periodic)


def _time(p: Parameters, g: Geometry, warnings: list[str]) -> Time:
    end = p.number("EndTime")
    if not end > g.time:
        raise InputError(
            f"{p.place('EndTime')}: expected a time after that of the particles in {g.path}, {number_text(g.time)}, "
            f"found {number_text(end)}"
        )
    if g.time > 0:
        warnings.append(
            f"{g.path}: the particles are those of t = {number_text(g.time)}, which is time 0 of the case; pressures "
            "begin at 0"
        )
    return Time(step=p.number("Dt"), end=end - g.time)


def _note_surface_tension(p: Parameters, g: Geometry, warnings: list[str]) -> None:
    """What forces of the surfaces there are in the program is a model of its own."""
    for type in g.used_types():
        tension, row = p["SurfaceTension"][type], f"InteractionRatio(Type{type})"
        if tension != 0:
            warnings.append(
                f"{p.place('SurfaceTension')} of type {type} is {number_text(tension)} and left out, as is "
                "RadiusRatioA: the forces between particles that it stands for are another model than surface_tension "
                "of a material"
            )
        if any(ratio != 1 for ratio in p[row]):
            warnings.append(
                f"{p.place(row)} is not 1 throughout and left out: it belongs to another model of surface tension"
            )


def _material(p: Parameters, type: int) -> Material:
    density = p["Density"][type]
    if not density > 0:
        raise InputError(
            f"{p.place('Density')}: expected a positive number for type {type}, of which there are particles, found "
            f"{number_text(density)}"
        )
    return Material(
        name=name_of_type(type),
        density=density,
        dynamic_viscosity=p["ShearViscosity"][type],
        bulk_viscosity=p["BulkViscosity"][type],
        bulk_modulus=p["BulkModulus"][type],
    )
