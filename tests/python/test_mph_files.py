"""Files of the authors' program: what is read of them, what messages say, and what a case keeps of them."""

from pathlib import Path

import picture_runs
import pytest
from mph_case import cuboids, parameters, particles, replaced
from treacle.errors import InputError
from treacle.mph_files.convert import converted
from treacle.mph_files.geometry import read_cuboids, read_particles
from treacle.mph_files.parameters import read_parameters

samples = picture_runs.repository / "tests" / "python" / "mph_files"


def error(read, path, text):
    """Of a file that is refused."""
    with pytest.raises(InputError) as caught:
        read(path, text.encode())
    return str(caught.value)


def parameter_error(text):
    return error(read_parameters, "box.data", text)


def particle_error(text):
    return error(read_particles, "box.grid", text)


def cuboid_error(text):
    return error(read_cuboids, "box.boid", text)


def case_of(data, boid=cuboids, grid=None):
    """What is imported of these texts."""
    g = read_particles("box.grid", grid.encode()) if grid else read_cuboids("box.boid", boid.encode())
    return converted(read_parameters("box.data", data.encode()), g, "box")


def test_all_rows_of_parameters():
    text = replaced(
        parameters,
        "Wall3  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0",
        "Wall3\tCenter 1 2 3\tVelocity 4 5 6\tOmega 7 8 +9e0  # turns\r",
    )
    p = read_parameters("box.data", b"\xef\xbb\xbf" + text.encode())
    assert [p.number(row) for row in ("Dt", "EndTime", "OutputInterval", "VtkOutputInterval")] == [
        1e-3,
        4e-3,
        5e-3,
        2e-3,
    ]
    assert [p.number(row) for row in ("RadiusRatioA", "RadiusRatioP", "RadiusRatioV")] == [3.5, 1.8, 3.4]
    assert p["Gravity"] == (0, -10, 0)
    assert p["Density"] == [1100, 1000, 900, 800]
    assert p["BulkModulus"] == [1e6, 2e6, 3e6, 4e6]
    assert p["BulkViscosity"] == [1e4, 2e4, 3e4, 4e4]
    assert p["ShearViscosity"] == [10, 20, 30, 40]
    assert p["SurfaceTension"] == [0, 0, 0, 0]
    assert p["InteractionRatio(Type0)"] == p["InteractionRatio(Type3)"] == [1, 1, 1, 1]
    assert p["Wall2"] == (0,) * 9
    assert p["Wall3"] == (1, 2, 3, 4, 5, 6, 7, 8, 9)
    assert p.lines["Dt"] == 2 and p.lines["Wall3"] == 17 and "SurfaceTension" in p.lines
    assert p.warnings == []


def test_parameters_that_may_be_missing():
    kept = [line for line in parameters.splitlines() if not line.startswith(("Out", "Vtk", "Surf", "Inter", "Wall"))]
    case = case_of("\n".join(kept)).case
    assert (case.output.interval, case.output.checkpoint_interval) == (0, 0)
    assert all(body.velocity is None and body.rotation is None for body in case.body[1:])


@pytest.mark.parametrize("old, new, expected", [
    ("1e-3", "0", "2: expected a positive number, found '0'"),
    ("1100", "nan", "9: expected a finite number, found 'nan'"),
    ("1100", "1e999", "9: expected a finite number, found '1e999'"),
    ("1100", "1e-999", "9: expected a finite number, found '1e-999'"),
    ("1100", "1_100", "9: expected a finite number, found '1_100'"),
    ("1100", "9" * 50 + "x", f"9: expected a finite number, found '{'9' * 40}...'"),
    ("1100", "-1", "9: expected a number that is not negative, found -1"),
    ("1100", "1 1 1100", "9: Density: expected 4 numbers, one for each of the types 0 to 3, found 6"),
    ("0 -10 0", "-10", "15: Gravity: expected 3 values, found 1"),
    ("# syrup", "Dt 1", "2: Dt stands twice, first in line 1; expected it once"),
    ("Omega 0 0 0", "Omega 0 0",
     "16: Wall2: expected 'Center' with 3 numbers, 'Velocity' with 3 and 'Omega' with 3, in this order"),
    ("BulkModulus ", "BulkModule ",
     "17: the file ends without the row BulkModulus; expected a file of parameters (.data) with Dt, EndTime, "
     "RadiusRatioP, RadiusRatioV, Density, BulkModulus, BulkViscosity, ShearViscosity, Gravity"),
])  # fmt: skip
def test_messages_about_parameters(old, new, expected):
    assert parameter_error(replaced(parameters, old, new)) == f"box.data:{expected}"


def test_message_about_an_empty_file():
    assert parameter_error("").startswith("box.data:1: the file ends without the rows Dt, EndTime, ")


@pytest.mark.parametrize("old, new, expected", [
    ("0.0", "0 1", "1: expected one number, the time [s], found 2 words"),
    ("0.0", "-1", "1: expected a time that is not negative, found -1"),
    ("128 ", "",
     "2: expected 8 numbers, the number of particles, their distance, and least and largest x, y and z, found 7 words"),
    ("128 ", "-1 ", "2: expected the number of particles, a whole number from 1 to 4294966272, found '-1'"),
    ("128 ", "1e2 ", "2: expected the number of particles, a whole number from 1 to 4294966272, found '1e2'"),
    ("128 ", "9" * 5000 + " ",
     f"2: expected the number of particles, a whole number from 1 to 4294966272, found '{'9' * 40}...'"),
    ("128 ", "127 ", "130: expected 127 particles, as many as the second row says, found more"),
    ("\n1 ", "\n4 ",
     "3: expected a type, 0 and 1 for fluids, 2 and 3 for walls, a whole number from 0 to 3, found '4'"),
    ("0.25", "inf", "3: expected a finite number, found 'inf'"),
    ("5.000000e-04", "1", "3: expected a particle inside of the domain, x from -0.004 to less than 0.014, found 1"),
    ("-2e-3 2e-3", "2e-3 2e-3", "2: expected the least z and then the largest z, found 0.002 and 0.002"),
])  # fmt: skip
def test_messages_about_particles(old, new, expected):
    assert particle_error(replaced(particles, old, new)) == f"box.grid:{expected}"


def test_messages_about_particles_that_are_missing():
    assert sum(len(numbers) for numbers in read_particles("box.grid", particles.encode()).numbers) == 128 * 6
    assert particle_error("").startswith("box.grid:1: the file is empty")
    assert particle_error("0\n").startswith("box.grid:1: the file ends after the time")
    assert particle_error(replaced(particles, "128 ", "4000000000 ")) == (
        f"box.grid:2: expected rows of 4000000000 particles, found a file of {len(particles) + 7} characters, which "
        "has no room for them"
    )
    whole = particles[: particles.rindex("\n", 0, -1) + 1]
    assert particle_error(whole) == "box.grid:129: expected 128 particles, the file ends after 127"
    assert particle_error(particles[:-4]).startswith("box.grid:130: expected 7 values")


@pytest.mark.parametrize("old, new, expected", [
    (cuboids, "", "1: expected 'ParticleDistance' in the file, which ends without it"),
    (cuboids[cuboids.index("StartCuboid") :], "", "4: the file has no cuboid; expected 'StartCuboid'"),
    (cuboids[cuboids.index("  Velocity  0 0 0") :], "",
     "16: the file ends in the cuboid of line 12"),
    ("  Type      1\n", "", "10: expected 'Type' in the cuboid, which ends without it"),
    ("Type      1", "Type 1.5",
     "7: expected a type, 0 and 1 for fluids, 2 and 3 for walls, a whole number from 0 to 3, found '1.5'"),
    ("Type ", "Tipe ", "7: expected 'Spacing', 'Type', 'Lower', 'Upper', 'Velocity' or 'EndCuboid', found 'Tipe'"),
    ("Spacing   1e-3", "Spacing 2e-3",
     "6: expected the Spacing to be the ParticleDistance, 0.001, found 0.002; the particles that are made of the "
     "cuboids (.grid) can be imported"),
    ("4e-3 6e-3 0.5e-3", "4e-3 -6e-3 0.5e-3",
     "11: expected the y of Lower to be less than that of Upper, found 0 and -0.006"),
    ("UpperDomain       14e-3", "UpperDomain -14e-3",
     "4: expected the x of LowerDomain to be less than that of UpperDomain, found -0.004 and -0.014"),
    ("4e-3 6e-3 0.5e-3", "4e-3 6e-3", "9: Upper: expected 3 values, found 2"),
    ("# dam", "LowerDomain 0 0 0", "3: 'LowerDomain' stands twice; expected it once"),
    ("  Spacing ", "  Type 1\n Spacing ", "8: 'Type' stands twice; expected it once"),
    ("ParticleDistance  1e-3\n", "",
     "4: expected 'ParticleDistance' in what stands before the first cuboid, which ends without it"),
    ("ParticleDistance", "Distance" * 9,
     f"2: expected 'ParticleDistance', 'LowerDomain', 'UpperDomain' or 'StartCuboid', found '{'Distance' * 5}'"),
])  # fmt: skip
def test_messages_about_cuboids(old, new, expected):
    assert cuboid_error(replaced(cuboids, old, new)) == f"box.boid:{expected}"


def test_at_most_as_many_cuboids_as_bodies():
    start = cuboids.index("StartCuboid")
    one = cuboids[start : cuboids.index("EndCuboid") + 10]
    assert len(read_cuboids("box.boid", (cuboids[:start] + 255 * one).encode()).cuboids) == 255
    assert "expected at most 255 cuboids, found more" in cuboid_error(cuboids[:start] + 256 * one)


def test_warns_of_what_is_left_out():
    text = replaced(parameters, "SurfaceTension           0      0 ", "SurfaceTension 0.01 0.07 ")
    text = replaced(text, "InteractionRatio(Type0)  1      1", "InteractionRatio(Type1) 1 0.5") + "Colour 1\n"
    text = replaced(text, "0 -10 0", "0 -10 1")
    text = replaced(text, "Velocity 0 0 0  Omega 0 0 0", "Velocity 1 0 2  Omega 3 0 0")
    imported = case_of(text, replaced(cuboids, "0.25 -0.5 0", "0.25 -0.5 1"))
    assert imported.warnings == [
        "box.data:18: 'Colour' is not a row that is known, and is left out",
        "box.data:15: Gravity along z is 1 and left out: the particles are one layer",
        "box.data:13: SurfaceTension of type 1 is 0.07 and left out, as is RadiusRatioA: the forces between particles "
        "that it stands for are another model than surface_tension of a material",
        "box.data:14: InteractionRatio(Type1) is not 1 throughout and left out: it belongs to another model of surface "
        "tension",
        "box.boid:5: the velocity has a part along z that is left out: the particles are one layer",
        "box.data: the Velocity of Wall2 has a part along z that is left out: the particles are one layer",
        "box.data: the Omega of Wall2 has parts along x and y that are left out: the particles are one layer",
    ]
    assert imported.case.gravity.acceleration == (0, -10)
    assert imported.case.body[1].velocity == (1, 0)
    assert imported.case.body[1].rotation is None


def test_warns_of_velocities_of_walls_and_fractions_of_spacings():
    boid = replaced(cuboids, "Upper     4e-3 6e-3", "Upper 4e-3 6.4e-3")
    boid = replaced(boid, "Velocity  0 0 0", "Velocity 1 0 0")
    assert case_of(parameters, boid).warnings == [
        "box.boid: velocities of type 2 are not those of the row Wall2 in box.data, and left out",
        "box.boid:5: the cuboid is 6.4 Spacings long along y, not a whole number: its particles may be others than "
        "those that are made of it (.grid), which can be imported",
    ]


def test_velocities_of_walls_that_the_parameters_give():
    """Particles of a wall that turns about the origin with -2/s: Omega x x is (2 y, -2 x)."""
    data = replaced(parameters, "Omega 0 0 0", "Omega 0 0 -2")
    grid = "0\n2 1e-3 -1 1 -1 1 -1 1\n1 0.5 0.5 0 0 0 0\n2 0.25 -0.125 0 {} -0.5 0\n"
    assert case_of(data, grid=grid.format("-0.25")).warnings == []
    assert case_of(data, grid=grid.format("-0.26")).warnings == [
        "box.grid: velocities of type 2 are not those of the row Wall2 in box.data, and left out"
    ]


def test_a_short_domain_is_open():
    imported = case_of(parameters, replaced(cuboids, "14e-3 14e-3  2e-3", "14e-3 6.7e-3 2e-3"))
    assert imported.case.domain.periodic == [True, False]
    (warning,) = imported.warnings
    assert warning.startswith(
        "box.boid: the domain is 0.010700000000000001 long along y, less than three search cells of 0.0036"
    )
    assert warning.endswith(", and so open there and not periodic")


def test_particles_of_a_later_time():
    imported = case_of(parameters, grid=replaced(particles, "0.0", "1e-3"))
    assert imported.case.time.end == pytest.approx(3e-3, rel=1e-15)
    assert imported.warnings == [
        "box.grid: the particles are those of t = 0.001, which is time 0 of the case; pressures begin at 0"
    ]
    with pytest.raises(InputError) as caught:
        case_of(parameters, grid=replaced(particles, "0.0", "1"))
    assert str(caught.value) == (
        "box.data:5: EndTime: expected a time after that of the particles in box.grid, 1, found 0.004"
    )


def test_velocities_that_differ_are_kept_in_the_table():
    imported = case_of(parameters, grid=replaced(particles, "0.25 -0.5 0", "1 0 0"))
    assert len(imported.case.body) == 3 and imported.warnings == []
    fluid, wall, _ = imported.case.body
    assert fluid.file_velocities is True and fluid.velocity is None
    assert wall.file_velocities is None
    lines = imported.tables["box-fluid1.csv"].splitlines()
    assert lines[:3] == ["x,y,vx,vy", "0.0005,0.0005,1,0", "0.0015,0.0005,0.25,-0.5"] and len(lines) == 25
    assert imported.tables["box-wall2.csv"].startswith("x,y\n-0.0035,-0.0035\n")
    # Those that are the same are one of the body.
    same = case_of(parameters, grid=particles)
    assert same.case.body[0].velocity == (0.25, -0.5) and same.case.body[0].file_velocities is None
    assert same.tables["box-fluid1.csv"].startswith("x,y\n0.0005,0.0005\n")


def test_needs_the_densities_of_its_types():
    with pytest.raises(InputError) as caught:
        case_of(replaced(parameters, "1000 ", "0 "))
    assert str(caught.value) == (
        "box.data:9: Density: expected a positive number for type 1, of which there are particles, found 0"
    )
    # Type 0 has no particles.
    assert len(case_of(replaced(parameters, "1100 ", "0 ")).case.material) == 3


def test_names_with_quotes_and_other_letters():
    imported = case_of(parameters)
    imported.case.title = 'a "b" \\ \x7f ü'
    assert 'title = "a \\"b\\" \\\\ \\u007f ü"\n' in imported.text


@pytest.mark.parametrize(
    "name, read, dimensions", [("cuboids", read_cuboids, 2), ("flat", read_particles, 2), ("space", read_particles, 3)]
)
def test_samples(name, read, dimensions):
    data, geometry = (Path(samples) / name).read_bytes().split(b"%%\n")
    imported = converted(read_parameters("box.data", data), read("box", geometry), "box")
    assert imported.case.dimensions == dimensions and len(imported.case.body) >= 2
