"""Cases of the authors' program: `treacle import` as a command, from files to particles and steps."""

import csv
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest
from mph_case import cuboids, parameters, particles, replaced, rows
from picture_runs import called, program

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@pytest.fixture
def shop(tmp_path, monkeypatch):
    """A directory with the files, in which the command is called."""
    monkeypatch.chdir(tmp_path)
    program()
    for name, text in ("box.data", parameters), ("box.boid", cuboids), ("box.grid", particles):
        (tmp_path / name).write_text(text)
    return tmp_path


def imported(*words):
    """`treacle import WORDS` in this process."""
    return called("import_case", *words)


def treacle(*words, **environment):
    """The program; what it left."""
    return subprocess.run([program(), *words], capture_output=True, text=True, env=os.environ | environment)


def read(name):
    return tomllib.loads(Path(name).read_text())


def test_cuboids_become_boxes(shop):
    done = treacle("import", "box.data", "box.boid")  # by the program, as users call it
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "box.toml\n2 dimensions, 24 fluid and 104 wall particles\n"
    text = (shop / "box.toml").read_text()
    assert text.startswith(
        '# The case of "box.data" and "box.boid", by treacle import. SI units.\n'
        'title = "box"\ndimensions = 2\nspacing = 0.001\n\n'
        "[domain]\nmin = [-0.004, -0.004]\nmax = [0.014, 0.014]\nperiodic = [true, true]\n\n"
        "[gravity]\nacceleration = [0, -10]\n\n"
        '[[material]]\nname = "fluid1"\ndensity = 1000\ndynamic_viscosity = 20\nbulk_viscosity = 20000\n'
        "bulk_modulus = 2000000\n\n"
    )
    assert (
        '[[body]]\nname = "fluid1-cuboid1"\ntype = "fluid"\nmaterial = "fluid1"\nshape = "box"\nmin = [0, 0]\n'
        "max = [0.004, 0.006]\nvelocity = [0.25, -0.5]\n\n"
    ) in text
    case = read("box.toml")
    assert case["method"] == {"scheme": "published", "pressure_radius": 1.8, "viscosity_radius": 3.4}
    assert [material["name"] for material in case["material"]] == ["fluid1", "wall2", "wall3"]
    assert case["material"][2] == {
        "name": "wall3",
        "density": 800,
        "dynamic_viscosity": 40,
        "bulk_viscosity": 4e4,
        "bulk_modulus": 4e6,
    }
    assert case["time"] == {"step": 1e-3, "end": 4e-3}
    assert case["output"] == {"interval": 2e-3, "checkpoint_interval": 5e-3}


def test_both_formats_give_the_same_particles_and_steps(shop):
    assert imported("box.data", "box.boid", "-o", "boid.toml").returncode == 0
    done = imported("box.data", "box.grid", "-o", "grid.toml")
    assert done.stdout == (
        "grid-fluid1.csv\ngrid-wall2.csv\ngrid-wall3.csv\ngrid.toml\n2 dimensions, 24 fluid and 104 wall particles\n"
    )
    assert done.stderr == ""
    for name in "boid", "grid":
        checked = treacle("check", f"{name}.toml")
        assert (checked.returncode, checked.stderr) == (0, "")
        done = treacle("run", f"{name}.toml", "-q", "--threads", "1", "--set", "output.precision=double")
        assert done.returncode == 0, done.stderr
        assert len(list(Path(f"{name}-run/frames").glob("fluid_*.vtp"))) == 3
    # Positions differ by rounding. Solves end at 1e-6 of the residual, so velocities may differ by as much.
    compared = treacle("compare", "boid-run", "grid-run", "--bound", "1e-5")
    assert compared.returncode == 0, compared.stdout
    # The lattice of a cuboid begins half a spacing inside of it.
    with open("grid-fluid1.csv") as file:
        first = next(csv.DictReader(file))
    assert (float(first["x"]), float(first["y"])) == (0.5e-3, 0.5e-3)


def test_three_dimensions_with_walls_that_move(shop):
    moving = "Wall2  Center 1e-3 2e-3 0  Velocity 0.5 0 0.25  Omega 0 -3 4"
    data = replaced(parameters, "Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0", moving)
    (shop / "box.data").write_text(replaced(data, "0 -10 0", "0 0 -10"))
    cuboid = "StartCuboid\nSpacing 1e-3\nType {}\nLower 0 0 {}\nUpper 4e-3 4e-3 {}\nVelocity 0 0 {}\nEndCuboid\n"
    (shop / "box.boid").write_text(
        "ParticleDistance 1e-3\nLowerDomain -8e-3 -8e-3 -8e-3\nUpperDomain 8e-3 8e-3 8e-3\n"
        + cuboid.format(0, "0", "4e-3", "0.125")
        + cuboid.format(2, "-4e-3", "0", "0")
    )
    (shop / "box.grid").write_text(
        "0\n128 1e-3 -8e-3 8e-3 -8e-3 8e-3 -8e-3 8e-3\n"
        + rows(0, (0, 0, 0), (4, 4, 4), "0 0 0.125")
        + rows(2, (0, 0, -4), (4, 4, 4), "0 0 0")
    )
    for name in "boid", "grid":
        done = imported("box.data", f"box.{name}", "-o", f"{name}.toml")
        assert done.stdout.endswith("3 dimensions, 64 fluid and 64 wall particles\n"), done.stderr
        case = read(f"{name}.toml")
        fluid, wall = case["body"]
        assert fluid["velocity"] == [0, 0, 0.125] and "file_velocities" not in fluid
        assert wall["type"] == "wall" and wall["velocity"] == [0.5, 0, 0.25]
        assert wall["rotation"] == {"center": [1e-3, 2e-3, 0], "axis": [0, -3, 4], "speed": 5}
        done = treacle("run", f"{name}.toml", "-q", "--threads", "1", "--end-time", "1e-3")
        assert done.returncode == 0, done.stderr
    compared = treacle("compare", "boid-run", "grid-run", "--bound", "1e-6")
    assert compared.returncode == 0, compared.stdout
    assert (shop / "grid-wall2.csv").read_text().startswith("x,y,z\n0.0005,0.0005,-0.0035\n0.0015,0.0005,-0.0035\n")


def test_turns_walls_in_the_plane(shop):
    turning = "Wall2  Center -2e-3 2e-3 0  Velocity 0 0 0  Omega 0 0 -2"
    (shop / "box.data").write_text(replaced(parameters, "Wall2  Center 0 0 0  Velocity 0 0 0  Omega 0 0 0", turning))
    assert imported("box.data", "box.boid").returncode == 0
    assert read("box.toml")["body"][1]["rotation"] == {"center": [-2e-3, 2e-3], "speed": -2}
    assert "\nrotation = { center = [-0.002, 0.002], speed = -2 }\n" in (shop / "box.toml").read_text()


def test_leaves_nothing_after_bad_input(shop):
    before = {path.name for path in shop.iterdir()}

    def error(*words):
        done = imported(*words)
        assert done.returncode == 2 and done.stdout == ""
        return done.stderr

    (shop / "box.grid").write_text(particles[: len(particles) // 2])
    assert error("box.data", "box.grid").startswith("treacle: error: box.grid:")
    # Fluid in a wall.
    (shop / "box.boid").write_text(replaced(cuboids, "Lower     0 0 -0.5e-3", "Lower -1e-3 0 -0.5e-3"))
    assert error("box.data", "box.boid").startswith(
        "treacle: error: box.boid: fluid body 'fluid1-cuboid1' and wall body 'wall2-cuboid2' overlap: "
    )
    # Far more particles than there can be.
    (shop / "box.boid").write_text(
        cuboids.replace("ParticleDistance  1e-3", "ParticleDistance 3e-8").replace("Spacing   1e-3", "Spacing 3e-8")
    )
    assert "box.boid: body 'fluid1-cuboid1' would have more than 4294966272 particles" in error("box.data", "box.boid")
    (shop / "box.boid").write_text(replaced(cuboids, "14e-3 14e-3  2e-3", "1e9 1e9 2e-3"))
    assert "box.data, box.boid: cannot be a case: domain.max: " in error("box.data", "box.boid")
    assert error("box.data", "missing.grid") == "treacle: error: missing.grid: No such file or directory\n"
    (shop / "folder.grid").mkdir()
    os.mkfifo("pipe.grid")
    assert error("box.data", "folder.grid") == "treacle: error: folder.grid: Is a directory\n"
    assert error("box.data", "pipe.grid") == "treacle: error: pipe.grid: Operation not supported\n"
    assert error("box.boid", "box.data") == (
        "treacle: error: box.data: expected a file with particles, .grid, or cuboids, .boid, found '.data'\n"
    )
    assert "PARTICLES" in error("box.data")
    assert "PARTICLES" in treacle("import", "box.data").stderr
    assert {path.name for path in shop.iterdir()} - before == {"folder.grid", "pipe.grid"}


def test_what_cannot_be_a_case_names_the_key(shop):
    (shop / "box.data").write_text(replaced(parameters, "RadiusRatioP             1.8", "RadiusRatioP 90"))
    assert imported("box.data", "box.boid").stderr == (
        "treacle: error: box.data, box.boid: cannot be a case: method.pressure_radius: expected a number between 0 and "
        "20 [spacings], found 90\n"
    )
    (shop / "box.data").write_text(parameters)
    (shop / "box.grid").write_text("0\n1 1e-3 -4e-3 14e-3 -4e-3 14e-3 -2e-3 2e-3\n2 0 0 0 0 0 0\n")
    assert imported("box.data", "box.grid").stderr.startswith(
        "treacle: error: box.data, box.grid: cannot be a case: body: no fluid: expected at least one"
    )


def test_replaces_files_only_where_it_may(shop):
    (shop / "case-wall2.csv").write_text("mine")
    done = imported("box.data", "box.grid", "-o", "case.toml")
    assert done.returncode == 2
    assert done.stderr == "treacle: error: case-wall2.csv: is already there; --force replaces it\n"
    assert (shop / "case-wall2.csv").read_text() == "mine"
    assert not (shop / "case-fluid1.csv").exists()
    assert treacle("import", "box.data", "box.grid", "-o", "case.toml", "--force").returncode == 0
    assert (shop / "case-wall2.csv").read_text().startswith("x,y\n-0.0035,-0.0035\n")
    done = imported("box.data", "box.grid", "-o", "box.grid", "--force")
    assert done.returncode == 2 and "box.grid: would replace a file that is imported" in done.stderr
    assert (shop / "box.grid").read_text() == particles


def test_files_that_cannot_be_written(shop):
    done = imported("box.data", "box.boid", "-o", "missing/case.toml")
    assert done.returncode == 3
    assert done.stderr == "treacle: error: cannot write missing/case.toml: No such file or directory\n"
    (shop / "case.toml").mkdir()
    done = imported("box.data", "box.grid", "-o", "case.toml", "--force")
    assert done.returncode == 3 and done.stderr == "treacle: error: cannot write case.toml: Is a directory\n"
    assert not list(shop.glob("*.tmp"))
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [program(), "import", "box.data", "box.boid"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert done.returncode == 3
    assert done.stderr == "treacle: error: cannot write to stdout: No space left on device\n"


def test_links_and_devices_stay(shop):
    (shop / "target.toml").write_text("old")
    (shop / "link.toml").symlink_to("target.toml")
    assert imported("box.data", "box.boid", "-o", "link.toml", "--force").returncode == 0
    assert (shop / "link.toml").is_symlink() and (shop / "target.toml").read_text().startswith("# The case of ")
    assert imported("box.data", "box.boid", "-o", "/dev/null").returncode == 0
    assert Path("/dev/null").is_char_device()


def test_warnings_go_to_stderr(shop):
    (shop / "box.data").write_text(parameters + "Colour 1\n")
    (shop / "box.boid").write_text(replaced(cuboids, "Velocity  0.25 -0.5 0", "Velocity 2 0 0"))
    done = imported("box.data", "box.boid", "-o", "sub-case.toml")
    assert done.returncode == 0
    first, *others = done.stderr.splitlines()
    assert first == "treacle: warning: box.data:18: 'Colour' is not a row that is known, and is left out"
    # What the program says of the case comes as well.
    assert len(others) == 1 and others[0].startswith("treacle: warning: ") and "Courant number" in others[0]


def test_needs_the_program(shop, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr("treacle.import_case.program", lambda: None)
        done = imported("box.data", "box.boid")
    assert done.returncode == 2 and "the program treacle, which checks what is imported, is not found" in done.stderr
    monkeypatch.setenv("TREACLE_PROGRAM", "/no/such/program")
    done = imported("box.data", "box.boid")
    assert done.returncode == 2 and "/no/such/program: No such file or directory" in done.stderr
    assert not (shop / "box.toml").exists()


bad_words = [
    b"nan", b"inf", b"1e999", b"1e-999", b"-1e300", b"1e300", b"1_0", b"0x10", b"-1", b"--", b"text",
    b"\xff\xfe", b"\0", b"4294967297", b"9" * 5000, b"1" * 60, "ü".encode(), b"#", b"StartCuboid",
]  # fmt: skip


def damaged(content, random):
    """Cut off, with a wrong word, without a line, with a line twice, or with a byte too many."""
    kind, lines = random.randrange(5), content.split(b"\n")
    line = random.randrange(len(lines))
    if kind == 0:
        return content[: random.randrange(len(content))]
    if kind == 1:
        words = lines[line].split(b" ")
        words[random.randrange(len(words))] = random.choice(bad_words)
        lines[line] = b" ".join(words)
    elif kind == 2:
        del lines[line]
    elif kind == 3:
        lines.insert(line, random.choice(lines))
    else:
        place = random.randrange(len(content))
        return content[:place] + bytes([random.randrange(256)]) + content[place:]
    return b"\n".join(lines)


@pytest.mark.parametrize("geometry", ["box.boid", "box.grid"])
def test_damaged_files_end_with_a_message(shop, geometry):
    """What is taken is a case that the program reads; all else is refused with exit code 2, and nothing is left."""
    chance = random.Random(1)
    contents = {name: (shop / name).read_bytes() for name in ("box.data", geometry)}
    outcomes = {0: 0, 2: 0}
    for _ in range(150):
        name = chance.choice(list(contents))
        (shop / name).write_bytes(content := damaged(contents[name], chance))
        done = imported("box.data", geometry, "-o", "case.toml")
        outcomes[done.returncode] += 1
        if done.returncode == 0:
            for path in shop.glob("case*"):
                path.unlink()
        else:
            assert done.stderr.startswith("treacle: error: box."), content
            assert done.stderr.count("\n") == 1 and len(done.stderr) < 6000 and done.stdout == "", content
            assert not list(shop.glob("case*")), content
        (shop / name).write_bytes(contents[name])
    assert min(outcomes.values()) > 10


def test_damaged_files_leave_no_traceback(shop):
    (shop / "box.data").write_bytes(parameters.encode().replace(b"1.8", b"\xff\xfe\0"))
    done = treacle("import", "box.data", "box.boid", PYTHONIOENCODING="ascii")
    assert done.returncode == 2
    assert done.stderr == "treacle: error: box.data:7: expected a finite number, found '\\xff\\xfe\0'\n"
