"""Growth in increments from a quarter of a cell to four cells: paths that wander."""

import numpy as np

from verification.harness.load import Run, given
from verification.harness.paths import ANALYTIC
from verification.ladder.cases.paths import exact_path, farthest, grown
from verification.stability.family import MARKED, STABLE, Checked, Family, Parameter, at_most, at_values, walked

GROWTH_M = 10.0


def wanders(run: Run) -> Checked:
    """Largest distance from the path by boundary elements, in cells: the converged one, or, for increments of 3 cells and more,
    which turn by all of the kink, the one of the same increments. The largest turn back and forth is told."""
    path, cell = grown(run), given(run, "numerics.cell_m")
    increment, turning = (0.5, "corrected") if run.increment_m < 3.0 * cell else (run.increment_m, "forward")
    off = farthest(path, exact_path(5, increment, turning, GROWTH_M + 1.0))
    steps = np.diff(path, axis=0)
    turns = np.diff(np.arctan2(steps[:, 0], steps[:, 1]))
    zigzag = float(np.max(np.abs(np.diff(turns)))) * run.increment_m / 4.0 if turns.size > 1 else 0.0
    return at_most(off / cell, 0.25, f"off the exact path {off / cell:.3f}, zigzag {zigzag / cell:.3f} cells")


FAMILIES = (
    Family(
        "increments", "Growth in increments from a quarter of a cell to four cells",
        "The path beside stiff rock (Experiment 5) stays within a quarter of a cell of that by boundary elements.",
        Parameter("increment", "cells", log=True),
        walked(at_values(ANALYTIC / "path_exp5.toml",
                         lambda cells: ("numerics.cell_m=1.0", f"fracture.increment_m={cells}", f"stop.tip_y_m={5.0 + GROWTH_M}"), "{:g} cells"),
               (0.25, 0.5, 1.0, 2.0, 4.0), smoke=(4.0,)), wanders,
        beyond=(STABLE, MARKED), check_name="distance over a quarter of a cell", section="Growth",
    ),
)  # fmt: skip
