"""Whole runs: the experiments, K_I of a pressurised crack, how the cost of runs without inertia grows, memory a point."""

import os
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from verification.benchmarks.figure import NONE, Figure
from verification.harness.load import LoadError, Summary, read_summary
from verification.harness.paths import ANALYTIC, EXPERIMENTS, ROOT
from verification.harness.reference import value
from verification.harness.run import TOO_LONG, Job, run, timed
from verification.harness.scenes import STUDY_VARIANTS, variants_of

BLOCK = ROOT / "verification" / "benchmarks" / "block.toml"
CRACK = ANALYTIC / "static_quasistatic.toml"
NET_PA = 0.3e6  # of static_quasistatic.toml: pressure above the closing stress

SHIPPED_M = 1.0  # cells of the experiments, m
TURNING = ("exp5_parallel_interface", "exp6_stress_reversal")  # paths that turn: the scenes say where fine cells end

# Runs side by side in a batch: two, as the marks are for two cores.
JOBS = min(2, os.cpu_count() or 1)

Rates = Callable[[], tuple[float, float]]
Tell = Callable[[str], None]


# --- runs as a user makes them


def job_of(scene: Path, *settings: str, variant: str = "") -> Job:
    """A run to be made, in a folder that is not kept."""
    return Job(scene, variant, Path(), settings)


def name_of(job: Job) -> str:
    """Scene and variant."""
    return f"{job.scene.stem}/{job.variant or 'default'}"


@dataclass(frozen=True)
class Taken:
    """What a run took: seconds from start to end of the process; its summary, or why there is none."""

    job: Job
    seconds: float
    summary: Summary | None
    problem: str = ""


def size_of(summary: Summary) -> dict[str, Any]:
    """How large a run was."""
    return {"particles": summary.particles, "steps": summary.steps}


def take(job: Job, until: float = float("inf")) -> Taken:
    """Make a run in a folder that is not kept; it is ended where time.monotonic() passes `until`."""
    left = until - time.monotonic()
    if left <= 0.0:
        return Taken(job, 0.0, None, "not begun: the time for these runs was over")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        outcome = run(replace(job, out=out), limit_s=left if left < float("inf") else None)
        if outcome.exit_status == TOO_LONG:
            return Taken(job, outcome.wall_s, None, "ended: the time for these runs was over")
        try:
            summary = read_summary(out / "summary.json")
        except LoadError:
            return Taken(job, outcome.wall_s, None, outcome.reason)
    return Taken(job, outcome.wall_s, summary, "" if outcome.ok else f"exit status {outcome.exit_status}: {summary.reason}")


def take_all(every: Sequence[Job], jobs: int, limit_s: float, tell: Tell) -> tuple[float, list[Taken]]:
    """Make runs side by side, for `limit_s` at most; seconds from the first's start to the last's end, and each run."""
    start = time.monotonic()

    def one(job: Job) -> Taken:
        taken = take(job, start + limit_s)
        tell(f"{name_of(job)}: {taken.problem or f'{taken.seconds:.2f} s'}")
        return taken

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        taken = list(pool.map(one, every))
    return time.monotonic() - start, taken


def figure_beside(name: str, per: str, work: Callable[[], list[float]], rates: Rates, threads: int = 1) -> Figure:
    """What work finds, each with the mean of the machine's rates before and after it all: flop/s and B/s."""
    before = rates()
    found = work()
    peak, stream = (0.5 * (a + b) for a, b in zip(before, rates()))
    return Figure(name, per, tuple(found), threads=threads, peak_flop_s=(peak,) * len(found), stream_B_s=(stream,) * len(found))


# --- all experiments


@dataclass(frozen=True)
class Batch:
    """All default variants in one mechanics at one cell size, within so many seconds; `only`: of experiments that begin so."""

    mechanics: str
    cell_m: float
    repetitions: int
    limit_s: float
    only: str = ""

    @property
    def name(self) -> str:
        """The figure's name."""
        return f"experiments/{self.mechanics}/cell{self.cell_m:g}m{f'/{self.only}' if self.only else ''}"


QUICK = (Batch("quasistatic", 1.0, 1, 60.0, "exp1"),)
DEFAULT = (Batch("quasistatic", 1.0, 3, 120.0), Batch("explicit", 1.0, 1, 150.0))
LONG = (Batch("quasistatic", 1.0, 5, 120.0), Batch("explicit", 1.0, 3, 3600.0), Batch("quasistatic", 0.25, 1, 1800.0))


def jobs_of(batch: Batch) -> list[Job]:
    """The runs of a batch on the scenes' graded grids, those that take longest first.

    Below the scenes' cell size an interface that is weak fails as far as it is long (experiments/README.md, "What to expect"), so cells
    are fine along all of it.
    """
    keys = (f"numerics.mechanics={batch.mechanics}", f"numerics.cell_m={batch.cell_m:g}")
    along = ("numerics.fine_left_m=0", "numerics.fine_right_m=80")
    runs = []
    for scene in sorted(EXPERIMENTS.glob(f"{batch.only}*.toml"), key=lambda scene: (scene.stem not in TURNING, scene.stem)):
        for variant in [name for name in variants_of(scene) if name in STUDY_VARIANTS]:
            fails = batch.cell_m < SHIPPED_M and "weak" in variant and scene.stem not in TURNING
            runs.append(job_of(scene, *keys, *(along if fails else ()), variant=variant))
    return runs


def batch_figures(batch: Batch, rates: Rates, tell: Tell) -> list[Figure]:
    """The time from the first run's start to the last one's end, JOBS at a time, and each run's own (the solver's seconds)."""
    every: list[list[Taken]] = []
    wholes: list[Figure] = []
    cpu_s = 0.0
    while len(every) < batch.repetitions and not any(run.problem for runs in every for run in runs):

        def once() -> list[float]:
            nonlocal cpu_s
            (seconds, taken), (_, cpu_s) = timed(lambda: take_all(jobs_of(batch), JOBS, batch.limit_s, lambda words: tell(f"{batch.name}: {words}")))
            every.append(taken)
            return [seconds]

        wholes.append(figure_beside(batch.name, "all variants", once, rates, JOBS))
    last = every[-1]
    problems = [f"{name_of(run.job)}: {run.problem}" for run in last if run.problem]
    done = len(last) - len(problems)
    about = {"runs": len(last), "completed": done, "jobs": JOBS, "limit_s": batch.limit_s, "cpu_s": round(cpu_s, 2)}
    elapsed, peaks, streams = (tuple(getattr(one, name)[0] for one in wholes) for name in ("values", "peak_flop_s", "stream_B_s"))
    whole = replace(wholes[0], about=about, values=elapsed, peak_flop_s=peaks, stream_B_s=streams)
    if problems:
        problem = f"{done} of {len(last)} runs came to their end in {elapsed[-1]:.0f} s; {problems[0]}"
        whole = replace(whole, values=(), peak_flop_s=(), stream_B_s=(), problem=problem)
    figures = [whole]
    for runs in zip(*every):
        own = Figure(f"{batch.name}/{name_of(runs[0].job)}", "run", (), threads=JOBS, problem=next((run.problem for run in runs if run.problem), ""))
        if not own.problem:
            summaries = [run.summary for run in runs if run.summary is not None]
            seconds, first = tuple(one.wall_s for one in summaries), summaries[0]
            own = replace(own, values=seconds, about=size_of(first), peak_flop_s=peaks, stream_B_s=streams)
        figures.append(own)
    return figures


# --- single runs


def repeated(name: str, job: Job, repetitions: int, rates: Rates, tell: Tell, about: Callable[[Summary], dict[str, Any]]) -> Figure:
    """A run made so many times, after one that is not counted (seconds of the whole process), with what is told of the last of them.

    A run that is made once only, because it takes long, has none before it.
    """
    taken = [take(job)] if repetitions > 1 else []

    def again() -> list[float]:
        taken.extend(take(job) for _ in range(repetitions))
        return [one.seconds for one in taken[-repetitions:]]

    failed = taken and taken[0].problem
    figure = Figure(name, "run", ()) if failed else figure_beside(name, "run", again, rates)
    last = taken[-1]
    figure = replace(figure, problem=last.problem, about=about(last.summary) if last.summary is not None else {})
    tell(f"{name}: {figure.problem or f'{figure.median:.3g} s'}")
    return figure


def crack_jobs(quick: bool) -> dict[str, Job]:
    """The pressurised crack in the block, as one equilibrium: uniform and graded grids."""
    sizes = {"uniform": (1.0,) if quick else (2.0, 1.0, 0.5), "graded": (0.5,) if quick else (1.0, 0.5, 0.25, 0.125)}
    return {
        f"crack/{grid}/cell{cell:g}m": job_of(CRACK, f"numerics.cell_m={cell:g}", *(["numerics.far_cell_m=8"] if grid == "graded" else []))
        for grid, cells in sizes.items() for cell in cells
    }  # fmt: skip


def crack_figures(repetitions: int, quick: bool, rates: Rates, tell: Tell) -> list[Figure]:
    """Time of each setting, with the error of K_I against strata-reference's crack in a finite block."""
    exact = value("block_crack", "K_I", half_length_m=5.0, pressure_Pa=NET_PA, width_m=80.0, half_height_m=80.0)

    def about(summary: Summary) -> dict[str, float]:
        found = summary.tips[0].K_I_Pa_sqrt_m
        error = found / exact - 1.0
        return {"K_I": found, "reference": exact, "error": error, "particles": summary.particles, "solver_s": summary.wall_s}

    return [repeated(name, job, repetitions, rates, tell, about) for name, job in crack_jobs(quick).items()]


def growth_figures(repetitions: int, quick: bool, rates: Rates, tell: Tell) -> list[Figure]:
    """A whole run without inertia, Experiment 1 with a soft interface, at several cell sizes."""
    figures = []
    for cell in (4.0, 2.0) if quick else (2.0, 1.0, 0.5, 0.25):
        keys = ("numerics.mechanics=quasistatic", f"numerics.cell_m={cell:g}", f"numerics.far_cell_m={cell:g}", "fracture.increment_m=2")
        name, job = f"whole/quasistatic/exp1_soft/cell{cell:g}m", job_of(EXPERIMENTS / "exp1_single_interface.toml", *keys, variant="soft")
        figures.append(repeated(name, job, repetitions if cell >= 0.5 else 1, rates, tell, size_of))
    return figures


# Memory is measured between two sizes of the block, so that what every process holds does not count.
MEMORY_CELLS = (160, 320)
MEMORY_KINDS: dict[str, tuple[str, ...]] = {
    "explicit_updated": ("numerics.kinematics=updated",),
    "explicit_total": ("numerics.kinematics=total",),
    "quasistatic": ("numerics.mechanics=quasistatic",),
}


def memory_figures(quick: bool, tell: Tell) -> list[Figure]:
    """The most memory that a run of few steps holds, by the points that it has more than a smaller one (B a point)."""
    figures = []
    for kind, keys in MEMORY_KINDS.items():
        taken = []
        for cells in (40, 80) if quick else MEMORY_CELLS:
            cell = 80.0 / cells
            few = f"{3 * 0.5 * cell / 2108.0:.6g}" if kind != "quasistatic" else "0"
            taken.append(take(job_of(BLOCK, *keys, f"numerics.cell_m={cell:g}", f"stop.time_s={few}", "output.fields_every_s=1")))
        held = [(float(one.summary.particles), 1e6 * one.summary.peak_memory_MB) for one in taken if one.summary is not None]
        figures.append(memory_figure(f"memory/{kind}", held, next((one.problem for one in taken if one.problem), "")))
        tell(f"memory/{kind}: {figures[-1].problem or f'{figures[-1].median:.0f} B a point'}")
    return figures


def memory_figure(name: str, held: Sequence[tuple[float, float]], problem: str = "") -> Figure:
    """Memory a point from two runs (points, B): the difference of memory over that of points."""
    if problem or len(held) < 2:
        return Figure(name, "point", (), unit="B", bound=NONE, problem=problem or "no two runs")
    (few, small), (many, large) = held[0], held[-1]
    about = {"points": many, "held_MB": large / 1e6}
    return Figure(name, "point", ((large - small) / (many - few),), unit="B", bound=NONE, about=about)
