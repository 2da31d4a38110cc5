"""What is measured: kernels and events by strata_bench, whole runs through the command line."""

import json
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from verification.benchmarks.machine import STEP, Figure
from verification.harness.paths import EXPERIMENTS, ROOT
from verification.harness.run import Job, make
from verification.harness.scenes import STUDY_VARIANTS, variants_of

# Beyond this working set a step waits for memory rather than for the core (twice a last cache of 32 MB).
LARGE_B = 64e6
# What a unit of work is, by the first part of a benchmark's name.
PER = {
    "step": STEP, "scaling": STEP, "stage": STEP, "growth": "increment", "start": "start", "contact": "solve", "flow": "flow step",
    "write": "writing", "calibration": "measurement",
}  # fmt: skip
CALLS = ("stage/momentum", "stage/surfaces", "stage/measure_tips")  # do not pass over all particles: their unit is a call
SCALE = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}

Rates = Callable[[int], tuple[float, float]]


class NoBenchmark(Exception):
    """strata_bench could not be run, or said nothing that can be read; the message is its own."""


# --- kernels
def _bench(*options: str, shown: bool = False) -> str:
    """What strata_bench ($STRATA_BENCH, or that of the release build) says; `shown`: tell each benchmark as it is done."""
    program = os.environ.get("STRATA_BENCH", str(ROOT / "build" / "release" / "strata_bench"))
    environment, said = {**os.environ, "OMP_PROC_BIND": "true", "OMP_PLACES": "cores"}, []
    try:
        with subprocess.Popen([program, *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment) as process:
            for line in process.stdout or ():
                said.append(line)
                if shown and "_median " in line:
                    print(_plain(line.split("_median ")[0]), file=sys.stderr, flush=True)
    except OSError as error:
        raise NoBenchmark(f"{program}: {error}") from error
    if process.returncode != 0:
        raise NoBenchmark(f"{program}: exit status {process.returncode}")
    return "".join(said)


def _plain(name: str) -> str:
    """A benchmark's name without what Google Benchmark hangs on it (iterations:5, manual_time)."""
    return "/".join(part for part in name.split("/") if not part.startswith(("iterations:", "repeats:")) and part != "manual_time")


def names() -> list[str]:
    """All benchmarks there are, as strata_bench lists them."""
    return [_plain(line) for line in _bench("--benchmark_list_tests=true").splitlines() if line.strip()]


def measure(chosen: Iterable[str], repetitions: int, shown: bool = True) -> tuple[list[Figure], dict[str, Any]]:
    """Run benchmarks by their names so many times each; the figures, and the context that strata_bench gives (compiler, flags)."""
    pattern = "^(" + "|".join(re.escape(name) for name in chosen) + ")(/iterations:[0-9]+)?(/manual_time)?$"
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "figures.json"
        _bench(f"--benchmark_filter={pattern}", f"--benchmark_repetitions={repetitions}", "--benchmark_display_aggregates_only=true",
               f"--benchmark_out={out}", "--benchmark_out_format=json", shown=shown)  # fmt: skip
        try:
            content = json.loads(out.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise NoBenchmark(f"strata_bench: {error}") from error
    return parse(content), content.get("context", {})


def parse(content: dict[str, Any]) -> list[Figure]:
    """The figures in what Google Benchmark wrote as JSON: repetitions of a name together, means and medians of its own left out."""
    found: dict[str, list[dict[str, Any]]] = {}
    for entry in content.get("benchmarks", []):
        if entry.get("run_type", "iteration") == "iteration":
            found.setdefault(_plain(entry["name"]), []).append(entry)
    return [figure_of(name, entries) for name, entries in found.items()]


def figure_of(name: str, entries: list[dict[str, Any]]) -> Figure:
    """One figure from its repetitions: seconds a unit of work."""
    failed = [str(entry.get("error_message", "an error")) for entry in entries if entry.get("error_occurred")]
    a_call, one = name.startswith(CALLS), entries[0]
    per = "call" if a_call else PER.get(name.split("/")[0], "unit")
    if failed:
        return Figure(name, per, (), problem=failed[0])
    about: dict[str, Any] = dict(pair.partition("=")[::2] for pair in one.get("label", "").split())
    about |= {key: float(one[key]) for key in ("flop_a_unit", "byte_a_unit", "particles", "places") if one.get(key)}
    if about.get("kinematics") == "total":
        about["equivalent"] = "flop of the form with particles, which this one need not do"
    large = about.get("particles", 0.0) * about.get("byte_a_unit", 0.0) > LARGE_B
    seconds = tuple(float(e["real_time"]) * SCALE[e.get("time_unit", "ns")] / (1.0 if a_call else float(e["units"])) for e in entries)
    peak, stream, trip = (tuple(float(e[key]) for e in entries) for key in ("peak_flop_s", "stream_B_s", "round_trip_s"))
    threads = int(one["threads_used"])
    return Figure(name, per, seconds, threads=threads, bound="memory" if large else "core", peak_flop_s=peak, stream_B_s=stream,
                  round_trip_s=trip if threads > 1 else (), about=about)  # fmt: skip


def rates(threads: int) -> tuple[float, float]:
    """The machine's rates on so many threads now: flop/s and B/s."""
    found, _ = measure([f"calibration/threads{threads}"], 1, shown=False)
    if not found or found[0].wrong():
        raise NoBenchmark("strata_bench has no calibration")
    return found[0].peak_flop_s[0], found[0].stream_B_s[0]


# --- whole runs
JOBS = min(2, os.cpu_count() or 1)  # side by side: two, as the marks are for two cores
SHIPPED_M = 1.0  # cells of the experiments, m
TURNING = ("exp5_parallel_interface", "exp6_stress_reversal")  # paths that turn: the scenes say where fine cells end


@dataclass(frozen=True)
class Whole:
    """Runs that are timed from the first's start to the last's end, so many times, within so many seconds each."""

    name: str
    jobs: tuple[Job, ...]
    repetitions: int
    limit_s: float = math.inf


def wholes(quick: bool = False, long: bool = False, repetitions: int = 5) -> list[Whole]:
    """Experiment 1 with a soft interface, without inertia, at several cell sizes; then all variants of all experiments."""
    found = []
    for cell in (4.0, 2.0) if quick else (2.0, 1.0, 0.5, 0.25):
        keys = ("numerics.mechanics=quasistatic", f"numerics.cell_m={cell:g}", f"numerics.far_cell_m={cell:g}", "fracture.increment_m=2")
        job = Job(EXPERIMENTS / "exp1_single_interface.toml", "soft", Path(), keys)
        found.append(Whole(f"whole/quasistatic/exp1_soft/cell{cell:g}m", (job,), repetitions if cell >= 0.5 else 1))
    if quick:
        return [*found, batch("quasistatic", 1.0, 1, 60.0, "exp1")]
    if long:
        return [*found, batch("quasistatic", 1.0, 5, 120.0), batch("explicit", 1.0, 3, 3600.0), batch("quasistatic", 0.25, 1, 1800.0)]
    return [*found, batch("quasistatic", 1.0, 3, 120.0), batch("explicit", 1.0, 1, 150.0)]


def batch(mechanics: str, cell_m: float, repetitions: int, limit_s: float, only: str = "") -> Whole:
    """The study's variants of all experiments (that begin so) on the scenes' graded grids, those that take longest first.

    Below the scenes' cell size an interface that is weak fails as far as it is long (experiments/README.md, "What to expect"), so cells are
    fine along all of it.
    """
    keys, along = (f"numerics.mechanics={mechanics}", f"numerics.cell_m={cell_m:g}"), ("numerics.fine_left_m=0", "numerics.fine_right_m=80")
    jobs = []
    for scene in sorted(EXPERIMENTS.glob(f"{only}*.toml"), key=lambda scene: (scene.stem not in TURNING, scene.stem)):
        for variant in (name for name in variants_of(scene) if name in STUDY_VARIANTS):
            fails = cell_m < SHIPPED_M and "weak" in variant and scene.stem not in TURNING
            jobs.append(Job(scene, variant, Path(), (*keys, *(along if fails else ()))))
    return Whole(f"experiments/{mechanics}/cell{cell_m:g}m{f'/{only}' if only else ''}", tuple(jobs), repetitions, limit_s)


def taken(job: Job, until: float) -> tuple[str, int]:
    """Why a run in a folder that is not kept, ended where time.monotonic() passes `until`, has no result ("": it has one), and its points."""
    left = until - time.monotonic()
    if left <= 0.0:
        return "not begun: the time for these runs was over", 0
    with tempfile.TemporaryDirectory() as folder:
        outcome, run = make(replace(job, out=Path(folder) / "run"), limit_s=left if math.isfinite(left) else None)
        return ("", run.summary.particles) if outcome.ok and run is not None else (outcome.reason, 0)


def whole_figure(whole: Whole, rates: Rates = rates) -> Figure:
    """The wall time of runs with the machine's rates before and after them; a run alone that is repeated is made once more, as warm-up."""
    alone = len(whole.jobs) == 1
    threads, warm = (1, int(whole.repetitions > 1)) if alone else (JOBS, 0)
    figure = Figure(whole.name, "run" if alone else "all variants", (), threads=threads)
    before, seconds, points = rates(threads), [], 0
    for _ in range(warm + whole.repetitions):
        begun = time.monotonic()
        with ThreadPoolExecutor(JOBS) as pool:
            ended = list(pool.map(lambda job: taken(job, begun + whole.limit_s), whole.jobs))
        seconds.append(time.monotonic() - begun)
        problems = [f"{job.scene.stem}/{job.variant}: {problem}" for job, (problem, _) in zip(whole.jobs, ended) if problem]
        if problems:
            done = f"{len(ended) - len(problems)} of {len(ended)} runs came to their end in {seconds[-1]:.0f} s"
            return replace(figure, problem=problems[0] if alone else f"{done}; {problems[0]}")
        points = sum(points for _, points in ended)
    peak, stream = map(statistics.mean, zip(before, rates(threads)))
    values = tuple(seconds[warm:])
    return replace(figure, values=values, peak_flop_s=(peak,) * len(values), stream_B_s=(stream,) * len(values),
                   about={"particles": points, "runs": len(whole.jobs), "limit_s": whole.limit_s})  # fmt: skip
