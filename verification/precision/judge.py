"""What the measurements say: errors that can be relied on, the Pareto front, the cheapest way to an accuracy, and what has failed.

An error counts only as far as it lasts. Three things make a small one worthless, and each raises the error that is judged:
- the reference is not known that well: no error is taken to be below the reference's own uncertainty;
- a finer size of the same method is farther off: a size counts with the largest error from it on;
- it has another sign than at the size before, so that it fell faster than any order of the method allows: it counts with what
  third order would have left.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from verification.harness.richardson import CLEAN_ORDERS
from verification.precision.problem import STRATA, Method, Problem, Wanted
from verification.precision.store import OK, Found, Point, Sheet

TOLERANCES = (0.05, 0.01, 0.001)  # 5, 1 and 0.1 %
FASTEST_ORDER = CLEAN_ORDERS[1]


@dataclass(frozen=True)
class Dot:
    """A method at a size in a panel: wall time (s), error as measured (signed) and as it is judged, both relative."""

    method: Method
    level: str
    size: float
    time_s: float
    error: float
    uncertainty: float
    judged: float
    point: Point

    @property
    def lucky(self) -> bool:
        """Whether the error is much smaller than can be relied on."""
        return self.judged > 1.05 * max(abs(self.error), self.uncertainty)

    @property
    def name(self) -> str:
        """Method and size in words."""
        return f"{self.method.label}, {self.level}"


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
    """A wanted number over all methods: what was measured, what was not, and how well the reference is known (relative)."""

    problem: Problem
    wanted: Wanted
    dots: tuple[Dot, ...]
    lacks: tuple[Lack, ...]
    uncertainty: float


def judged(errors: Sequence[float], uncertainties: Sequence[float], sizes: Sequence[float], by_order: bool = True) -> list[float]:
    """The errors of a curve (coarse to fine) as they are judged; see the top of the file."""
    own = [max(abs(error), uncertainty) for error, uncertainty in zip(errors, uncertainties)]
    if by_order:
        least = [
            own[k - 1] * (sizes[k] / sizes[k - 1]) ** FASTEST_ORDER if k > 0 and errors[k - 1] * errors[k] < 0.0 else 0.0
            for k in range(len(own))
        ]
        own = [max(error, floor) for error, floor in zip(own, least)]
    return [max(own[k:]) for k in range(len(own))]


def panel_of(problem: Problem, wanted: Wanted, sheet: Sheet) -> Panel:
    """What the measurements of a problem say of a wanted number."""
    dots: list[Dot] = []
    lacks: list[Lack] = []
    for method in problem.methods:
        shown: list[tuple[Point, Found, float]] = []
        for level in method.levels:
            point = sheet.point(method.name, level.label)
            found = point.found.get(wanted.name) if point is not None else None
            if point is not None and point.status != OK:
                lacks.append(Lack(method, level.label, point.status, point.reason, point.time_s))
            elif point is not None and found is not None and (found.error is None or found.failure):
                lacks.append(Lack(method, level.label, "no value", found.failure or "nothing was measured", point.time_s))
            elif point is not None and found is not None and found.error is not None:
                shown.append((point, found, found.error))
        errors, sizes = [error for _, _, error in shown], [point.size for point, _, _ in shown]
        counted = judged(errors, [found.reference_error for _, found, _ in shown], sizes, method.program == STRATA)
        dots += [Dot(method, point.level, point.size, point.time_s, error, found.reference_error, bound, point)
                 for (point, found, error), bound in zip(shown, counted)]  # fmt: skip
    return Panel(problem, wanted, tuple(dots), tuple(lacks), max((dot.uncertainty for dot in dots), default=0.0))


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


GROUPS = ("any method", "with inertia", "boundary elements")


def in_group(dot: Dot, group: str) -> bool:
    """Whether a dot counts among the solver's methods, those of them with inertia, or boundary elements."""
    if group == "boundary elements":
        return dot.method.program != STRATA
    inertia = dot.method.setting is not None and dot.method.setting.mechanics == "explicit"
    return dot.method.program == STRATA and (group == "any method" or inertia)


@dataclass(frozen=True)
class Advice:
    """A row of the table: for a wanted number and a group of methods the cheapest dot within each tolerance, and the best one."""

    panel: Panel
    group: str
    choices: tuple[Dot | None, ...]
    best: Dot | None


def advice(panels: Sequence[Panel], tolerances: Sequence[float] = TOLERANCES) -> list[Advice]:
    """The table, a row a wanted number and group; groups without any dot are left out, but for the first."""
    rows = []
    for panel in panels:
        for group in GROUPS:
            own = [dot for dot in panel.dots if in_group(dot, group)]
            if own or group == GROUPS[0]:
                rows.append(Advice(panel, group, tuple(cheapest(own, error) for error in tolerances), nearest(own)))
    return rows


@dataclass(frozen=True)
class Choice:
    """A method at a size for a whole experiment: its dots in all panels of a problem, and whether all are within the tolerance."""

    dots: tuple[Dot, ...]
    within: bool

    @property
    def time_s(self) -> float:
        """Wall time of the run that all of them come from, s."""
        return self.dots[0].time_s

    @property
    def name(self) -> str:
        """Method and size in words."""
        return self.dots[0].name


def runs_of(panels: Sequence[Panel]) -> list[tuple[Dot, ...]]:
    """The dots of each run of the solver that has something to show in all panels of a problem."""
    found: dict[tuple[str, str], list[Dot]] = {}
    for panel in panels:
        for dot in panel.dots:
            if in_group(dot, "any method"):
                found.setdefault((dot.method.name, dot.level), []).append(dot)
    return [tuple(dots) for dots in found.values() if len(dots) == len(panels)]


def choice_for(panels: Sequence[Panel], error: float) -> Choice | None:
    """The cheapest run within an error in all panels, or within the reference's uncertainty where that is larger.

    Where there is none, the run that is least far from it; None where nothing was measured.
    """
    allowed = [max(error, panel.uncertainty) for panel in panels]

    def excess(dots: tuple[Dot, ...]) -> float:
        """The largest error over what is allowed."""
        return max(dot.judged / most for dot, most in zip(dots, allowed))

    every = runs_of(panels)
    good = [dots for dots in every if excess(dots) <= 1.0]
    if good:
        return Choice(min(good, key=lambda dots: dots[0].time_s), True)
    return Choice(min(every, key=lambda dots: (excess(dots), dots[0].time_s)), False) if every else None


def run_at(panels: Sequence[Panel], method: str, level: str) -> tuple[Dot, ...] | None:
    """The dots of one method at one size in all panels; None where it has nothing to show in one of them."""
    return next((dots for dots in runs_of(panels) if (dots[0].method.name, dots[0].level) == (method, level)), None)


def bounds(values: Iterable[float]) -> tuple[float, float]:
    """Smallest and largest of positive numbers; NaN without any."""
    known = [value for value in values if value > 0.0 and math.isfinite(value)]
    return (min(known), max(known)) if known else (math.nan, math.nan)
