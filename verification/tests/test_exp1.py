"""Experiment 1: where growth starts, how the fracture climbs, and what goes first on arrival. Its restart behind the interface is the ladder's (crossing)."""

import pytest

from verification.harness.observables import measure
from verification.harness.paths import EXPERIMENTS
from verification.harness.reference import value
from verification.tests.cases import completed

SCENE = EXPERIMENTS / "exp1_single_interface.toml"
CLOSING_PA = 2.0e6


@pytest.mark.slow
@pytest.mark.parametrize("sides", ["traction", "fixed"])
def test_uniform_pressure_starts_at_the_critical_pressure_and_runs(sides: str) -> None:
    run = completed(SCENE, "uniform", (f"domain.sides={sides}",))
    expected = value("block_crack", "critical_net_pressure_Pa", half_length_m=5.0, width_m=80.0, half_height_m=80.0, edges=sides)
    measured = measure("start_Pa", {}, run, None)
    start = measured.low
    assert measured.exact and start - CLOSING_PA == pytest.approx(expected, rel=0.02)
    assert measure("final_height_m", {}, run, None).low >= 70.0
    assert run.summary.inlet_Pa - start < 0.1 * (start - CLOSING_PA), "growth under uniform pressure is unstable: a jump, no slope"


@pytest.mark.slow
def test_the_study_s_flow_with_dry_points_climbs_with_a_slope() -> None:
    run, uniform = completed(SCENE, "perfect"), completed(SCENE, "uniform", ("domain.sides=fixed",))
    pressures = [measure("pressure_at_height_difference_Pa", {"height_m": height}, run, uniform).low for height in (20.0, 35.0, 50.0, 65.0)]
    assert all(later - earlier > 0.01e6 for earlier, later in zip(pressures, pressures[1:])), pressures


@pytest.mark.parametrize(("variant", "arrested"), [("uniform_weak", True), ("uniform_larger_margin_weak", False)])
def test_what_goes_first_on_arrival_decides_under_an_even_pressure(variant: str, arrested: bool) -> None:
    """A tip that arrives by itself is further beyond J_c (1.4 at 10 m) than the interface beyond its strength (1.1): it
    goes on unless the interface answers first."""
    run = completed(SCENE, variant, ("numerics.mechanics=quasistatic",))
    assert [event.kind for event in run.summary.events if event.kind in ("arrest", "restart")] == ["arrest", "restart"] * arrested
