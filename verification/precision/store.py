"""The measurements as data: a file a problem, with the machine that made them; read by the page, resumed by the campaign."""
from __future__ import annotations

import statistics
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from verification.harness import store

DATA = Path(__file__).resolve().parent / "data"

OK, FAILED, REFUSED, TOO_LONG = "ok", "failed", "refused", "too long"


@dataclass(frozen=True)
class Found:
    """A wanted number of a run: its value, the reference and its relative error, the error, or why there is none.

    error is relative, signed for a single number; None where the reference is a limit that is not known yet.
    """

    value: float | None = None
    reference: float | None = None
    error: float | None = None
    reference_error: float = 0.0
    failure: str = ""


@dataclass(frozen=True)
class Point:
    """A method at a size: how its runs ended, what they took (wall and CPU time of the whole process, s) and found.

    key: scene, settings and program (machine apart). disturbed: something else ran beside it. once: a single run was made.
    """

    method: str
    level: str
    size: float
    key: str
    status: str
    reason: str = ""
    wall_s: tuple[float, ...] = ()
    cpu_s: tuple[float, ...] = ()
    date: str = ""
    disturbed: bool = False
    once: bool = False
    cells: int = 0
    particles: int = 0
    steps: int = 0
    memory_MB: float = 0.0
    settings: tuple[str, ...] = ()
    found: Mapping[str, Found] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether its runs came to their end."""
        return self.status == OK

    @property
    def time_s(self) -> float:
        """Median wall time, s; 0 without a run."""
        return statistics.median(self.wall_s) if self.wall_s else 0.0


@dataclass(frozen=True)
class Sheet:
    """All points of a problem that were measured on a machine."""

    problem: str
    machine: Mapping[str, Any]
    points: tuple[Point, ...]

    def point(self, method: str, level: str) -> Point | None:
        """The point of a method at a level."""
        return next((point for point in self.points if (point.method, point.level) == (method, level)), None)

    def with_point(self, point: Point) -> Sheet:
        """The same with a point in place of the one it repeats."""
        kept = tuple(one for one in self.points if (one.method, one.level) != (point.method, point.level))
        return replace(self, points=(*kept, point))


def read(problem: str, folder: Path = DATA) -> Sheet | None:
    """The measurements of a problem; None where there are none. Raises ValueError for a file that cannot be understood."""
    return store.read(Sheet, folder / f"{problem}.json")


def write(sheet: Sheet, folder: Path = DATA, order: Iterable[str] = ()) -> Path:
    """Write the measurements of a problem, methods in the order given, a point a line."""
    places = {name: k for k, name in enumerate(order)}
    points = sorted(sheet.points, key=lambda point: (places.get(point.method, len(places)), point.method, -point.size))
    return store.write(replace(sheet, points=tuple(points)), folder / f"{sheet.problem}.json", ("points",))
