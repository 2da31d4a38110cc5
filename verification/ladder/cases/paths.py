"""Paths of Experiments 5 and 6 in a block that stands for the infinite plane, against boundary elements (dislocations).

Experiment 6's path is unstable and depends on the increment: it is held against the exact path of the same increment, and
increments have three cells because the solver takes the whole turn of maximum hoop stress only then.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verification.harness.crack_paths import exact_path, farthest, first_kink_deg, grown, rise_at
from verification.harness.load import LoadError, Run, given
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Array, Case, Level, Quantity, Sample, cell_levels

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
    return Quantity.of("first turn", "deg", kink_deg, lambda _: first_kink_deg(experiment), reference_error=1e-4)


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
