"""Experiment 1 with a perfect interface: where growth starts, and how the fracture climbs."""

import pytest

from verification.harness.load import Run
from verification.harness.observables import measure
from verification.harness.paths import EXPERIMENTS
from verification.harness.reference import value
from verification.tests.cases import completed

SCENE = EXPERIMENTS / "exp1_single_interface.toml"


def net_start_Pa(run: Run) -> float | None:
    """Inlet pressure of the first growth less the closing stress, Pa."""
    start = measure("start_Pa", {}, run, None)
    return start.low - float(run.scene["in_situ"]["horizontal_Pa"]) if start.exact else None


@pytest.mark.slow
@pytest.mark.parametrize("sides", ["traction", "fixed"])
def test_uniform_pressure_starts_at_the_critical_pressure_and_runs(sides: str) -> None:
    run = completed(SCENE, "uniform", (f"domain.sides={sides}",))
    expected = value("block_crack", "critical_net_pressure_Pa", half_length_m=5.0, width_m=80.0, half_height_m=80.0, edges=sides)
    assert net_start_Pa(run) == pytest.approx(expected, rel=0.02)
    start = measure("start_Pa", {}, run, None).low
    assert measure("final_height_m", {}, run, None).low >= 70.0
    assert run.summary.inlet_Pa - start < 0.1 * (start - 2.0e6), "growth under uniform pressure is unstable: a jump, no slope"


@pytest.mark.slow
def test_the_study_s_flow_with_dry_points_climbs_with_a_slope() -> None:
    run = completed(SCENE, "perfect")
    uniform = completed(SCENE, "uniform", ("domain.sides=fixed",))
    heights = (20.0, 35.0, 50.0, 65.0)
    pressures = [measure("pressure_at_height_difference_Pa", {"height_m": height}, run, uniform).low for height in heights]
    assert all(later - earlier > 0.01e6 for earlier, later in zip(pressures, pressures[1:])), pressures
