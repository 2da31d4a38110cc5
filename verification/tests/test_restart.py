"""Restart behind an interface by the energy of a finite increment: it does not hang on the cells, by increments of a cell it does."""
from __future__ import annotations

import pytest

from verification.harness.paths import EXPERIMENTS
from verification.tests.cases import completed

SCENE = EXPERIMENTS / "exp1_single_interface.toml"
CLOSING_PA = 2.0e6


def net_restart_Pa(cell_m: float, increment_m: float) -> float:
    """Net inlet pressure at which the fracture under uniform pressure first goes on behind the soft interface, Pa."""
    settings = (
        "numerics.mechanics=quasistatic", f"numerics.cell_m={cell_m}", "numerics.far_cell_m=4", f"fracture.increment_m={increment_m}"
    )
    run = completed(SCENE, "uniform_soft", settings)
    return next(event.inlet_Pa for event in run.summary.events if event.kind == "restart") - CLOSING_PA


# A restart that is never or at once is off by a hundred per cent. With crossing = "J" no restart by energy exists.
@pytest.mark.slow
def test_restart_converges_with_a_fixed_increment() -> None:
    """Within 8 % between 0.5 and 0.25 m at an increment of 1 m, and nearer to each other than to what 1 m cells give."""
    at = {cell_m: net_restart_Pa(cell_m, 1.0) for cell_m in (1.0, 0.5, 0.25)}
    print(at)
    assert abs(at[0.25] / at[0.5] - 1.0) < 0.08
    assert abs(at[0.25] - at[0.5]) < abs(at[0.5] - at[1.0])


@pytest.mark.slow
def test_restart_with_increments_of_a_cell_does_not() -> None:
    """At 0.5 m the shorter increment asks for more pressure than the fixed one, and later arrests come with 0.25 m."""
    assert net_restart_Pa(0.5, 0.5) > 1.05 * net_restart_Pa(0.5, 1.0)
