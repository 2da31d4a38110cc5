"""What the work-precision chart measures: problems with a reference, and methods that solve them at several sizes.

A problem and its methods only describe; measuring (measure.py), judging (judge.py) and drawing (reports/precision.py) are elsewhere.
Scenes, samples and references are the ladder's (verification/ladder/case.py).
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from verification.harness.choose import twice
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
        found = [f"numerics.mechanics={self.mechanics}", f"numerics.cell_m={cell_m!r}", f"numerics.shape={self.shape}",
                 f"numerics.particles_per_cell={self.points}"]  # fmt: skip
        if self.graded > 0.0:
            found.append(f"numerics.far_cell_m={self.graded * cell_m!r}")
        if self.beyond_m > 0.0:
            found.append(f"domain.beyond_m={self.beyond_m!r}")
        if self.mechanics == "explicit":
            found.append(f"numerics.courant={self.courant!r}")
            words = {"kinematics": self.kinematics, "transfer": self.transfer, "kernels": self.kernels}
            found += [f"numerics.{key}={word}" for key, word in words.items() if word]
            if self.damping_1_s is not None:
                found.append(f"numerics.damping_1_s={self.damping_1_s!r}")
        return (*found, *self.further)


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


def thinned(problem: Problem) -> Problem:
    """A problem with those methods and coarse levels alone that are enough to try the chart out."""
    return replace(problem, methods=tuple(replace(one, levels=one.levels[: one.quick]) for one in problem.methods if one.quick > 0))
