"""Compares measured with expected values; an expectation so loose that zero or twice would pass is refused."""
from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Expected:
    """A value, how far from it is allowed (same unit) and the unit.

    For a value of zero give the scale that the tolerance is small against.
    """

    value: float
    tolerance: float
    unit: str = ""
    scale: float | None = None

    def __post_init__(self) -> None:
        size = abs(self.value) if self.scale is None else self.scale
        if not (math.isfinite(self.value) and math.isfinite(self.tolerance) and self.tolerance >= 0.0):
            raise ValueError(f"expected value {self.value} with tolerance {self.tolerance} is not finite or negative")
        if self.tolerance >= size:
            raise ValueError(f"a tolerance of {self.tolerance} {self.unit} would let zero or twice {self.value} pass")


def within(value: float, share: float, unit: str = "") -> Expected:
    """An expected value with a relative tolerance."""
    return Expected(value, share * abs(value), unit)


@dataclass(frozen=True)
class Comparison:
    """A measured value beside the expected one."""

    name: str
    measured: float
    expected: Expected

    @property
    def error(self) -> float:
        """Measured minus expected, in the unit of both."""
        return self.measured - self.expected.value

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance; NaN never is."""
        return abs(self.error) <= self.expected.tolerance

    def __str__(self) -> str:
        size = abs(self.expected.value)
        relative = f" ({100.0 * self.error / size:+.3f} %)" if size > 0.0 else ""
        return (
            f"{self.name}: {self.measured:.6g} against {self.expected.value:.6g} {self.expected.unit},"
            f" off by {self.error:+.3g}{relative}, allowed {self.expected.tolerance:.3g}: {'pass' if self.passed else 'FAIL'}"
        )


def compare(name: str, measured: float | None, expected: Expected) -> Comparison:
    """Put a measured value, or None for one that does not exist, beside the expected one."""
    return Comparison(name, math.nan if measured is None else float(measured), expected)


def require(*comparisons: Comparison) -> None:
    """Print all comparisons and raise AssertionError with those that fail."""
    for comparison in comparisons:
        print(comparison)
    failed = [str(comparison) for comparison in comparisons if not comparison.passed]
    if failed:
        raise AssertionError("\n".join(failed))
