"""Paths of Experiments 5 and 6 in a block that stands for the infinite plane, against boundary elements (dislocations).

Experiment 6's path is unstable and depends on the increment: it is held against the exact path of the same increment, and
increments have three cells because the solver takes the whole turn of maximum hoop stress only then.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verification.harness.load import Array, LoadError, Run, Setting, given, values
from verification.harness.observables import distances_to
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Case, Level, Quantity, Sample, cell_levels

# --- paths by boundary elements in the infinite plane, and paths of runs in the same frame
INTERFACE_M = 5.0  # to the right of the first crack
FIRST_TIP_M = 5.0
_STIFF: dict[str, float] = {"youngs_modulus_Pa": 10e9, "toughness_Pa_sqrt_m": 1.45e6}
_SOFT: dict[str, float] = {"youngs_modulus_Pa": 5e9, "toughness_Pa_sqrt_m": 1.25e6}
_ACROSS_PA = -2e6  # in-situ stress across the fracture
_ALONG_PA = {5: -3e6, 6: -1e6}  # and along it


def path_settings(experiment: int, increment_m: float, turning: str, growth_m: float) -> dict[str, Setting]:
    """The settings of crack_path for Experiment 5 or 6."""
    crack, beyond = (_SOFT, _STIFF) if experiment == 5 else (_STIFF, _SOFT)
    return {
        **crack, "beyond_youngs_modulus_Pa": beyond["youngs_modulus_Pa"], "interface_x_m": INTERFACE_M, "s_xx_Pa": _ACROSS_PA,
        "s_yy_Pa": _ALONG_PA[experiment], "half_length_m": FIRST_TIP_M, "increment_m": increment_m, "turning": turning,
        "stop_growth_m": growth_m, "stop_height_m": 1000.0,
    }  # fmt: skip


def exact_path(experiment: int, increment_m: float, turning: str, growth_m: float) -> Array:
    """Tips of Experiment 5 or 6 by strata-reference crack_path over a length of growth, "corrected" or "forward" turning. Perfect interface, pressure
    everywhere that of the start of growth; x from the first crack; shape (n, 2), m."""
    settings = path_settings(experiment, increment_m, turning, growth_m)
    return np.column_stack([values("crack_path", axis, **settings) for axis in ("x_m", "y_m")])


def grown(run: Run) -> Array:
    """Tips of a run from the first on, x from the first crack, shape (n, 2), m; LoadError if it grew less than twice."""
    path = run.path[1:] - np.array([run.path[0, 0], 0.0])
    if len(path) < 3:
        raise LoadError(f"{run.folder}: the fracture grew less than two increments")
    return path


def rise_at(path: Array, x_m: float) -> float:
    """Height above the first tip at which a path first is x_m to the right, m; LoadError if it never is."""
    beyond = np.nonzero(path[:, 0] >= x_m)[0]
    if len(beyond) == 0:
        raise LoadError(f"the path never gets {x_m:g} m to the right")
    k = int(beyond[0])
    part = (x_m - path[k - 1, 0]) / (path[k, 0] - path[k - 1, 0])
    return float(path[k - 1, 1] + part * (path[k, 1] - path[k - 1, 1]) - path[0, 1])


def farthest(path: Array, other: Array) -> float:
    """Largest distance of a path's points from a polyline (m), over the height and width that both have."""
    near = np.hypot(*(path - path[0]).T) <= np.hypot(*(other[-1] - other[0]))
    return float(np.max(distances_to(path[near], other)))


GROWTH_M = 20.0  # of Experiment 5's path that is held against the reference
TURN_M = 1.0  # sideways, where the height of Experiment 6's path is read
CONVERGED_M = 0.5  # increment of Experiment 5's corrected path; 1 mm from those of 0.25 and 1 m


def converged_5(_: Run | None = None) -> Array:
    """The converged path of Experiment 5, a little longer than what is held against it."""
    return exact_path(5, CONVERGED_M, "corrected", GROWTH_M + 1.0)


def same_6(run: Run) -> Array:
    """The forward path of Experiment 6 in a run's own increments."""
    return exact_path(6, run.increment_m, "forward", GROWTH_M)


def drift(path: Array, top: Any) -> Any:
    """x of a path at a height, or at heights, m."""
    return np.interp(top, path[:, 1], path[:, 0])


def along_5(run: Run) -> Sample:
    """x at every tip over the first 20 m of growth, Experiment 5; relative to the exact drift there."""
    path, exact = grown(run), converged_5()
    top = path[0, 1] + GROWTH_M
    if path[-1, 1] < top:
        raise LoadError(f"{run.folder}: the fracture grew less than {GROWTH_M:g} m")
    path = path[path[:, 1] <= top][1:]
    return Sample(path[:, 0], drift(exact, path[:, 1]), None, abs(drift(exact, top)), reference_error=0.002)


def cells_off(exact: Callable[[Run], Array], why: str = "") -> Quantity:
    """Largest distance from a path over its first 20 m, relative to a cell."""

    return Quantity("distance from the path, in cells", "m",
                    lambda run: Sample.of(farthest(grown(run), exact(run)), 0.0, scale=given(run, "numerics.cell_m")), why)  # fmt: skip


def kink_deg(run: Run) -> float:
    """Direction of maximum hoop stress when growth starts, degrees anticlockwise from the crack's own."""
    still = np.hypot(run.history["tip_x_m"] - run.path[1, 0], run.history["tip_y_m"] - run.path[1, 1]) < 1e-9
    if not np.any(still):
        raise LoadError(f"{run.folder}: no row before growth")
    return float(run.history["kink_deg"][still][-1])


def first_turn(experiment: int) -> Quantity:
    """The first turn against boundary elements."""
    return Quantity.of("first turn", "deg", kink_deg, lambda _: values("crack_path", "kink_deg", **path_settings(experiment, 1.0, "forward", 1.0))[0], reference_error=1e-4)


def levels(increment_cells: float) -> tuple[Level, ...]:
    """Levels of cells with increments of so many cells."""
    return cell_levels(1.0, 0.5, 0.25, of=(lambda h: (f"fracture.increment_m={increment_cells * h!r}",),))


_FLOOR = {"0.25 m": "4 mm are left, of either sign: the edges 200 m away alone shift the path by 2 mm"}
_TAPER = "the increment shrinks with the cell, and with it the exact path that the run is held against"
_CELLS = "the largest distance is counted in cells, which shrink as it does"
_ALONG = "x along 20 m of path"
DRIFT_5 = Quantity.of("drift after 20 m", "m", lambda run: drift(grown(run), grown(run)[0, 1] + GROWTH_M),
                      lambda run: drift(converged_5(), grown(run)[0, 1] + GROWTH_M), reference_error=0.002, no_order_at=_FLOOR)  # fmt: skip
# Height gained until the path is 1 m to the side of its first line.
RISE_6 = Quantity.of("rise until 1 m to the side", "m", lambda run: rise_at(grown(run), TURN_M), lambda run: rise_at(same_6(run), TURN_M),
                     _TAPER, reference_error=1e-3)  # fmt: skip


def case(experiment: int, ending: str, says: str, mechanics: str, own: tuple[Level, ...], *quantities: Quantity) -> Case:
    """A case of Experiment 5 or 6; the coarsest level runs in ci/test."""
    name = f"path_exp{experiment}"
    return Case(name + ending, says, ANALYTIC / f"{name}.toml", mechanics, own, quantities, smoke=1)


CASES = (
    case(5, "", "A crack in soft rock 5 m beside stiff rock drifts away from it: a stable path, increments of two cells.", "quasistatic", levels(2.0),
         first_turn(5), Quantity(_ALONG, "m", along_5, no_order_at=_FLOOR), DRIFT_5, cells_off(converged_5, _CELLS)),
    case(5, "_block", "The same in the study's block of 80 m with its sides held, which the infinite plane knows nothing of.", "quasistatic",
         (Level("1 m", 1.0, ("fracture.increment_m=2.0",), "block"),), Quantity(_ALONG, "m", along_5)),
    case(5, "_explicit", "The same with inertia: the tip runs at a good part of the Rayleigh speed, which equilibria know nothing of.", "explicit",
         (Level("1 m", 1.0, ("fracture.increment_m=2.0",), "block_explicit"),), cells_off(converged_5)),
    case(6, "", "A crack in stiff rock 5 m beside soft rock turns to it under a larger stress across: unstable, increments of three cells.",
         "quasistatic", levels(3.0), first_turn(6), RISE_6, cells_off(same_6, _CELLS)),
)  # fmt: skip
