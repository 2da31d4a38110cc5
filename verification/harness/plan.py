"""Runs before they are made: what they will cost, whether that may be spent, and making them side by side."""

import argparse
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from verification.harness.load import LoadError, Run, load
from verification.harness.run import BAD_INPUT, Job, Outcome, done_before, load_outcome, run
from verification.harness.scenes import content_of
from verification.harness.side_by_side import Task, side_by_side

# By experience: a run of a block of 80 m with cells of 1 m takes 10 to 80 s with inertia, where steps shorten with the cells, and 1 to 7 s
# without. Seconds a point of a uniform grid, with inertia those of cells of 1 m.
SECONDS_A_POINT = {"explicit": 3.0e-3, "quasistatic": 2.6e-4}

Made = tuple[Outcome, Run | None]  # how a run ended, and its data where it has any, as every completed one has


def about_s(content: dict[str, Any]) -> float:
    """How long a scene (its keys as they will be used) takes on one thread, s, by the points of a uniform grid and their steps."""
    numerics, domain = content["numerics"], content["domain"]
    cell, mechanics = float(numerics["cell_m"]), str(numerics["mechanics"])
    points = float(domain["width_m"]) * float(domain["height_m"]) / cell**2 * float(numerics["particles_per_cell"])
    return SECONDS_A_POINT[mechanics] * points / (cell if mechanics == "explicit" else 1.0)


def expected_s(job: Job) -> float:
    """How long a job will take on one thread, s: as long as the last time, or by what its scene says; nothing where that is refused."""
    before = load_outcome(job.out)
    if before is not None and before.ok:
        return before.wall_s
    try:
        return about_s(content_of(job.scene, job.variant, job.settings))
    except ValueError:
        return 0.0


def name_of(job: Job) -> str:
    """A job by the last three folders of its place."""
    return str(job.out.relative_to(job.out.parents[2]))


def affordable(jobs: Sequence[Job], options: argparse.Namespace) -> bool:
    """Print what the jobs that are still to be made will cost; whether they may be made, by options.limit (minutes) or options.yes."""
    costs = {job: expected_s(job) for job in jobs if done_before(job) is None}
    minutes = sum(costs.values()) / 60.0 / max(options.jobs, 1)
    if costs:
        print(f"{len(costs)} of {len(jobs)} runs to make, by estimate:", *(f"  {name_of(job)}: {seconds:.0f} s" for job, seconds in costs.items()), sep="\n")
        print(f"  together about {minutes:.1f} min with {options.jobs} at a time", flush=True)
    if minutes <= options.limit or options.yes:
        return True
    print(f"above the limit of {options.limit:g} min: give --yes, a larger --limit, fewer variants or coarser cells", file=sys.stderr)
    return False


def make(job: Job, stop: threading.Event | None = None, force: bool = False, limit_s: float | None = None) -> Made:
    """Run a job (see run) and read what it wrote: one that failed as far as it came, one that was refused not at all. A completed one that cannot be
    read has failed; a folder that cannot be used fails its run alone."""
    try:
        outcome = run(job, force=force, limit_s=limit_s, stop=stop)
        return outcome, None if outcome.exit_status == BAD_INPUT else load(job.out)
    except LoadError as error:
        return replace(outcome, status="failed", reason=f"completed, but it cannot be read: {error}") if outcome.ok else outcome, None
    except OSError as error:
        return Outcome(job.scene.stem, job.variant, "failed", BAD_INPUT, str(error), 0.0, ""), None


def made_words(made: Made) -> str:
    """How a run ended, in words."""
    outcome = made[0]
    how = "done before" if outcome.skipped else f"{outcome.wall_s:.0f} s"
    return f"{outcome.status} ({how}) {outcome.reason[:160]}".rstrip()


def make_all(jobs: Sequence[Job], at_a_time: int, words: Callable[[Made], str] = made_words, **how: Any) -> list[Made]:
    """Make all jobs on so many threads, with a line for each; `how` as make has it."""
    return side_by_side([Task(name_of(job), partial(make, job, **how), words, expected_s(job), job.threads) for job in jobs], at_a_time)
