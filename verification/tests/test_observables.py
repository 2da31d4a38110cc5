"""Observables of made-up runs whose answers are known, and of mutations of them that must be told apart."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verification.harness.load import Run, load
from verification.harness.observables import Measured, failed_length_m, measure
from verification.tests.fake_run import Step, climb, write_run

MPA = 1.0e6


def make(tmp_path: Path, name: str, steps: Sequence[Step], **options: Any) -> Run:
    """A made-up run, loaded."""
    return load(write_run(tmp_path / "exp" / name, steps, **options))


def test_start_and_its_shift(tmp_path: Path) -> None:
    a, b = make(tmp_path, "a", climb(2.40 * MPA)), make(tmp_path, "b", climb(2.36 * MPA))
    never = make(tmp_path, "never", [], end_Pa=4.0 * MPA)
    assert measure("start_Pa", {}, a, None).value == pytest.approx(2.40 * MPA)
    assert measure("start_shift_Pa", {}, a, b).value == pytest.approx(0.04 * MPA)
    assert measure("start_shift_Pa", {}, b, a).value == pytest.approx(-0.04 * MPA)
    shift = measure("start_shift_Pa", {}, never, b)
    assert (shift.low, shift.high) == (pytest.approx(1.64 * MPA), math.inf)


@pytest.mark.parametrize("height", [9.0, 10.0, 11.0, 14.0])
def test_plateau_at_the_interface(tmp_path: Path, height: float) -> None:
    run = make(tmp_path, "weak", climb(plateaus={height: 0.2 * MPA}))
    found = measure("plateau_Pa", {"interface": 1}, run, None)
    assert found.value == pytest.approx(0.205 * MPA)
    assert found.flags == ("J at interface",)


@pytest.mark.parametrize("height, rise", [(8.0, 0.2), (15.0, 0.2), (10.0, 0.02)])
def test_no_plateau_elsewhere_or_for_less_than_an_arrest(tmp_path: Path, height: float, rise: float) -> None:
    run = make(tmp_path, "weak", climb(plateaus={height: rise * MPA}))
    assert measure("plateau_Pa", {"interface": 1}, run, None).value == 0.0


def test_a_plateau_without_end_is_a_bound(tmp_path: Path) -> None:
    run = make(tmp_path, "weak", climb(to_m=10.0), end_Pa=4.0 * MPA)
    found = measure("plateau_Pa", {"interface": 1}, run, None)
    assert found.low == pytest.approx(1.62 * MPA) and found.high == math.inf
    assert found.holds(0.05 * MPA, None) is True
    assert found.holds(None, 2.0 * MPA) is None, "it may be longer than the run shows"
    assert found.holds(None, 1.0 * MPA) is False


def test_an_interface_out_of_reach_has_no_plateau(tmp_path: Path) -> None:
    found = measure("plateau_Pa", {"interface": 1}, make(tmp_path, "weak", climb(to_m=7.0)), None)
    assert found.value is None and found.holds(None, 1.0) is None


def test_plateau_ratio(tmp_path: Path) -> None:
    a = make(tmp_path, "a", climb(plateaus={10.0: 0.195 * MPA}))
    b = make(tmp_path, "b", climb(plateaus={10.0: 0.095 * MPA}))
    flat = make(tmp_path, "flat", climb())
    assert measure("plateau_ratio", {"interface": 1}, a, b).value == pytest.approx(2.0)
    assert measure("plateau_ratio", {"interface": 1}, a, flat).holds(0.5, 2.0) is False, "one without a plateau is not alike"
    assert measure("plateau_ratio", {"interface": 1}, flat, flat).holds(0.5, 2.0) is None, "nothing to compare"
    assert measure("plateau_ratio", {"interface": 1}, flat, a).value == 0.0


def test_pressure_shift(tmp_path: Path) -> None:
    parameters = {"from_m": 6, "to_m": 30}
    perfect = make(tmp_path, "perfect", climb())
    later = make(tmp_path, "later", climb(plateaus={15.0: 0.07 * MPA}))
    stuck = make(tmp_path, "stuck", climb(to_m=12.0), end_Pa=3.0 * MPA)
    assert measure("pressure_shift_Pa", parameters, perfect, perfect).value == 0.0
    assert measure("pressure_shift_Pa", parameters, later, perfect).value == pytest.approx(0.07 * MPA)
    assert measure("pressure_shift_Pa", parameters, perfect, later).value == pytest.approx(0.07 * MPA)
    assert measure("pressure_shift_Pa", {"from_m": 6, "to_m": 15}, later, perfect).value == pytest.approx(0.0)
    found = measure("pressure_shift_Pa", parameters, stuck, perfect)
    assert found.high == math.inf and found.low == pytest.approx(3.0 * MPA - (2.36 * MPA + 7 * 5.0e3))


def test_height_ratio_and_pressure_at_height(tmp_path: Path) -> None:
    perfect = make(tmp_path, "perfect", climb())
    stuck = make(tmp_path, "stuck", climb(to_m=12.0), end_Pa=3.0 * MPA)
    assert measure("height_ratio", {"height_m": 60}, stuck, perfect).value == pytest.approx(0.2)
    assert measure("height_ratio", {"height_m": 60}, perfect, perfect).value == pytest.approx(1.0)
    assert measure("height_ratio", {"height_m": 60}, perfect, stuck).value is None
    found = measure("pressure_at_height_difference_Pa", {"height_m": 22}, stuck, perfect)
    assert found.low == pytest.approx(3.0 * MPA - 2.44 * MPA) and found.high == math.inf


def test_arrests_of_a_fracture_that_grows(tmp_path: Path) -> None:
    above = {"from_m": 8}
    assert measure("arrests", above, make(tmp_path, "a", climb(), end_Pa=2.7 * MPA), None).value == 0
    assert measure("arrests", above, make(tmp_path, "b", climb(plateaus={20.0: 0.1 * MPA}), end_Pa=2.8 * MPA), None).value == 1
    assert measure("arrests", above, make(tmp_path, "c", climb(plateaus={7.0: 0.1 * MPA}), end_Pa=2.8 * MPA), None).value == 0
    assert measure("arrests", above, make(tmp_path, "never", []), None).holds(None, 0) is None


def bent(degrees: float, length_m: float = 30.0) -> list[Step]:
    """A path that leaves the vertical by an angle (clockwise positive) at 5 m."""
    angle = math.radians(degrees)
    return [(2.4 * MPA + s, 40.0 + s * math.sin(angle), 5.0 + s * math.cos(angle)) for s in range(1, int(length_m) + 1)]


def test_paths(tmp_path: Path) -> None:
    straight = make(tmp_path, "straight", climb(to_m=35.0))
    right, left = make(tmp_path, "right", bent(30.0)), make(tmp_path, "left", bent(-30.0))
    assert measure("lateral_deflection_m", {}, right, None).value == pytest.approx(15.0)
    assert measure("lateral_deflection_m", {}, left, None).value == pytest.approx(-15.0)
    assert measure("final_angle_deg", {}, right, None).value == pytest.approx(60.0)
    assert measure("final_angle_deg", {}, left, None).value == pytest.approx(60.0)
    assert measure("path_change", {}, right, right).value == pytest.approx(0.0, abs=1e-12)
    # Paths at 60 degrees to each other: at s from the kink s sin 60 apart, and the other one s sin 30 off its first direction.
    assert measure("path_change", {}, right, left).value == pytest.approx(math.sqrt(3.0), rel=0.02)
    assert measure("path_change", {}, right, straight).value is None


def test_interface_failure_and_energy(tmp_path: Path) -> None:
    fails = make(tmp_path, "a", climb(), friction_J=65.0, failed_m=[(2.0 * MPA, 0.0), (2.4 * MPA, 1.0), (2.5 * MPA, 4.0)])
    other = make(tmp_path, "b", climb(), friction_J=0.0, failed_m=[(2.0 * MPA, 0.0)])
    near = 2.36 * MPA + 3 * 5.0e3  # the tip is at 9 m, the first step within 1.5 increments of the interface
    assert measure("interface_failure_excess_Pa", {"interface": 1}, fails, None).value == pytest.approx(2.5 * MPA - near, rel=1e-6)
    assert measure("interface_failure_excess_Pa", {"interface": 1}, other, None).holds(None, 0.1 * MPA) is False
    assert measure("interface_energy_difference_J", {"height_m": 22}, fails, other).value == pytest.approx(17.0)
    assert measure("interface_energy_difference_J", {"height_m": 22}, other, fails).value == pytest.approx(-17.0)


def test_a_failed_length_counts_each_place_by_the_way_to_its_neighbours() -> None:
    """On a graded grid places are unlike: two of 0.5 m and one of 1.25 m, whatever their order."""
    x, split = np.array([0.25, 0.75, 1.25, 2.25, 3.75]), np.array([1, 1, 0, 1, 0])
    for order in (np.arange(5), np.array([3, 0, 4, 2, 1])):
        assert failed_length_m({"0/x_m": x[order], "0/split": split[order]}, 1) == pytest.approx(2.25)
    assert failed_length_m({"0/x_m": x[:1], "0/split": split[:1]}, 1) == 0.0


def test_bounds_are_judged_by_both_ends() -> None:
    assert Measured(1.0, 2.0).holds(0.5, 2.5) is True
    assert Measured(1.0, 2.0).holds(1.5, None) is None
    assert Measured(1.0, 2.0).holds(2.5, None) is False
    assert Measured(math.nan, math.nan).holds(None, 1.0) is None


def test_heights_may_be_given_above_an_interface(tmp_path: Path) -> None:
    low = make(tmp_path, "low", climb(to_m=14.0))
    layers = '[{rock = "stiff", thickness_m = 15.0}, {rock = "stiff", thickness_m = 65.0}]'
    high = make(tmp_path, "high", climb(to_m=14.0), layers=layers)
    assert measure("final_height_m", {}, low, None).value == pytest.approx(14.0)
    assert measure("final_height_m", {"above_interface": 1}, low, None).value == pytest.approx(4.0)
    assert measure("final_height_m", {"above_interface": 1}, high, None).value == pytest.approx(-1.0)
    late = make(tmp_path, "late", climb(2.40 * MPA, to_m=14.0))
    given = {"height_m": {"interface": 1, "plus_m": 2}}
    assert measure("pressure_at_height_difference_Pa", given, late, low).value == pytest.approx(0.04 * MPA)
    assert not measure("pressure_at_height_difference_Pa", given, high, low).exact, "17 m is not reached"


def test_a_quasistatic_plateau_is_flagged_where_J_decided_it(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "exp" / "weak", climb(plateaus={10.0: 0.2 * MPA}), mechanics="quasistatic")
    assert measure("plateau_Pa", {"interface": 1}, load(folder), None).flags == ()
    summary = json.loads((folder / "summary.json").read_text())
    for by, expected in (("energy", ()), ("J", ("J at interface",))):
        for event in summary["events"]:
            event |= {"by": by, "at_interface": True}
        (folder / "summary.json").write_text(json.dumps(summary))
        assert measure("plateau_Pa", {"interface": 1}, load(folder), None).flags == expected
