"""The settings that the chart compares, as lists of methods for the cell sizes of a problem."""

from dataclasses import replace

from verification.precision.problem import Method, Setting

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
