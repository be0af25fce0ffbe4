"""The statements of both papers' conclusions and abstracts, and of what they rest on, each judged by our numbers."""

from collections.abc import Callable
from dataclasses import dataclass

import judge_iterations
import judge_times


@dataclass(frozen=True)
class Statement:
    """rule: what the verdict follows from. item: the figure that it is about, "" if several. judge: Results to (verdict,
    numbers), or None where nothing was measured."""

    source: str
    text: str
    rule: str
    item: str
    judge: Callable


every = "in every case: confirmed; in some: partly"
k5, o5 = "[K23] sect. 5", "[O23] sect. 5"
statements = [
    Statement(
        k5,
        "The SPD matrix, derived by substituting the pressure, appears in physically consistent systems; CG and CR can "
        "solve it.",
        "all trials without a preconditioner converge",
        "",
        judge_iterations.converged(["CG", "CR"]),
    ),
    Statement(
        k5,
        "The bucket-based preconditioner satisfies the conditions for CG and CR; the extended Jacobi iteration can be "
        "applied to matrices that are not diagonally dominant.",
        "all trials with it converge, as printed, too",
        "",
        judge_iterations.converged(["MGCG", "MGCR", "MGCR-as-printed"]),
    ),
    Statement(
        k5,
        "The number of iterations could be suppressed by the multigrid solvers.",
        f"fewer {every}",
        "",
        judge_iterations.suppressed,
    ),
    Statement(
        k5,
        "The number of iterations was smaller with the CR solvers than with the CG solvers, with and without preconditioning.",
        f"fewer {every}",
        "k23-fig3",
        judge_iterations.residuals_below_gradients,
    ),
    Statement(
        k5,
        "MGCR showed the best performance of the four.",
        f"fewest iterations and, at the largest size on one CPU thread, least time, {every}",
        "",
        judge_times.best_of_four,
    ),
    Statement(
        k5,
        "The number of iterations (of MGCR) hardly depended on the problem size.",
        "grows as N^p, p < 0.06: confirmed; p < 0.1: partly",
        "k23-fig3",
        judge_iterations.hardly_depends,
    ),
    Statement(
        f"{k5}, abstract",
        "The time on a single CPU was almost proportional to the numbers of particles and time steps: it scales.",
        "unit times within a factor of 1.5: confirmed; 2.5: partly",
        "k23-fig6",
        judge_times.proportional,
    ),
    Statement(
        k5,
        "In parallel, MGCR and MGCG were slower than CR and CG for small problems, because of overhead.",
        f"slower in x1 … x1/4, {every}",
        "k23-fig8",
        judge_times.small_slower,
    ),
    Statement(
        k5,
        "MGCR and MGCG showed better performance than conventional solvers for large problems.",
        f"faster from x1/8 on, {every}",
        "k23-fig8",
        judge_times.large_faster,
    ),
    Statement(
        "[K23] sect. 4.1",
        "Multigrid also suppresses the iterations due to large diffusion numbers.",
        f"fewer {every}",
        "k23-fig4",
        judge_iterations.small_cases,
    ),
    Statement(
        "[K23] sect. 4.1",
        "Scaled cases take fewer iterations than small cases of the same diffusion numbers.",
        f"fewer {every}",
        "k23-fig5",
        judge_iterations.scaled_below_small,
    ),
    Statement(
        "[K23] sect. 4.1",
        "MGCR shows better scalability than MGCG.",
        "smaller p in N^p",
        "k23-fig5",
        judge_iterations.better_scalability,
    ),
    Statement(
        "[K23] sect. 4.2",
        "Most of the time is spent by the solvers (one thread).",
        f"more than half {every}",
        "k23-fig7",
        judge_times.solver_share,
    ),
    Statement(
        "[K23] sect. 4.2",
        "On one thread, preconditioning needs less than the main iterations.",
        f"less {every}",
        "k23-fig7",
        judge_times.preconditioning_minor,
    ),
    Statement(
        "[K23] sect. 4.3",
        "On a GPU, too, the solvers dominate.",
        f"more than half {every}",
        "k23-fig9",
        judge_times.gpu_solver_share,
    ),
    Statement(
        "[K23] sect. 4.3",
        "The unit time of CR on a GPU falls at first and increases again in large cases.",
        "its least value is inside the series",
        "k23-fig9",
        judge_times.cr_turns,
    ),
    Statement(
        "[K23] sect. 4.3",
        "On a GPU, the unit time of preconditioning falls over the whole range.",
        f"falls from size to size {every}",
        "k23-fig9",
        judge_times.preconditioning_falls,
    ),
    Statement(
        "[K23] sect. 4.3",
        "The unit time of MGCR's main iterations is almost constant from 102,400 particles on.",
        "within a factor of 1.5: confirmed; 2.5: partly",
        "k23-fig9",
        judge_times.main_constant,
    ),
    Statement(
        "[K23] sect. 4.3",
        "With more threads the overhead is larger and dominates in a wider range.",
        "the speed-up of the most threads is larger at the largest size than at the smallest",
        "k23-fig10",
        judge_times.overhead_of_threads,
    ),
    Statement(
        "[K23] sect. 4.4",
        "In 3D, CR suffers from large numbers of iterations, MGCR suppresses them.",
        "MGCR's p in N^p less than half of CR's: confirmed; less than CR's: partly",
        "k23-fig13",
        judge_iterations.cube_iterations,
    ),
    Statement(
        "[K23] sect. 4.4",
        "In 3D on a GPU, MGCR is slower in small cases (x2, x1) and faster in large ones.",
        f"{every}",
        "k23-fig14",
        judge_times.cube_times,
    ),
    Statement(
        o5, "The number of main iterations was greatly reduced.", f"fewer {every}", "o23-fig7", judge_iterations.isph_reduced
    ),
    Statement(
        "[O23] sect. 4.2",
        "More grids take fewer iterations at the same number of sweeps.",
        f"fewer {every}",
        "o23-fig7",
        judge_iterations.isph_levels,
    ),
    Statement(
        "[O23] sect. 4.2",
        "Iterations of CG increase with the number of particles; with MGCG they are suppressed.",
        "CG grows, MGCG(2,4) by fewer",
        "o23-fig8",
        judge_iterations.isph_sizes,
    ),
    Statement(
        "[O23] abstract",
        "The preconditioner is practical for ISPH.",
        f"less time than CG, set-up included, {every}",
        "o23-fig8",
        judge_iterations.isph_practical,
    ),
]
