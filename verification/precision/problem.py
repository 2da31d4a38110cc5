"""What the work-precision chart measures: problems with a reference, and methods that solve them at several sizes.

A problem and its methods, the settings that the chart compares, only describe; measuring and judging (measure.py) and drawing (reports/kept.py) are elsewhere.
Scenes, samples and references are the ladder's (verification/ladder/case.py). The measurements are data, a file a problem, with the machine that made them; read
by the page, resumed by the campaign.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.harness.command import twice
from verification.harness.load import Run
from verification.ladder.case import Level, Sample

STRATA, ELEMENTS = "strata", "strata-reference"  # the programs that solve a problem

Answer = Mapping[str, Any]  # the values of strata-reference by their names, SI: numbers and lists


@dataclass(frozen=True)
class Setting:
    """How the solver goes about a problem: the keys of a scene's [numerics], and what `further` sets besides.

    graded: cells far away so many times as large, 0 for a uniform grid. beyond_m: rock beyond a block that is then small. kernels: empty for
    the solver's default.
    """

    mechanics: str = "quasistatic"
    shape: str = "bspline2"
    points: int = 4
    graded: float = 0.0
    beyond_m: float = 0.0
    kinematics: str = ""  # the others: of explicit runs only
    transfer: str = ""
    courant: float = 0.5
    kernels: str = ""
    damping_1_s: float | None = None
    further: tuple[str, ...] = ()

    def keys(self, cell_m: float) -> tuple[str, ...]:
        """Scene settings for cells of a size, m."""
        keys = {"numerics.mechanics": self.mechanics, "numerics.cell_m": cell_m, "numerics.shape": self.shape, "numerics.particles_per_cell": self.points,
                "numerics.far_cell_m": self.graded * cell_m or None, "domain.beyond_m": self.beyond_m or None}  # fmt: skip
        if self.mechanics == "explicit":
            keys |= {"numerics.courant": self.courant, "numerics.kinematics": self.kinematics or None, "numerics.transfer": self.transfer or None,
                     "numerics.kernels": self.kernels or None, "numerics.damping_1_s": self.damping_1_s}  # fmt: skip
        return (*(f"{key}={value}" for key, value in keys.items() if value is not None), *self.further)


# What of a scene depends on how it is solved: variant and further settings for a setting and a cell size (m).
Base = Callable[[Setting, float], tuple[str, tuple[str, ...]]]


@dataclass(frozen=True)
class Method:
    """A way to solve a problem, a curve of the chart: coarse to fine.

    source: the scene of the solver's runs at `cells_m` (m), or the name of a solution of strata-reference, to which the levels' settings then go.
    """

    name: str  # unique in its problem, as in a file name
    label: str  # for legends
    setting: Setting | None
    cells_m: tuple[float, ...] = ()
    main: bool = False  # drawn in the foreground of the front page
    quick: int = 0  # so many coarse levels are enough to try the chart out
    source: Path | str = ""
    levels: tuple[Level, ...] = ()

    @property
    def program(self) -> str:
        """The program that it runs."""
        return STRATA if isinstance(self.source, Path) else ELEMENTS


def methods(scene: Path, base: Base, found: Iterable[Method]) -> tuple[Method, ...]:
    """Methods of the solver as those of a problem whose scene is given."""

    def level(setting: Setting, cell_m: float) -> Level:
        variant, further = base(setting, cell_m)
        return Level(f"{cell_m:g} m", cell_m, (*setting.keys(cell_m), *further), variant)

    return tuple(replace(one, source=scene, levels=tuple(level(one.setting or Setting(), cell) for cell in one.cells_m)) for one in found)


@dataclass(frozen=True)
class Wanted:
    """A number that a problem asks for: a panel of the chart.

    sample: of a run (LoadError where there is none). answer: the same of what strata-reference says.
    """

    name: str  # unique over all problems, as in a file name
    title: str
    unit: str
    says: str  # what an error of 1 % is, and what the reference is
    sample: Callable[[Run], Sample]
    answer: Callable[[Answer], Sample] | None = None


@dataclass(frozen=True)
class Problem:
    """A problem with its methods; `experiments` are those whose settings follow from it, `shipped` is the method (name, level) that
    their scenes ask for."""

    name: str
    says: str
    wanted: tuple[Wanted, ...]
    methods: tuple[Method, ...]
    experiments: tuple[int, ...] = ()
    shipped: tuple[str, str] = ("", "")
    limit_s: float = 90.0  # runs that take longer are failures
    about_s: float = 1.0  # a rough time of its finest graded run, to plan with before anything is known


def checked(problems: tuple[Problem, ...]) -> tuple[Problem, ...]:
    """The problems, if names are unique and sizes fall; raises ValueError otherwise."""
    every = [*(problem.name for problem in problems), *(f"{wanted.name}: wanted" for problem in problems for wanted in problem.wanted)]
    for problem, method in ((problem, method) for problem in problems for method in problem.methods):
        every += [where := f"{problem.name}/{method.name}", *(f"{where}: {level.label}" for level in method.levels)]
        sizes = [level.size for level in method.levels]
        if not sizes or any(fine >= coarse for coarse, fine in zip(sizes, sizes[1:])):
            raise ValueError(f"{where}: sizes {sizes} do not fall")
    if twice(every):
        raise ValueError(f"of the same name: {', '.join(twice(every))}")
    return problems


FAR = 8.0  # cells far away against those around the fracture, where the grid is graded

STILL = Setting("quasistatic")
MOVING = Setting("explicit", kinematics="updated", transfer="flip")
RESTING = replace(MOVING, kinematics="total")


def without_inertia(fine: tuple[float, ...], uniform: tuple[float, ...], far: float = FAR) -> list[Method]:
    """Quasi-static ones: graded ones at `fine` cells, uniform ones at `uniform` cells (m)."""
    graded = replace(STILL, graded=far)
    return [
        Method("qs_graded", "quasi-static, graded", graded, fine, True, 2),
        Method("qs_graded_16", "quasi-static, graded, 16 points a cell", replace(graded, points=16), fine[:-1], True),
        Method("qs_graded_linear", "quasi-static, graded, linear", replace(graded, shape="linear"), fine, True),
        Method("qs_uniform", "quasi-static, uniform", STILL, uniform, True),
        Method("qs_uniform_9", "quasi-static, uniform, 9 points a cell", replace(STILL, points=9), uniform[:-1]),
        Method("qs_uniform_16", "quasi-static, uniform, 16 points a cell", replace(STILL, points=16), uniform[:-1]),
        Method("qs_uniform_linear", "quasi-static, uniform, linear", replace(STILL, shape="linear"), uniform),
    ]


def endless(cells: tuple[float, ...], beyond_m: float) -> list[Method]:
    """Quasi-static in a small block whose rock goes on, at `cells` (m)."""
    setting = replace(STILL, beyond_m=beyond_m)
    return [
        Method("qs_beyond", "quasi-static, small block in endless rock", setting, cells, True),
        Method("qs_beyond_linear", "quasi-static, small block in endless rock, linear", replace(setting, shape="linear"), cells),
    ]


def with_inertia(cells: tuple[float, ...], some: tuple[float, ...], one: tuple[float, ...], damping_1_s: float) -> list[Method]:
    """Explicit ones damped so (1/s): the main ones at all `cells` (m), others at `some`, single choices at `one` size, if any."""
    quick = 1 if one else 0  # where single choices are affordable, so is trying it out
    updated, total = (replace(setting, damping_1_s=damping_1_s) for setting in (MOVING, RESTING))
    found = [
        Method("ex_updated", "explicit, updated", updated, cells, True, quick),
        Method("ex_total", "explicit, total", total, cells, True, quick),
        Method("ex_updated_gimp", "explicit, updated, GIMP", replace(updated, shape="gimp"), some, True),
        Method("ex_updated_linear", "explicit, updated, linear", replace(updated, shape="linear"), some, True),
        Method("ex_total_linear", "explicit, total, linear", replace(total, shape="linear"), some),
        Method("ex_updated_pic", "explicit, updated, PIC", replace(updated, transfer="pic"), one),
        Method("ex_updated_xpic2", "explicit, updated, XPIC(2)", replace(updated, transfer="xpic2"), one),
        Method("ex_total_xpic2", "explicit, total, XPIC(2)", replace(total, transfer="xpic2"), one),
        Method("ex_updated_9", "explicit, updated, 9 points a cell", replace(updated, points=9), one),
        Method("ex_updated_16", "explicit, updated, 16 points a cell", replace(updated, points=16), one),
        Method("ex_total_16", "explicit, total, 16 points a cell", replace(total, points=16), one),
        Method("ex_updated_courant_0.25", "explicit, updated, Courant number 0.25", replace(updated, courant=0.25), one),
        Method("ex_updated_courant_0.8", "explicit, updated, Courant number 0.8", replace(updated, courant=0.8), one),
        Method("ex_total_courant_0.8", "explicit, total, Courant number 0.8", replace(total, courant=0.8), one),
        Method("ex_updated_plain", "explicit, updated, plain kernels", replace(updated, kernels="plain"), one),
        Method("ex_total_plain", "explicit, total, plain kernels", replace(total, kernels="plain"), one),
        Method("ex_updated_graded", "explicit, updated, graded", replace(updated, graded=FAR), cells, True),
        Method("ex_updated_graded_gimp", "explicit, updated, graded, GIMP", replace(updated, graded=FAR, shape="gimp"), some),
        Method("ex_updated_graded_linear", "explicit, updated, graded, linear", replace(updated, graded=FAR, shape="linear"), some),
        Method("ex_updated_graded_16", "explicit, updated, graded, 16 points a cell", replace(updated, graded=FAR, points=16), one),
        Method("ex_total_graded", "explicit, total, graded", replace(total, graded=FAR), cells, True),
    ]
    return [one for one in found if one.cells_m]


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


def read_sheet(problem: str, folder: Path = DATA) -> Sheet | None:
    """The measurements of a problem; None where there are none. Raises ValueError for a file that cannot be understood."""
    return store.read(Sheet, folder / f"{problem}.json")


def write_sheet(sheet: Sheet, folder: Path = DATA, order: Iterable[str] = ()) -> Path:
    """Write the measurements of a problem, methods in the order given, a point a line."""
    places = {name: k for k, name in enumerate(order)}
    points = sorted(sheet.points, key=lambda point: (places.get(point.method, len(places)), point.method, -point.size))
    return store.write(replace(sheet, points=tuple(points)), folder / f"{sheet.problem}.json", ("points",))
