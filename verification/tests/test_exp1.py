"""Experiment 1: where growth starts, how the fracture climbs, and its restart behind an interface by the energy of a finite increment."""

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


def net_restart_Pa(cell_m: float, increment_m: float) -> float:
    """Net inlet pressure at which the fracture under uniform pressure first goes on behind the soft interface, Pa."""
    settings = ("numerics.mechanics=quasistatic", f"numerics.cell_m={cell_m}", "numerics.far_cell_m=4", f"fracture.increment_m={increment_m}")
    run = completed(SCENE, "uniform_soft", settings)
    return next(event.inlet_Pa for event in run.summary.events if event.kind == "restart") - CLOSING_PA


# Gates: the finite increment releases what a fresh crack in cells of 1, 1/2, 1/4 of its length does; measured -8.5, -1.3, -0.3 %. That
# is three errors of the second order and less; zero, twice and the former restart (0.59 MPa, of a step from 1 to 2 m) fail them all.
@pytest.mark.slow
@pytest.mark.parametrize("increment_m", [0.5, 1.0, 2.0])
def test_restart_converges_to_the_reference_with_a_fixed_increment(increment_m: float) -> None:
    """Within 10 % with the increment in one cell, 5 % in two, 1 % in four: strata-reference crossing_pressure."""
    expected = value("crossing_pressure", "net_pressure_Pa", increment_m=increment_m)
    for cells, gate in ((1, 0.10), (2, 0.05), (4, 0.01)):
        if not 0.25 <= increment_m / cells <= 1.0:
            continue
        assert abs(net_restart_Pa(increment_m / cells, increment_m) / expected - 1.0) < gate


@pytest.mark.slow
def test_restart_with_increments_of_a_cell_does_not() -> None:
    """At 0.5 m the shorter increment asks for more pressure than the fixed one, and later arrests come with 0.25 m."""
    assert net_restart_Pa(0.5, 0.5) > 1.05 * net_restart_Pa(0.5, 1.0)


@pytest.mark.parametrize(("variant", "arrested"), [("uniform_weak", True), ("uniform_larger_margin_weak", False)])
def test_what_goes_first_on_arrival_decides_under_an_even_pressure(variant: str, arrested: bool) -> None:
    """A tip that arrives by itself is further beyond J_c (1.4 at 10 m) than the interface beyond its strength (1.1): it
    goes on unless the interface answers first."""
    run = completed(SCENE, variant, ("numerics.mechanics=quasistatic",))
    assert [event.kind for event in run.summary.events if event.kind in ("arrest", "restart")] == ["arrest", "restart"] * arrested
