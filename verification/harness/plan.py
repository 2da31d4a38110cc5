"""Runs before they are made: what they will cost, whether that may be spent, and making them side by side."""
from __future__ import annotations

import argparse
import math
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from verification.harness.load import LoadError, Run, load
from verification.harness.paths import solver
from verification.harness.run import BAD_INPUT, Job, Outcome, done_before, key_of, load_outcome, run
from verification.harness.scenes import content_of
from verification.harness.side_by_side import Task, side_by_side

# Particle-steps a second on one thread: explicit runs of the experiments did 3 to 12 million, quasi-static ones 1 to 5 million.
SPEED = {"explicit": 8.0e6, "quasistatic": 2.0e6}

# Steps of a quasi-static run an increment of growth: 7.5 in Experiment 1 with the study's flow, 5 to 20 elsewhere.
STEPS_AN_INCREMENT = 8.0

Made = tuple[Outcome, Run | None]  # how a run ended, and its data where it has any


@dataclass(frozen=True)
class Cost:
    """An estimate: particles, steps, seconds on one thread."""

    particles: float
    steps: float
    seconds: float


def wave_speed(rock: dict[str, Any]) -> float:
    """Speed of a P wave, m/s: sqrt(E (1 - nu)/((1 + nu)(1 - 2 nu) rho))."""
    E, nu, rho = (float(rock.get(key, default)) for key, default in
                  (("youngs_modulus_Pa", 1e10), ("poisson_ratio", 0.25), ("density_kg_m3", 2500.0)))  # fmt: skip
    return math.sqrt(E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rho))


def steps_of(content: dict[str, Any], mechanics: str) -> float:
    """Steps of a run to its time or last pressure, by courant (explicit), or by experience of its increments (quasi-static)."""
    numerics, stop, inlet = content["numerics"], content.get("stop", {}), content.get("fluid", {}).get("inlet", {})
    if mechanics == "explicit":
        longest = [float(stop["time_s"])] if "time_s" in stop else []
        if "inlet_Pa" in stop and float(inlet.get("rate_Pa_s", 0.0)) > 0.0:
            longest.append((float(stop["inlet_Pa"]) - float(inlet.get("start_Pa", 0.0))) / float(inlet["rate_Pa_s"]))
        fastest = max(wave_speed(rock) for rock in content["rock"].values())
        return min(longest, default=1.0) * fastest / (float(numerics.get("courant", 0.5)) * float(numerics["cell_m"]))
    fracture = content.get("fracture", {})
    tip = max((float(point[1]) for point in fracture.get("path_m", [])), default=0.0)
    way = float(stop.get("tip_y_m", content["domain"]["height_m"])) - tip
    return STEPS_AN_INCREMENT * max(way / float(fracture.get("increment_m", 1.0)), 1.0)


def cost_of(content: dict[str, Any], mechanics: str) -> Cost:
    """The cost of a scene (its keys as they will be used) on a uniform grid, which a graded one falls short of."""
    numerics, domain = content["numerics"], content["domain"]
    cells = float(domain["width_m"]) * float(domain["height_m"]) / float(numerics["cell_m"]) ** 2
    particles, steps = cells * float(numerics.get("particles_per_cell", 4)), steps_of(content, mechanics)
    return Cost(particles, steps, particles * steps / SPEED[mechanics])


def cost_to_make(job: Job) -> Cost:
    """The cost of a job."""
    content = content_of(job.scene, job.variant, job.settings)
    return cost_of(content, str(content["numerics"]["mechanics"]))


def expected_s(job: Job) -> float:
    """How long a job will take on one thread, s: as long as the last time, or by what its scene says."""
    before = load_outcome(job.out)
    return before.wall_s if before is not None and before.ok else cost_to_make(job).seconds


def name_of(job: Job) -> str:
    """A job by the last three folders of its place."""
    return str(job.out.relative_to(job.out.parents[2]))


def affordable(jobs: Sequence[Job], options: argparse.Namespace) -> bool:
    """Print what the jobs that are still to be made will cost; whether they may be made, by options.limit (minutes) or options.yes."""
    binary = solver()
    costs = [(job, cost_to_make(job)) for job in jobs if done_before(job, key_of(job, binary)) is None]
    minutes = sum(cost.seconds for _, cost in costs) / 60.0 / max(options.jobs, 1)
    if costs:
        print(f"{len(costs)} of {len(jobs)} runs to make, by estimate:")
        for job, cost in costs:
            print(f"  {name_of(job)}: {cost.particles:.3g} particles x {cost.steps:.3g} steps: {cost.seconds:.0f} s")
        print(f"  together about {minutes:.1f} min with {options.jobs} at a time", flush=True)
    if minutes <= options.limit or options.yes:
        return True
    print(f"above the limit of {options.limit:g} min: give --yes, a larger --limit, fewer variants or coarser cells", file=sys.stderr)
    return False


def make(job: Job, stop: threading.Event | None = None) -> Made:
    """Run a job and read what it wrote: one that failed as far as it came, one that was refused not at all.

    A folder that cannot be used fails its run alone.
    """
    try:
        outcome = run(job, stop=stop)
        return outcome, None if outcome.exit_status == BAD_INPUT else load(job.out)
    except LoadError:
        return outcome, None
    except OSError as error:
        return Outcome(job.scene.stem, job.variant, "failed", BAD_INPUT, str(error), 0.0, ""), None


def made_words(made: Made) -> str:
    """How a run ended, in words."""
    outcome = made[0]
    how = "done before" if outcome.skipped else f"{outcome.wall_s:.0f} s"
    return f"{outcome.status} ({how}) {outcome.reason[:160]}".rstrip()


def make_all(jobs: Sequence[Job], at_a_time: int, words: Callable[[Made], str] = made_words) -> list[Made]:
    """Make all jobs, so many at a time, each on one thread, with a line for each."""
    tasks: list[Task[Made]] = [Task(name_of(job), partial(make, job), words, expected_s(job)) for job in jobs]
    return side_by_side(tasks, at_a_time)
