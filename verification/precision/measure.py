"""Measures a method at a size, alone, several times, and says what the measurements say: errors that can be relied on, the Pareto front, the cheapest way to
an accuracy, and what has failed.

What is timed is the whole process, from its start to its end with everything it writes. A first run that took less than WARM_S is the
warm-up and does not count; REPEATS runs follow. Longer ones need no warm-up of their own: of those SOME runs are made, of runs
above LONG_S one.

An error counts only as far as it lasts. Three things make a small one worthless, and each raises the error that is judged:
- the reference is not known that well: no error is taken to be below the reference's own uncertainty;
- a finer size of the same method is farther off: a size counts with the largest error from it on;
- it has another sign than at the size before, so that it fell faster than any order of the method allows: it counts with what
  third order would have left.
"""

import hashlib
import json
import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path

from verification.benchmarks.machine import others_running
from verification.harness import paths, run as harness
from verification.harness.command import folder_name
from verification.harness.load import LoadError, load
from verification.harness.paths import ROOT, reference_program, solver
from verification.harness.richardson import CLEAN_ORDERS
from verification.harness.run import Job, Timed, timed
from verification.ladder.case import Level, Sample
from verification.ladder.measure import summarised
from verification.precision.problem import FAILED, OK, REFUSED, STRATA, TOO_LONG, Answer, Found, Method, Point, Problem, Sheet, Wanted

TOLERANCES = (0.05, 0.01, 0.001)  # 5, 1 and 0.1 %
GROUPS = ("any method", "with inertia", "boundary elements")  # the solver's methods, those of them with inertia, strata-reference


@dataclass(frozen=True)
class Dot:
    """A method at a size in a panel: relative error as measured (signed), the reference's own, and the error as it is judged."""

    method: Method
    point: Point
    error: float
    uncertainty: float
    judged: float

    @property
    def time_s(self) -> float:
        """Wall time, s."""
        return self.point.time_s

    @property
    def lucky(self) -> bool:
        """Whether the error is much smaller than can be relied on."""
        return self.judged > 1.05 * max(abs(self.error), self.uncertainty)

    @property
    def name(self) -> str:
        """Method and size in words."""
        return f"{self.method.label}, {self.point.level}"


@dataclass(frozen=True)
class Lack:
    """A method at a size that has nothing to show in a panel: how it ended ("refused", "failed", ..) and why."""

    method: Method
    level: str
    status: str
    reason: str
    time_s: float


@dataclass(frozen=True)
class Panel:
    """A wanted number over all methods: what was measured and what was not."""

    problem: Problem
    wanted: Wanted
    dots: tuple[Dot, ...]
    lacks: tuple[Lack, ...]

    @property
    def uncertainty(self) -> float:
        """How well the reference is known (relative)."""
        return max((dot.uncertainty for dot in self.dots), default=0.0)

    def of(self, group: str = GROUPS[0]) -> list[Dot]:
        """The dots of a group."""
        moving = [dot.method.setting is not None and dot.method.setting.mechanics == "explicit" for dot in self.dots]
        return [dot for dot, moves in zip(self.dots, moving) if (dot.method.program == STRATA) == (group != GROUPS[2])
                and (group != GROUPS[1] or moves)]  # fmt: skip


def judged(errors: Sequence[float], uncertainties: Sequence[float], sizes: Sequence[float], by_order: bool = True) -> list[float]:
    """The errors of a curve (coarse to fine) as they are judged; see the top of the file."""
    least = [max(abs(error), uncertainty) for error, uncertainty in zip(errors, uncertainties)]
    own = least[:1]
    for k in range(1, len(least)):
        turned = by_order and errors[k - 1] * errors[k] < 0.0
        own.append(max(least[k], least[k - 1] * (sizes[k] / sizes[k - 1]) ** CLEAN_ORDERS[1]) if turned else least[k])
    return [max(own[k:]) for k in range(len(own))]


def panel_of(problem: Problem, wanted: Wanted, sheet: Sheet) -> Panel:
    """What the measurements of a problem say of a wanted number."""
    dots: list[Dot] = []
    lacks: list[Lack] = []
    for method in problem.methods:
        shown: list[tuple[Point, Found, float]] = []
        for point in filter(None, (sheet.point(method.name, level.label) for level in method.levels)):
            found = point.found.get(wanted.name)
            if not point.ok:
                lacks.append(Lack(method, point.level, point.status, point.reason, point.time_s))
            elif found is not None and (found.error is None or found.failure):
                lacks.append(Lack(method, point.level, "no value", found.failure or "nothing was measured", point.time_s))
            elif found is not None and found.error is not None:
                shown.append((point, found, found.error))
        counted = judged([error for _, _, error in shown], [found.reference_error for _, found, _ in shown], [point.size for point, _, _ in shown],
                         method.program == STRATA)  # fmt: skip
        dots += [Dot(method, point, error, found.reference_error, bound) for (point, found, error), bound in zip(shown, counted)]
    return Panel(problem, wanted, tuple(dots), tuple(lacks))


def pareto(dots: Iterable[Dot]) -> list[Dot]:
    """The dots that no other beats in both time and error as judged: by time, errors falling."""
    front: list[Dot] = []
    for dot in sorted(dots, key=lambda one: (one.time_s, one.judged)):
        if not front or dot.judged < front[-1].judged:
            front.append(dot)
    return front


def cheapest(dots: Iterable[Dot], error: float) -> Dot | None:
    """The quickest dot whose error as judged is at most so much; None where there is none."""
    return min((dot for dot in dots if dot.judged <= error), key=lambda dot: dot.time_s, default=None)


def nearest(dots: Iterable[Dot]) -> Dot | None:
    """The dot with the smallest error as judged, the quicker of equals; None without dots."""
    return min(dots, key=lambda dot: (dot.judged, dot.time_s), default=None)


def runs_of(panels: Sequence[Panel]) -> list[tuple[Dot, ...]]:
    """The dots of each run of the solver that has something to show in all panels of a problem."""
    found: dict[tuple[str, str], list[Dot]] = {}
    for dot in (dot for panel in panels for dot in panel.of()):
        found.setdefault((dot.method.name, dot.point.level), []).append(dot)
    return [tuple(dots) for dots in found.values() if len(dots) == len(panels)]


def choice_for(panels: Sequence[Panel], error: float) -> tuple[tuple[Dot, ...], bool] | None:
    """The cheapest run within an error in all panels of a problem, or within the reference's uncertainty where that is larger, and True.

    Where there is none, the run that is least far from it, and False; None where nothing was measured.
    """
    allowed = [max(error, panel.uncertainty) for panel in panels]

    def excess(dots: tuple[Dot, ...]) -> float:
        """The largest error over what is allowed, at least 1."""
        return max(1.0, *(dot.judged / most for dot, most in zip(dots, allowed)))

    best = min(runs_of(panels), key=lambda dots: (excess(dots), dots[0].time_s), default=None)
    return None if best is None else (best, excess(best) <= 1.0)


def run_at(panels: Sequence[Panel], method: str, level: str) -> tuple[Dot, ...] | None:
    """The dots of one method at one size in all panels; None where it has nothing to show in one of them."""
    return next((dots for dots in runs_of(panels) if (dots[0].method.name, dots[0].point.level) == (method, level)), None)


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
