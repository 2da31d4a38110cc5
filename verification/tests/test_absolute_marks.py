"""What K_I(t) and paths may be off by, whatever was measured: the gates of the ladder, which its runs are judged by, keep it.

The same of K near interfaces is in test_near_interfaces.py.
"""
from __future__ import annotations

import math

import pytest

from verification.harness.crack_paths import exact_path, rise_at
from verification.ladder import gates
from verification.ladder.cases import freund, paths
from verification.ladder.gates import Gates

CELL_M = 0.5
LEVEL = "0.5 m"
FARTHEST = "K_I(t) farthest off, c_P t = 10 cells to 60 m"
MEAN = "mean over h/c_R farthest off, same time"
ALONG_5, RISE_6 = "x along 20 m of path", "rise until 1 m to the side"


def error(family: Gates, case: str, quantity: str, level: str = LEVEL) -> float:
    """The largest relative error that passes; KeyError where no gate is of it."""
    return family[case, quantity, level].error


@pytest.mark.parametrize("case", [case.name for case in freund.CASES])
def test_K_of_a_suddenly_pressurised_crack(case: str) -> None:
    """K_I(t) within 5 % from c_P t = 10 cells to the first wave's return, its mean over a cell-crossing time within 3 %."""
    assert freund.SETTLED_CELLS <= 10.0, "the window of both quantities begins no later"
    known = gates.read("freund")
    assert error(known, case, FARTHEST) <= 0.05
    assert error(known, case, MEAN) <= 0.03


def test_path_of_experiment_5() -> None:
    """Within one cell over the first 20 m: n tips of which the rms is within e are each within sqrt(n) e."""
    increment_m, tips = 2.0 * CELL_M, paths.GROWTH_M / (2.0 * CELL_M)
    (level,) = (level for case in paths.CASES if case.name == "path_exp5" for level in case.levels if level.label == LEVEL)
    assert f"fracture.increment_m={increment_m!r}" in level.settings
    drift_m = abs(float(paths.converged_5()[-1, 0]))
    assert math.sqrt(tips) * error(gates.read("paths"), "path_exp5", ALONG_5) * drift_m <= CELL_M


def test_path_of_experiment_5_with_inertia_in_the_study_s_block() -> None:
    """Within one cell all along (errors of this quantity are in cells)."""
    assert error(gates.read("paths"), "path_exp5_explicit", "distance from the path, in cells", "1 m") <= 1.0


def test_path_of_experiment_6() -> None:
    """Where it is 1 m to the side, within one cell of the exact path of the same increment in height."""
    rise_m = rise_at(exact_path(6, 3.0 * CELL_M, "forward", paths.GROWTH_M), paths.TURN_M)
    assert error(gates.read("paths"), "path_exp6", RISE_6) * rise_m <= CELL_M
