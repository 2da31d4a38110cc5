"""Regression: the six experiments at smoke size against experiments/expected/*.json, which ci/accept rewrites."""
from __future__ import annotations

import copy
from typing import Any

import pytest

from verification.harness import smoke
from verification.harness.compare import require
from verification.tests.cases import completed


@pytest.mark.slow
@pytest.mark.parametrize("experiment, variant", smoke.cases())
def test_as_expected(experiment: str, variant: str) -> None:
    expected = smoke.read_expected(experiment).get(variant)
    assert expected, f"nothing is expected of {experiment} {variant}: ci/accept writes it"
    run = completed(smoke.EXPERIMENTS / f"{experiment}.toml", variant, smoke.SETTINGS)
    require(*smoke.compare_values(smoke.measured_values(run), expected))


EXPECTED: smoke.Values = {
    "start_1_Pa": {"value": 2.36e6, "unit": "Pa", "tolerance": 4.0e4},
    "final_height_m": {"value": 70.0, "unit": "m", "tolerance": 1.0},
}


@pytest.mark.parametrize("name", EXPECTED)
@pytest.mark.parametrize("factor", [0.0, 2.0, -1.0])
def test_the_regression_fails_zero_twice_and_flipped(name: str, factor: float) -> None:
    found: dict[str, Any] = copy.deepcopy(EXPECTED)
    require(*smoke.compare_values(found, EXPECTED))
    found[name]["value"] *= factor
    with pytest.raises(AssertionError):
        require(*smoke.compare_values(found, EXPECTED))


def test_the_regression_fails_a_missing_and_an_unexpected_value() -> None:
    with pytest.raises(AssertionError, match="final_height_m"):
        require(*smoke.compare_values({"start_1_Pa": EXPECTED["start_1_Pa"]}, EXPECTED))
    with pytest.raises(AssertionError, match="arrest_1_Pa"):
        require(*smoke.compare_values({**EXPECTED, "arrest_1_Pa": EXPECTED["start_1_Pa"]}, EXPECTED))
