"""What the measurements say: errors that can be relied on, the Pareto front, the cheapest way to an accuracy, and what has failed.

An error counts only as far as it lasts. Three things make a small one worthless, and each raises the error that is judged:
- the reference is not known that well: no error is taken to be below the reference's own uncertainty;
- a finer size of the same method is farther off: a size counts with the largest error from it on;
- it has another sign than at the size before, so that it fell faster than any order of the method allows: it counts with what
  third order would have left.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from verification.harness.richardson import CLEAN_ORDERS
from verification.precision.problem import STRATA, Found, Method, Point, Problem, Sheet, Wanted

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
