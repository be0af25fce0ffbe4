"""The cases of both papers, and their solvers, in treacle's words."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """A case file with overrides. factor: resolution, diffusion factor or width, whatever its series varies; end: time of the
    system that is looked at [s]; full_end: the papers' [s], where `end` is a shortened form."""

    name: str
    label: str
    series: str
    factor: float
    file: str
    settings: tuple
    particles: int
    step: float
    end: float
    full_end: float

    @property
    def shortened(self):
        return self.end < self.full_end

    @property
    def full_label(self):
        return "3D " * (self.series == "3d") + self.label + (f" ({self.end:g} s)" if self.shortened else "")


def size_label(f):
    return f"x{1 / f:g}" if f <= 1 else f"x1/{f:g}"


def scaled(f):
    """Case x1/f of [K23 Table 2]. The 12,800 steps of x1/64 would take 20 minutes: it ends at 0.01 s."""
    end = 0.2 if f < 64 else 0.01
    return Case(
        f"2d-{f}", size_label(f), "2d", f, "published/dam-break-2d.toml", (f"resolution={f}",), 400 * f * f, 1e-3 / f, end, 0.2
    )


def small(k):
    """Diffusion numbers times k at the size of x1 [K23 Table 3]."""
    if k == 1:
        return scaled(1)
    return Case(f"small-{k}", f"d x{k}", "small", k, f"small/dam-break-2d-d{k}.toml", (), 400, 1e-3, 0.2, 0.2)


def cube(f):
    """Case x1/f of [K23 Table 4]; f = 0.5 is x2."""
    n = round(8000 * f**3)
    return Case(f"3d-{f:g}", size_label(f), "3d", f, "published/dam-break-3d.toml", (f"resolution={f}",), n, 1e-3 / f, 0.2, 0.2)


def isph(width):
    """The dam break of [O23 Table 1], so many times as wide, at the time of its Fig. 7."""
    return Case(
        f"isph-{width}",
        f"width {width}",
        "isph",
        width,
        "isph-dam-break.toml",
        (f"width.factor={width}",),
        58621 * width,
        1e-2,
        3.2,
        3.2,
    )


def trial_steps(case):
    """The first step is the system at the end of the state and a warm-up; times are those of the others' median step."""
    return 6 if case.particles <= 30000 else 4 if case.particles <= 1e6 else 3


resolutions = (1, 2, 4, 8, 16, 32, 64)
cpu_resolutions = (1, 2, 4, 8)
thread_resolutions = (1, 2, 4, 8, 16)
thread_counts = (1, 2, 4, 8, 16)
diffusion_factors = (1, 2, 4, 8, 16, 32, 64)
cube_resolutions = (0.5, 1, 2, 4)
widths = (1, 2, 4, 8, 16, 64)

published_way = ("precision=double", "first_guess=last", "deflation=0", "max_iterations=100000")
multigrid = "preconditioner=bucket-multigrid"
printed_multigrid = (
    "multigrid.finest_sweeps=2",
    "multigrid.middle_sweeps=2",
    "multigrid.coarsest_sweeps=4",
    "multigrid.particle_diagonal=extended-jacobi",
)

# Keys of [solver]. MGCG and MGCR have the sweeps and the diagonal of the authors' program, "MGCR as printed" those of the
# paper's text.
solvers = {
    "CG": ("krylov=cg", "preconditioner=none", *published_way),
    "CR": ("krylov=cr", "preconditioner=none", *published_way),
    "MGCG": ("krylov=cg", multigrid, *published_way),
    "MGCR": ("krylov=cr", multigrid, *published_way),
    "MGCR as printed": ("krylov=cr", multigrid, *printed_multigrid, *published_way),
    "ours": (),
}
four = ("CG", "CR", "MGCG", "MGCR")

cells = "preconditioner=cell-multigrid precision=double cells.sweeps=4 cells.levels="
isph_solvers = {
    "CG": "preconditioner=none precision=double",
    "MGCG(1,4)": cells + "1",
    "MGCG(2,4)": cells + "2",
    "MGCG(all,4)": cells + "0",
    "ours": "",
}
