"""Growth in increments from a quarter of a cell to four cells: paths that wander."""
from __future__ import annotations

import numpy as np

from verification.harness.crack_paths import exact_path, farthest, grown
from verification.harness.load import Run
from verification.stability.cracks import SCENES
from verification.stability.family import MARKED, STABLE, Checked, Family, Parameter, Point, at_most

SCENE = SCENES.parents[1] / "analytic" / "path_exp5.toml"
GROWTH_M = 10.0
CELLS = (0.25, 0.5, 1.0, 2.0, 4.0)


def wanders(run: Run) -> Checked:
    """Largest distance from the path by boundary elements, in cells: the converged one, or, for increments of 3 cells and more,
    which turn by all of the kink, the one of the same increments. The largest turn back and forth is told."""
    path, cell = grown(run), float(run.scene["numerics"]["cell_m"])
    short = run.increment_m < 3.0 * cell
    increment, turning = (0.5, "corrected") if short else (run.increment_m, "forward")
    off = farthest(path, exact_path(5, increment, turning, GROWTH_M + 1.0))
    steps = np.diff(path, axis=0)
    turns = np.diff(np.arctan2(steps[:, 0], steps[:, 1]))
    zigzag = float(np.max(np.abs(np.diff(turns)))) * run.increment_m / 4.0 if turns.size > 1 else 0.0
    return at_most(off / cell, 0.25, f"off the exact path {off / cell:.3f}, zigzag {zigzag / cell:.3f} cells")


def point(cells: float) -> Point:
    """Increments of so many cells of 1 m."""
    keys = ("numerics.cell_m=1.0", f"fracture.increment_m={cells}", f"stop.tip_y_m={5.0 + GROWTH_M}")
    return Point(f"{cells:g} cells", cells, SCENE, keys, smoke=cells == 4.0)


FAMILIES = (
    Family(
        name="increments", title="Growth in increments from a quarter of a cell to four cells",
        says="The path beside stiff rock (Experiment 5) stays within a quarter of a cell of that by boundary elements.",
        parameter=Parameter("increment", "cells", log=True), points=tuple(point(cells) for cells in CELLS), check=wanders,
        beyond=(STABLE, MARKED), check_name="distance over a quarter of a cell", section="Growth",
        about="A tip turns by what K_II says of the fracture as it is. Increments shorter than the rings turn before K_II"
              " has felt the last turn and"
              " overshoot; long ones cut corners. An increment turns by half of the kink at most (turn_share), less below 3 cells.",
    ),
)  # fmt: skip
