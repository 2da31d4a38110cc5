"""Whole runs: the experiments, K_I of a pressurised crack, how the cost of runs without inertia grows, memory a point."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from verification.benchmarks.figure import NONE, Figure
from verification.benchmarks.process import Setting, Taken, take, take_all
from verification.harness.paths import ANALYTIC, EXPERIMENTS, ROOT
from verification.harness.reference import value

BLOCK = ROOT / "verification" / "benchmarks" / "block.toml"
CRACK = ANALYTIC / "static_quasistatic.toml"
NET_PA = 0.3e6  # of static_quasistatic.toml: pressure above the closing stress

# The study's interfaces; Experiment 3 has two of them.
VARIANTS: dict[str, tuple[str, ...]] = {
    **{name: ("perfect", "friction", "weak", "soft") for name in (
        "exp1_single_interface", "exp2_soft_above", "exp4_soft_between", "exp5_parallel_interface", "exp6_stress_reversal")},
    "exp3_two_interfaces": ("perfect", "weak_soft", "soft_weak"),
}  # fmt: skip

SHIPPED_M = 1.0  # cells of the experiments, m
TURNING = ("exp5_parallel_interface", "exp6_stress_reversal")  # paths that turn: the scenes say where fine cells end

# Runs side by side in a batch: two, as the marks are for two cores.
JOBS = min(2, os.cpu_count() or 1)

Rates = Callable[[], tuple[float, float]]
Tell = Callable[[str], None]


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


def settings_of(batch: Batch) -> list[Setting]:
    """The runs of a batch on the scenes' graded grids, those that take longest first.

    Below the scenes' cell size an interface that is weak fails as far as it is long (experiments/README.md, "What to expect"), so cells
    are fine along all of it.
    """
    keys = (f"numerics.mechanics={batch.mechanics}", f"numerics.cell_m={batch.cell_m:g}")
    along = ("numerics.fine_left_m=0", "numerics.fine_right_m=80")
    runs = []
    for name, variants in VARIANTS.items():
        for variant in variants if name.startswith(batch.only) else ():
            fails = batch.cell_m < SHIPPED_M and "weak" in variant and name not in TURNING
            runs.append(Setting(EXPERIMENTS / f"{name}.toml", variant, (*keys, *along) if fails else keys))
    return sorted(runs, key=lambda run: run.scene.stem not in TURNING)


def beside(work: Callable[[], list[float]], rates: Rates) -> tuple[list[float], float, float]:
    """What work finds, with the mean of the machine's rates before and after it: flop/s and B/s."""
    before = rates()
    found = work()
    after = rates()
    return found, 0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1])


def batch_figures(batch: Batch, rates: Rates, tell: Tell) -> list[Figure]:
    """The time from the first run's start to the last one's end, JOBS at a time, and each run's own."""
    every: list[list[Taken]] = []
    elapsed: list[float] = []
    peaks: list[float] = []
    streams: list[float] = []
    for repetition in range(batch.repetitions):

        def once() -> list[float]:
            seconds, taken = take_all(settings_of(batch), JOBS, batch.limit_s, lambda words: tell(f"{batch.name}: {words}"))
            every.append(taken)
            return [seconds]

        found, peak, stream = beside(once, rates)
        elapsed += found
        peaks.append(peak)
        streams.append(stream)
        if any(run.problem for run in every[-1]):
            break
    problems = [f"{run.setting.name}: {run.problem}" for run in every[-1] if run.problem]
    done = len(every[-1]) - len(problems)
    about = {"runs": len(every[-1]), "completed": done, "jobs": JOBS, "limit_s": batch.limit_s,
             "cpu_s": round(sum(run.cpu_s for run in every[-1]), 2)}  # fmt: skip
    problem = f"{done} of {len(every[-1])} runs came to their end in {elapsed[-1]:.0f} s; {problems[0]}" if problems else ""
    whole = Figure(batch.name, "all variants", () if problem else tuple(elapsed), threads=JOBS, about=about, problem=problem,
                   peak_flop_s=() if problem else tuple(peaks), stream_B_s=() if problem else tuple(streams))  # fmt: skip
    return [whole, *_each(batch, every, peaks, streams)]


def _each(batch: Batch, every: Sequence[list[Taken]], peaks: list[float], streams: list[float]) -> list[Figure]:
    """A figure a run: the solver's own seconds."""
    figures = []
    for runs in zip(*every):
        good = [run for run in runs if run.summary is not None and not run.problem]
        complete = len(good) == len(every)
        about = {"particles": good[0].summary.particles, "steps": good[0].summary.steps} if complete and good[0].summary else {}
        seconds = tuple(run.summary.wall_s for run in good if run.summary)
        name, problem = f"{batch.name}/{runs[0].setting.name}", next((run.problem for run in runs if run.problem), "")
        if complete:
            rates = {"peak_flop_s": tuple(peaks), "stream_B_s": tuple(streams)}
            figures.append(Figure(name, "run", seconds, threads=JOBS, about=about, **rates))
        else:
            figures.append(Figure(name, "run", (), threads=JOBS, problem=problem))
    return figures


def repeated(name: str, per: str, setting: Setting, repetitions: int, rates: Rates) -> tuple[Figure, Taken]:
    """A run made so many times, after one that is not counted; its figure (seconds of the whole process) and the last of them.

    A run that is made once only, because it takes long, has none before it.
    """
    last = take(setting) if repetitions > 1 else Taken(setting, 0.0, 0.0, None)

    def again() -> list[float]:
        nonlocal last
        seconds = []
        for _ in range(repetitions):
            last = take(setting)
            seconds.append(last.seconds)
        return seconds

    if last.problem:
        return Figure(name, per, (), problem=last.problem), last
    found, peak, stream = beside(again, rates)
    count = len(found)
    return Figure(name, per, tuple(found), peak_flop_s=(peak,) * count, stream_B_s=(stream,) * count, problem=last.problem), last


def crack_settings(quick: bool) -> dict[str, Setting]:
    """The pressurised crack in the block, as one equilibrium: uniform and graded grids."""
    uniform = (1.0,) if quick else (2.0, 1.0, 0.5)
    graded = (0.5,) if quick else (1.0, 0.5, 0.25, 0.125)
    found = {f"crack/uniform/cell{cell:g}m": Setting(CRACK, "", (f"numerics.cell_m={cell:g}",)) for cell in uniform}
    for cell in graded:
        keys = (f"numerics.cell_m={cell:g}", "numerics.far_cell_m=8")
        found[f"crack/graded/cell{cell:g}m"] = Setting(CRACK, "", keys)
    return found


def crack_figures(repetitions: int, quick: bool, rates: Rates, tell: Tell) -> list[Figure]:
    """Time of each setting, with the error of K_I against strata-reference's crack in a finite block."""
    exact = value("block_crack", "K_I", half_length_m=5.0, pressure_Pa=NET_PA, width_m=80.0, half_height_m=80.0)
    figures = []
    for name, setting in crack_settings(quick).items():
        figure, last = repeated(name, "run", setting, repetitions, rates)
        if last.summary is not None:
            found = last.summary.tips[0].K_I_Pa_sqrt_m
            about = {"K_I": found, "reference": exact, "error": found / exact - 1.0, "particles": last.summary.particles,
                     "solver_s": last.summary.wall_s}  # fmt: skip
            figure = replace(figure, about=about)
        tell(f"{name}: {figure.problem or f'{figure.median:.3f} s'}")
        figures.append(figure)
    return figures


def growth_figures(repetitions: int, quick: bool, rates: Rates, tell: Tell) -> list[Figure]:
    """A whole run without inertia, Experiment 1 with a soft interface, at several cell sizes."""
    figures = []
    for cell in (4.0, 2.0) if quick else (2.0, 1.0, 0.5, 0.25):
        keys = ("numerics.mechanics=quasistatic", f"numerics.cell_m={cell:g}", f"numerics.far_cell_m={cell:g}", "fracture.increment_m=2")
        name = f"whole/quasistatic/exp1_soft/cell{cell:g}m"
        reps = repetitions if cell >= 0.5 else 1
        figure, last = repeated(name, "run", Setting(EXPERIMENTS / "exp1_single_interface.toml", "soft", keys), reps, rates)
        if last.summary is not None:
            figure = replace(figure, about={"particles": last.summary.particles, "steps": last.summary.steps})
        tell(f"{name}: {figure.problem or f'{figure.median:.2f} s'}")
        figures.append(figure)
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
        held: list[tuple[float, float]] = []
        problem = ""
        for cells in (40, 80) if quick else MEMORY_CELLS:
            cell = 80.0 / cells
            few = f"{3 * 0.5 * cell / 2108.0:.6g}" if kind != "quasistatic" else "0"
            settings = (*keys, f"numerics.cell_m={cell:g}", f"stop.time_s={few}", "output.fields_every_s=1")
            taken = take(Setting(BLOCK, "", settings))
            problem = problem or taken.problem
            if taken.summary is not None:
                held.append((float(taken.summary.particles), 1e6 * taken.summary.peak_memory_MB))
        figures.append(memory_figure(f"memory/{kind}", held, problem))
        tell(f"memory/{kind}: {figures[-1].problem or f'{figures[-1].median:.0f} B a point'}")
    return figures


def memory_figure(name: str, held: Sequence[tuple[float, float]], problem: str = "") -> Figure:
    """Memory a point from two runs (points, B): the difference of memory over that of points."""
    if problem or len(held) < 2:
        return Figure(name, "point", (), unit="B", bound=NONE, problem=problem or "no two runs")
    (few, small), (many, large) = held[0], held[-1]
    about = {"points": many, "held_MB": large / 1e6}
    return Figure(name, "point", ((large - small) / (many - few),), unit="B", bound=NONE, about=about)

