"""The methods that the chart compares, and how they become curves of a problem.

A problem says by a `Base` what of its scene depends on mechanics and size; the lists below say which settings it is solved with.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from verification.ladder.case import Level
from verification.precision.problem import STRATA, Method, Setting

FAR = 8.0  # cells far away against those around the fracture, where the grid is graded

# What of a scene depends on how it is solved: variant and further settings for a setting and a cell size (m).
Base = Callable[[Setting, float], tuple[str, tuple[str, ...]]]


@dataclass(frozen=True)
class Curve:
    """A setting with its name, its label and the cell sizes (m, coarse to fine) it is run at; see Method for the others."""

    name: str
    label: str
    setting: Setting
    cells_m: tuple[float, ...]
    main: bool = False
    quick: int = 0


STILL = Setting("quasistatic")
MOVING = Setting("explicit", kinematics="updated", transfer="flip")
RESTING = replace(MOVING, kinematics="total")


def without_inertia(fine: tuple[float, ...], uniform: tuple[float, ...], far: float = FAR) -> list[Curve]:
    """The quasi-static curves: graded ones at `fine` cells, uniform ones at `uniform` cells (m)."""
    graded = replace(STILL, graded=far)
    return [
        Curve("qs_graded", "quasi-static, graded", graded, fine, True, 2),
        Curve("qs_graded_16", "quasi-static, graded, 16 points a cell", replace(graded, points=16), fine[:-1], True),
        Curve("qs_graded_linear", "quasi-static, graded, linear", replace(graded, shape="linear"), fine, True),
        Curve("qs_uniform", "quasi-static, uniform", STILL, uniform, True),
        Curve("qs_uniform_9", "quasi-static, uniform, 9 points a cell", replace(STILL, points=9), uniform[:-1]),
        Curve("qs_uniform_16", "quasi-static, uniform, 16 points a cell", replace(STILL, points=16), uniform[:-1]),
        Curve("qs_uniform_linear", "quasi-static, uniform, linear", replace(STILL, shape="linear"), uniform),
    ]


def endless(cells: tuple[float, ...], beyond_m: float) -> list[Curve]:
    """Quasi-static in a small block whose rock goes on, at `cells` (m)."""
    setting = replace(STILL, beyond_m=beyond_m)
    return [
        Curve("qs_beyond", "quasi-static, small block in endless rock", setting, cells, True),
        Curve("qs_beyond_linear", "quasi-static, small block in endless rock, linear", replace(setting, shape="linear"), cells),
    ]


def with_inertia(cells: tuple[float, ...], some: tuple[float, ...], one: tuple[float, ...], damping_1_s: float) -> list[Curve]:
    """The explicit curves damped so (1/s): the main ones at all `cells` (m), others at `some`, single choices at `one` size, if any."""
    quick = 1 if one else 0  # where single choices are affordable, so is trying it out
    updated, total = (replace(setting, damping_1_s=damping_1_s) for setting in (MOVING, RESTING))
    curves = [
        Curve("ex_updated", "explicit, updated", updated, cells, True, quick),
        Curve("ex_total", "explicit, total", total, cells, True, quick),
        Curve("ex_updated_gimp", "explicit, updated, GIMP", replace(updated, shape="gimp"), some, True),
        Curve("ex_updated_linear", "explicit, updated, linear", replace(updated, shape="linear"), some, True),
        Curve("ex_total_linear", "explicit, total, linear", replace(total, shape="linear"), some),
        Curve("ex_updated_pic", "explicit, updated, PIC", replace(updated, transfer="pic"), one),
        Curve("ex_updated_xpic2", "explicit, updated, XPIC(2)", replace(updated, transfer="xpic2"), one),
        Curve("ex_total_xpic2", "explicit, total, XPIC(2)", replace(total, transfer="xpic2"), one),
        Curve("ex_updated_9", "explicit, updated, 9 points a cell", replace(updated, points=9), one),
        Curve("ex_updated_16", "explicit, updated, 16 points a cell", replace(updated, points=16), one),
        Curve("ex_total_16", "explicit, total, 16 points a cell", replace(total, points=16), one),
        Curve("ex_updated_courant_0.25", "explicit, updated, Courant number 0.25", replace(updated, courant=0.25), one),
        Curve("ex_updated_courant_0.8", "explicit, updated, Courant number 0.8", replace(updated, courant=0.8), one),
        Curve("ex_total_courant_0.8", "explicit, total, Courant number 0.8", replace(total, courant=0.8), one),
        Curve("ex_updated_plain", "explicit, updated, plain kernels", replace(updated, kernels="plain"), one),
        Curve("ex_total_plain", "explicit, total, plain kernels", replace(total, kernels="plain"), one),
        Curve("ex_updated_graded", "explicit, updated, graded", replace(updated, graded=FAR), cells, True),
        Curve("ex_updated_graded_gimp", "explicit, updated, graded, GIMP", replace(updated, graded=FAR, shape="gimp"), some),
        Curve("ex_updated_graded_linear", "explicit, updated, graded, linear", replace(updated, graded=FAR, shape="linear"), some),
        Curve("ex_updated_graded_16", "explicit, updated, graded, 16 points a cell", replace(updated, graded=FAR, points=16), one),
        Curve("ex_total_graded", "explicit, total, graded", replace(total, graded=FAR), cells, True),
    ]
    return [curve for curve in curves if curve.cells_m]


def methods(scene: Path, base: Base, curves: list[Curve]) -> tuple[Method, ...]:
    """The curves as methods of a problem whose scene is given."""

    def level(setting: Setting, cell_m: float) -> Level:
        """A setting at a cell size."""
        variant, further = base(setting, cell_m)
        return Level(f"{cell_m:g} m", cell_m, (*setting.keys(cell_m), *further), variant)

    return tuple(Method(one.name, one.label, STRATA, scene, tuple(level(one.setting, cell) for cell in one.cells_m), one.setting, one.main, one.quick)
                 for one in curves)  # fmt: skip
