"""The experiments. Regression: all six at smoke size against experiments/expected/MECHANICS/*.json, which ci/accept rewrites. Experiment 1: where growth
starts, how the fracture climbs, and what goes first on arrival (its restart behind the interface is the ladder's, crossing). Of whole runs: the energy ledger
closes, summed here from its parts; the result depends neither on the number of threads nor on when it is made."""

import copy
import math
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from verification.faults.same import differences
from verification.harness import smoke
from verification.harness.load import Run, load, value
from verification.harness.observables import measure
from verification.harness.paths import ANALYTIC, EXPERIMENTS
from verification.harness.run import Job, run
from verification.harness.scenes import MECHANICS, scenes_of
from verification.tests.cases import completed, strata
from verification.tests.fake_run import climb, write_run


@pytest.mark.slow
@pytest.mark.parametrize("mechanics, experiment, variant", smoke.cases())
def test_as_expected(mechanics: str, experiment: str, variant: str) -> None:
    expected = smoke.read_expected(mechanics, experiment).get(variant)
    assert expected, f"nothing is expected of {mechanics} {experiment} {variant}: ci/accept writes it"
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.settings_of(mechanics))
    assert run.summary.mechanics == mechanics
    assert smoke.differences(smoke.measured_values(run), expected) == []


EXPECTED: smoke.Values = {
    "start_Pa": {"value": 2.36e6, "unit": "Pa", "tolerance": 4.0e4},
    "final_height_m": {"value": 70.0, "unit": "m", "tolerance": 1.0},
}


@pytest.mark.parametrize("name", EXPECTED)
@pytest.mark.parametrize("factor", [0.0, 2.0, -1.0, math.nan, math.inf])
def test_the_regression_fails_zero_twice_flipped_and_no_number(name: str, factor: float) -> None:
    found: dict[str, Any] = copy.deepcopy(EXPECTED)
    assert smoke.differences(found, EXPECTED) == []
    found[name]["value"] *= factor
    (said,) = smoke.differences(found, EXPECTED)
    assert said.startswith(f"{name}: ")


@pytest.mark.parametrize("value, tolerance", [(1.0, 1.0), (-2.0, 3.0), (0.0, 1.0), (math.nan, 0.1), (1.0, -0.1)])
def test_expectations_that_zero_or_twice_would_pass_are_refused(value: float, tolerance: float) -> None:
    item = {"value": value, "unit": "m", "tolerance": tolerance}
    with pytest.raises(ValueError, match="zero or twice"):
        smoke.differences({"a": item}, {"a": item})


def test_the_regression_fails_a_missing_and_an_unexpected_value() -> None:
    assert smoke.differences({"start_Pa": EXPECTED["start_Pa"]}, EXPECTED) == ["final_height_m: not there"]
    assert smoke.differences({**EXPECTED, "arrest_at_10m_Pa": EXPECTED["start_Pa"]}, EXPECTED) == ["arrest_at_10m_Pa: not expected"]


def test_arrests_are_compared_by_height_and_only_short_ones_may_be_missing(tmp_path: Path) -> None:
    long, short, none = (smoke.measured_values(load(write_run(tmp_path / f"{rise}", climb(plateaus={10.0: rise})))) for rise in (0.2e6, 0.047e6, 0.043e6))
    assert "restart_from_10m_Pa" in long and "restart_from_10m_Pa" in short and "restart_from_10m_Pa" not in none
    assert smoke.differences(short, none) == smoke.differences(none, short) == []
    for found, expected in ((long, none), (none, long), (long, short)):
        assert any("10m" in line for line in smoke.differences(found, expected))


def test_the_regression_has_every_experiment_in_each_mechanics() -> None:
    found = {case[:2] for case in smoke.cases()}
    assert found == {(mechanics, scene.stem) for mechanics in MECHANICS for scene in scenes_of(smoke.EXPERIMENTS)}
    assert all(smoke.read_expected("explicit", experiment) for experiment in smoke.VARIANTS)


def test_what_is_accepted_is_what_is_expected_then(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(smoke, "EXPECTED", tmp_path)
    found = smoke.measured_values(load(write_run(tmp_path / "runs" / "one", climb(), mechanics="quasistatic")))
    smoke.write_expected("quasistatic", "exp", {"one": found})
    assert smoke.read_expected("quasistatic", "exp") == {"one": found} and smoke.read_expected("explicit", "exp") == {}
    assert found["start_Pa"]["tolerance"] < smoke.PRESSURE_TOLERANCE_PA["explicit"]


EXP1 = EXPERIMENTS / "exp1_single_interface.toml"
CLOSING_PA = 2.0e6


@pytest.mark.slow
@pytest.mark.parametrize("sides", ["traction", "fixed"])
def test_uniform_pressure_starts_at_the_critical_pressure_and_runs(sides: str) -> None:
    run = completed(EXP1, "uniform", (f"domain.sides={sides}",))
    expected = value("block_crack", "critical_net_pressure_Pa", half_length_m=5.0, width_m=80.0, half_height_m=80.0, edges=sides)
    measured = measure("start_Pa", {}, run, None)
    start = measured.low
    assert measured.exact and start - CLOSING_PA == pytest.approx(expected, rel=0.02)
    assert measure("final_height_m", {}, run, None).low >= 70.0
    assert run.summary.inlet_Pa - start < 0.1 * (start - CLOSING_PA), "growth under uniform pressure is unstable: a jump, no slope"


@pytest.mark.slow
def test_the_study_s_flow_with_dry_points_climbs_with_a_slope() -> None:
    run, uniform = completed(EXP1, "perfect"), completed(EXP1, "uniform", ("domain.sides=fixed",))
    pressures = [measure("pressure_at_height_difference_Pa", {"height_m": height}, run, uniform).low for height in (20.0, 35.0, 50.0, 65.0)]
    assert all(later - earlier > 0.01e6 for earlier, later in zip(pressures, pressures[1:])), pressures


@pytest.mark.parametrize(("variant", "arrested"), [("uniform_weak", True), ("uniform_larger_margin_weak", False)])
def test_what_goes_first_on_arrival_decides_under_an_even_pressure(variant: str, arrested: bool) -> None:
    """A tip that arrives by itself is further beyond J_c (1.4 at 10 m) than the interface beyond its strength (1.1): it
    goes on unless the interface answers first."""
    run = completed(EXP1, variant, ("numerics.mechanics=quasistatic",))
    assert [event.kind for event in run.summary.events if event.kind in ("arrest", "restart")] == ["arrest", "restart"] * arrested


STORED = ("kinetic_J", "strain_J", "interface_strain_J")
DISSIPATED = ("damping_J", "transfer_J", "integration_J", "friction_J", "failure_J", "fracture_J", "excess_J")
SUPPLIED = ("fluid_work_J", "in_situ_work_J", "edge_work_J", "body_work_J", "initial_kinetic_J")


def total(run: Run, names: tuple[str, ...]) -> np.ndarray:
    """Sum of columns of the history, J/m."""
    return np.sum([run.history[name] for name in names], axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("mechanics, experiment, variant", smoke.cases())
def test_the_ledger_closes_over_a_whole_run(mechanics: str, experiment: str, variant: str) -> None:
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.settings_of(mechanics))
    assert run.history["fluid_work_J"].max() > 1.0, "a run in which nothing happens closes too"
    unknown = {name for name in run.history if name.endswith("_J")} - {*STORED, *DISSIPATED, *SUPPLIED}
    assert not unknown, f"where do {unknown} belong?"
    # Net: most of the fluid's work goes against the in-situ stress, and the sum of both is what the rock got.
    net, unexplained = float(np.max(np.abs(total(run, SUPPLIED)))), total(run, STORED) + total(run, DISSIPATED) - total(run, SUPPLIED)
    assert np.max(np.abs(unexplained)) < 0.01 * net
    for name in ("damping_J", "friction_J"):  # beyond what sticking points give back, nothing spent returns
        fall = float(np.max(np.maximum.accumulate(run.history[name]) - run.history[name]))
        assert fall <= 1e-4 * net, f"{name} falls by {fall} J of {net} J supplied"


# Long enough to start, grow and meet the interface at 2 m cells, with the ramp begun just below the start of growth.
SHORT = ("numerics.cell_m=2.0", "fracture.increment_m=2.0", "stop.time_s=0.6", "stop.tip_y_m=15", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")
QUASISTATIC = ("numerics.cell_m=2", "fracture.increment_m=2", "numerics.mechanics=quasistatic", "fluid.law=uniform", "stop.tip_y_m=20")


@pytest.mark.parametrize("scene, variant, settings", [
    ("exp1_single_interface", "weak", SHORT), ("exp4_soft_between", "friction", SHORT), ("exp5_parallel_interface", "soft", SHORT),
    ("exp1_single_interface", "soft", QUASISTATIC),
])  # fmt: skip
def test_same_digits_on_one_and_two_threads_and_again(tmp_path: Path, scene: str, variant: str, settings: tuple[str, ...]) -> None:
    folders = []
    for name, threads in (("one", 1), ("two", 2), ("again", 2)):
        outcome = run(Job(EXPERIMENTS / f"{scene}.toml", variant, tmp_path / name, settings, threads))
        assert outcome.ok, outcome.reason
        folders.append(tmp_path / name)
    for other in folders[1:]:
        assert differences(folders[0], other) == []
    assert len((folders[0] / "history.csv").read_text().splitlines()) > 3


def test_a_run_of_unknown_length_writes_ever_rarer_fields(tmp_path: Path) -> None:
    """Nothing but a height ends it: every 0.02 s up to 0.2 s, then each time a tenth later than the one before; the last is the run's end."""
    assert strata(tmp_path, "run", ANALYTIC / "three_layers.toml", "--out", tmp_path / "X", "--quiet").returncode == 0
    with h5py.File(tmp_path / "X/result.h5") as file:
        times = file["times"][:-1]
    assert times[-1] > 1.0 and np.diff(times) == pytest.approx(np.maximum(0.02, 0.1 * times[:-1]))
