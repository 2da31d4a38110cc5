"""Measures a method at a size: runs it alone, several times, and holds what it found against the reference.

What is timed is the whole process, from its start to its end with everything it writes. A first run that took less than WARM_S is the
warm-up and does not count; REPEATS runs follow. Longer ones need no warm-up of their own: of those SOME runs are made, of runs
above LONG_S one.
"""

import hashlib
import json
import math
import time
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path

from verification.benchmarks.machine import others_running
from verification.harness import paths
from verification.harness import run as harness
from verification.harness.command import folder_name
from verification.harness.load import LoadError, load
from verification.harness.paths import ROOT, reference_program, solver
from verification.harness.run import Job, Timed, timed
from verification.ladder.case import Level, Sample
from verification.ladder.measure import summarised
from verification.precision.problem import FAILED, OK, REFUSED, STRATA, TOO_LONG, Answer, Found, Method, Point, Problem

RUNS = paths.RUNS / "precision"
WARM_S, LONG_S = 2.0, 10.0
REPEATS, SOME = 5, 3
# Wall time over CPU time of the quickest run, and beyond it (s), above which something else had the processor.
DISTURBED, WAITING_S = 1.15, 0.05


class Failure(Exception):
    """A run that has nothing to show: how it failed, and why."""

    def __init__(self, status: str, reason: str) -> None:
        """Words between single spaces, places in the project by their names there: data are read on other machines, too."""
        super().__init__(" ".join(reason.replace(f"{ROOT}/", "").split()))
        self.status = status


def job_of(method: Method, level: Level, folder: Path = Path()) -> Job:
    """The run of a method of the solver at a level."""
    assert isinstance(method.source, Path)
    return Job(method.source, level.variant, folder, level.settings)


def key_of(method: Method, level: Level) -> str:
    """A hash of all that a point's numbers depend on, the machine apart: scene, settings and program."""
    if method.program == STRATA:
        return harness.key_of(job_of(method, level), solver())[:16]
    digest = hashlib.sha256(json.dumps([str(method.source), list(level.settings)]).encode())
    digest.update(hashlib.sha256(reference_program().read_bytes()).digest())
    return digest.hexdigest()[:16]


def repeated(action: Callable[[], Timed], once: bool = False) -> list[Timed]:
    """The times that count, s; `once` makes a single run, warm or not."""
    first = action()
    if once or first[0] > LONG_S:
        return [first]
    if first[0] > WARM_S:
        return [first, *(action() for _ in range(SOME - 1))]
    return [action() for _ in range(REPEATS)]


def run_solver(job: Job, limit_s: float) -> Timed:
    """One run of the solver, its wall and CPU time; raises Failure for one without a result."""
    outcome = harness.run(job, force=True, limit_s=limit_s)
    if not outcome.ok:
        raise Failure(outcome.word, outcome.reason)
    return outcome.wall_s, outcome.cpu_s


def run_reference(method: Method, level: Level, limit_s: float) -> tuple[Answer, Timed]:
    """One run of strata-reference, its values and what it took; raises Failure where it refuses."""
    command = [str(reference_program()), str(method.source), *(word for setting in level.settings for word in ("--set", setting))]
    (exit_status, said), times = timed(lambda: harness.ended(command, limit_s))
    if exit_status != 0:
        raise Failure(TOO_LONG if exit_status == harness.TOO_LONG else REFUSED, said)
    return {name: item["value"] for name, item in json.loads(said)["values"].items()}, times


def found_by(sample: Callable[[], Sample]) -> Found:
    """A number of a run; what keeps it from being measured is its failure."""
    try:
        one = sample()
        value, exact = summarised(one)
        error = one.error()
    except Exception as defect:  # a number that is not there must not cost the others theirs
        return Found(failure=str(defect))
    if not math.isfinite(error):
        return Found(value, exact, failure=f"the error is {error}")
    return Found(value, exact, error, one.reference_error)


def measured(problem: Problem, method: Method, level: Level, runs: Path = RUNS, once: bool = False) -> Point:
    """A point of a problem's chart; failures are points too."""
    folder = runs / problem.name / method.name / folder_name(level.label)
    key, others = key_of(method, level), others_running()
    date = datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
    point = Point(method.name, level.label, level.size, key, OK, date=date, settings=level.settings)
    start = time.perf_counter()
    try:
        if method.program == STRATA:
            times = repeated(lambda: run_solver(job_of(method, level, folder), problem.limit_s), once)
            run = load(folder)
            found = {one.name: found_by(lambda one=one: one.sample(run)) for one in problem.wanted}
            about = run.summary
            point = replace(point, cells=about.cells, particles=about.particles, steps=about.steps, memory_MB=round(about.peak_memory_MB, 1))
        else:
            answer, _ = run_reference(method, level, problem.limit_s)
            times = repeated(lambda: run_reference(method, level, problem.limit_s)[1], once)
            found = {one.name: found_by(lambda reads=one.answer: reads(answer)) for one in problem.wanted if one.answer is not None}
    except Failure as failure:
        return replace(point, status=failure.status, reason=str(failure), wall_s=(round(time.perf_counter() - start, 4),))
    except LoadError as failure:
        return replace(point, status=FAILED, reason=str(failure))
    wall, cpu = (tuple(round(one, 5) for one in both) for both in zip(*times))
    disturbed = min(others, others_running()) > 0 or min(wall) > DISTURBED * min(cpu) + WAITING_S
    return replace(point, found=found, wall_s=wall, cpu_s=cpu, disturbed=disturbed, once=len(times) == 1)
