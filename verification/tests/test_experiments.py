"""Regression: the six experiments at smoke size against experiments/expected/MECHANICS/*.json, which ci/accept rewrites."""

import copy
import math
from pathlib import Path
from typing import Any

import pytest

from verification.harness import smoke
from verification.harness.load import load
from verification.harness.scenes import MECHANICS, scenes_of
from verification.tests.cases import completed
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
