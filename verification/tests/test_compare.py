"""The comparison lets the right value pass and fails zero, twice, the flipped sign, NaN and no value."""
from __future__ import annotations

import math

import pytest

from verification.harness.compare import Expected, compare, require, within


def test_right_value_passes() -> None:
    require(compare("K_I", 1.004, within(1.0, 0.005)), compare("zero", 1e-4, Expected(0.0, 1e-3, scale=1.0)))


@pytest.mark.parametrize("factor", [0.0, 2.0, -1.0, math.nan, math.inf])
@pytest.mark.parametrize("value", [1.98e6, -3.0])
def test_wrong_values_fail(value: float, factor: float) -> None:
    with pytest.raises(AssertionError):
        require(compare("value", factor * value, within(value, 0.5)))


def test_missing_value_fails() -> None:
    assert not compare("value", None, within(1.0, 0.1)).passed


@pytest.mark.parametrize("value, tolerance", [(1.0, 1.0), (-2.0, 3.0), (0.0, 1.0), (math.nan, 0.1), (1.0, -0.1)])
def test_expectations_that_zero_or_twice_would_pass_are_refused(value: float, tolerance: float) -> None:
    with pytest.raises(ValueError):
        Expected(value, tolerance)


def test_all_failures_are_named_at_once() -> None:
    with pytest.raises(AssertionError, match="(?s)first.*second"):
        require(compare("first", 2.0, within(1.0, 0.1)), compare("good", 1.0, within(1.0, 0.1)), compare("second", 0.0, within(1.0, 0.1)))
