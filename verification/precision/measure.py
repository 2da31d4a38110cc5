"""Measures a method at a size: runs it alone, several times, and holds what it found against the reference.

What is timed is the whole process, from its start to its end with everything it writes. A first run that took less than WARM_S is the
warm-up and does not count; REPEATS runs follow. Longer ones need no warm-up of their own: of those SOME runs are made, of runs
above LONG_S one.
"""
from __future__ import annotations

import hashlib
import json
import math
import resource
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from verification.harness import paths
from verification.harness import run as harness
from verification.harness.load import LoadError, Run, load
from verification.harness.paths import ROOT, reference_program, solver
from verification.harness.run import Job, Outcome
from verification.ladder.case import Level, Sample
from verification.ladder.catalogue import folder_name
from verification.ladder.measure import summarised
from verification.precision import machine
from verification.precision.problem import STRATA, Answer, Method, Problem, Wanted
from verification.precision.store import FAILED, OK, REFUSED, TOO_LONG, Found, Point

RUNS = paths.RUNS / "precision"
WARM_S, LONG_S = 2.0, 10.0
REPEATS, SOME = 5, 3
# Wall time over CPU time of the quickest run, and beyond it (s), above which something else had the processor.
DISTURBED, WAITING_S = 1.15, 0.05

Timed = tuple[float, float]  # wall and CPU time, s


class Failure(Exception):
    """A run that has nothing to show; `status` says how it failed."""

    def __init__(self, status: str, reason: str) -> None:
        """How it failed, and why."""
        super().__init__(reason)
        self.status = status


def key_of(method: Method, level: Level) -> str:
    """A hash of all that a point's numbers depend on, the machine apart: scene, settings and program."""
    if method.program == STRATA:
        assert isinstance(method.source, Path)
        return harness.key_of(Job(method.source, level.variant, Path(), level.settings, method.threads), solver())[:16]
    digest = hashlib.sha256(json.dumps([str(method.source), list(level.settings)]).encode())
    digest.update(hashlib.sha256(reference_program().read_bytes()).digest())
    return digest.hexdigest()[:16]


def _cpu_s() -> float:
    """CPU time of all processes that were waited for so far, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(action: Callable[[], Any]) -> tuple[Any, Timed]:
    """What an action gives, with the wall and CPU time of the processes that it started, s."""
    cpu, wall = _cpu_s(), time.perf_counter()
    made = action()
    return made, (time.perf_counter() - wall, _cpu_s() - cpu)


def repeated(action: Callable[[], Timed], once: bool = False) -> list[Timed]:
    """The times that count, s; `once` makes a single run, warm or not."""
    first = action()
    if once or first[0] > LONG_S:
        return [first]
    if first[0] > WARM_S:
        return [first, *(action() for _ in range(SOME - 1))]
    return [action() for _ in range(REPEATS)]


def run_solver(method: Method, level: Level, folder: Path, limit_s: float) -> tuple[Outcome, Timed]:
    """One run of the solver into a folder, with its wall and CPU time; raises Failure for one without a result."""
    assert isinstance(method.source, Path)
    job = Job(method.source, level.variant, folder, level.settings, method.threads)
    outcome, (_, cpu) = timed(lambda: harness.run(job, force=True, limit_s=limit_s))
    if not outcome.ok:
        status = {2: REFUSED, harness.TOO_LONG: TOO_LONG}.get(outcome.exit_status, FAILED)
        raise Failure(status, " ".join(outcome.reason.replace(f"{ROOT}/", "").split()))  # data are read on other machines, too
    return outcome, (outcome.wall_s, cpu)


def run_reference(method: Method, level: Level, limit_s: float) -> tuple[Answer, Timed]:
    """One run of strata-reference, its values and what it took; raises Failure where it refuses."""
    command = [str(reference_program()), str(method.source)]
    for setting in level.settings:
        command += ["--set", setting]
    (exit_status, said), times = timed(lambda: harness.ended(command, limit_s))
    if exit_status != 0:
        raise Failure(TOO_LONG if exit_status == harness.TOO_LONG else REFUSED, " ".join(said.split()))
    return {name: item["value"] for name, item in json.loads(said)["values"].items()}, times


def found_by(wanted: Wanted, sample: Callable[[], Sample]) -> Found:
    """A wanted number of a run; what keeps it from being measured is its failure."""
    try:
        one = sample()
        if wanted.limit_of:
            return Found(float(one.values[0]))
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
    key, others = key_of(method, level), machine.others_running()
    point = Point(method.name, level.label, level.size, key, OK, date=machine.now(), settings=level.settings)
    start = time.perf_counter()
    try:
        if method.program == STRATA:
            times = repeated(lambda: run_solver(method, level, folder, problem.limit_s)[1], once)
            point = of_run(point, problem, load(folder))
        else:
            answer, _ = run_reference(method, level, problem.limit_s)
            times = repeated(lambda: run_reference(method, level, problem.limit_s)[1], once)
            found = {one.name: found_by(one, _bind(one, answer)) for one in problem.wanted if one.answer is not None}
            point = replace(point, found=found)
    except Failure as failure:
        return replace(point, status=failure.status, reason=str(failure), wall_s=(round(time.perf_counter() - start, 4),))
    except LoadError as failure:
        return replace(point, status=FAILED, reason=str(failure))
    wall, cpu = zip(*times)
    disturbed = min(others, machine.others_running()) > 0 or min(wall) > DISTURBED * min(cpu) + WAITING_S
    return replace(point, wall_s=tuple(round(t, 5) for t in wall), cpu_s=tuple(round(t, 5) for t in cpu),
                   disturbed=disturbed, once=len(times) == 1)  # fmt: skip


def _bind(wanted: Wanted, answer: Answer) -> Callable[[], Sample]:
    """The sample of an answer, later."""
    assert wanted.answer is not None
    reads = wanted.answer
    return lambda: reads(answer)


def of_run(point: Point, problem: Problem, run: Run) -> Point:
    """A point with what its run found and how large it was."""
    found = {one.name: found_by(one, lambda one=one: one.sample(run)) for one in problem.wanted}
    summary = run.summary
    return replace(point, found=found, cells=summary.cells, particles=summary.particles, steps=summary.steps,
                   memory_MB=round(summary.peak_memory_MB, 1))  # fmt: skip
