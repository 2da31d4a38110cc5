"""Flow into a fracture that starts closed: its start does not go by the cells, and what the floor of the opening decides is marked."""

from pathlib import Path
from typing import Any

import pytest

from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.tests.cases import rows_of, run_in, summary_in

# A closed fracture of 5 m under 10 MPa whose inlet rises by 1 MPa/s from 5 MPa.
RAMP = """\
domain = {width_m = 40, height_m = 40}
in_situ = {vertical_Pa = 12e6, horizontal_Pa = 10e6}
rock.r = {youngs_modulus_Pa = 10e9, poisson_ratio = 0.2, toughness_Pa_sqrt_m = 1e6}
strata.layers = [{rock = "r"}]
fracture = {path_m = [[20, 0], [20, 5]], increment_m = 0.5}
fluid = {law = "reynolds", viscosity_Pa_s = 1e-3, bulk_modulus_Pa = 2.2e9, minimum_opening_m = 1e-5, inlet = {start_Pa = 5e6, rate_Pa_s = 1e6}}
numerics = {mechanics = "quasistatic", cell_m = 0.5, far_cell_m = 4}
stop = {tip_y_m = 5.5, time_s = 20}
"""


def start_MPa(run: dict[str, Any]) -> float:
    return float(next(event["inlet_Pa"] for event in run["events"] if event["kind"] == "start")) / 1e6


def marks(run: dict[str, Any]) -> list[str]:
    """The monitors of the flow that mark a run."""
    return [mark["monitor"] for mark in run["suspect"] if mark["monitor"] in ("flow_fall", "floor_share", "fluid_imbalance")]


def test_the_start_under_a_ramp_is_that_of_resolved_cells(tmp_path: Path) -> None:
    """11.5 MPa by another model of the same equations; cells that part as a whole alone gave 14.3 at 0.5 m and 12.4 at 0.25 m."""
    coarse, fine = (summary_in(tmp_path, RAMP, f"numerics.cell_m={h}", f"fracture.increment_m={h}") for h in (0.5, 0.25))
    assert start_MPa(coarse) == pytest.approx(11.5, abs=0.25)  # a sixth of the net pressure
    assert start_MPa(fine) == pytest.approx(11.5, abs=0.2)
    assert abs(start_MPa(fine) - 11.5) < abs(start_MPa(coarse) - 11.5)
    assert marks(coarse) == marks(fine) == []


def test_closed_faces_that_hardly_conduct_part_by_the_fluid(tmp_path: Path) -> None:
    """Without a floor the fluid parts the faces ahead of it: 0.4 MPa more than with 1e-5 m at most, whatever the cells."""
    found = [start_MPa(summary_in(tmp_path, RAMP, "fluid.minimum_opening_m=0", f"numerics.cell_m={h}", f"fracture.increment_m={h}")) for h in (0.5, 0.25)]
    assert found[0] == pytest.approx(found[1], abs=0.1)
    assert 11.5 < found[0] < 12.0


def test_a_rate_into_a_closed_fracture_without_a_floor(tmp_path: Path) -> None:
    """The pressure of a fracture without toughness in the same rock (viscosity vertex) while the front goes through it; it was 2.8e12 Pa at
    1 ms. Full of fluid from the start its pressure was 18 to 20 % high."""
    rate = ("fluid.minimum_opening_m=0", "fluid.inlet={rate_m2_s=1e-4}", "numerics.cell_m=0.25", "fracture.increment_m=0.25")
    at_once = summary_in(tmp_path, RAMP, *rate, "stop.time_s=1e-3")
    assert at_once["inlet_Pa"] < 20e6
    for time_s in (4.0, 8.0):  # 1.5 and 2.4 m
        fluid = {"time_s": time_s, "viscosity_Pa_s": 1e-3, "rate_m2_s": 1e-4, "youngs_modulus_Pa": 10e9, "poisson_ratio": 0.2}
        net = float(summary_in(tmp_path, RAMP, *rate, f"stop.time_s={time_s}", f"output.fields_every_s={time_s}")["inlet_Pa"]) - 10e6
        assert net == pytest.approx(value("kgd_viscosity", "inlet_pressure_Pa", **fluid), rel=0.1)


@pytest.mark.parametrize(("lower_Pa", "upper_Pa"), [(20e6, 18e6), (18e6, 20e6)])
def test_a_rate_starts_at_the_least_closing_stress(tmp_path: Path, lower_Pa: float, upper_Pa: float) -> None:
    """A thousandth below the lower of two layers' stresses, wherever it lies: no face is open, and the first to part are that layer's."""
    layers = f'strata.layers=[{{rock="r", thickness_m=2, horizontal_Pa={lower_Pa}}}, {{rock="r", horizontal_Pa={upper_Pa}}}]'
    started = run_in(tmp_path, RAMP, layers, 'strata.interfaces=["perfect"]', "fluid.inlet={rate_m2_s=1e-4}", "stop={time_s=1e-3}")
    assert started.returncode == 0, started.stderr
    first = rows_of(tmp_path / "X")[0]
    assert float(first["time_s"]) == 0.0
    assert float(first["inlet_Pa"]) == pytest.approx(0.999 * 18e6, rel=1e-12)
    assert float(first["mouth_opening_m"]) == pytest.approx(0.0, abs=1e-7)


def test_the_study_s_law_without_a_floor_is_marked(tmp_path: Path) -> None:
    """A closed fracture does not conduct under it, so that the first segment's mean decides; with a floor it starts as under even pressure."""
    law = ("fluid.law=paper",)
    even = start_MPa(summary_in(tmp_path, RAMP, "fluid.law=uniform"))
    none = summary_in(tmp_path, RAMP, *law, "fluid.minimum_opening_m=0")
    assert start_MPa(none) > 1.5 * even and marks(none) == ["flow_fall"]
    inertia = ("numerics.mechanics=explicit", "numerics.damping_1_s=100", "fluid.inlet.start_Pa=9e6")
    assert marks(summary_in(tmp_path, RAMP, *law, *inertia, "fluid.minimum_opening_m=0")) == ["flow_fall"]
    sound = summary_in(tmp_path, RAMP, *law)
    assert start_MPa(sound) == pytest.approx(even, abs=0.05) and marks(sound) == []


@pytest.mark.parametrize("floor, off, marked", [("1e-4", (0.2, 0.4), ["floor_share"]), ("1e-5", (-0.06, 0.06), [])])
def test_a_floor_that_makes_a_fracture_longer_is_marked(tmp_path: Path, floor: str, off: tuple[float, float], marked: list[str]) -> None:
    """Water into rock without toughness, fed at a rate: the default floor makes it a quarter longer than the viscosity vertex says."""
    water = ("fluid.viscosity_Pa_s=1e-3", "rock.stiff.toughness_Pa_sqrt_m=0", f"fluid.minimum_opening_m={floor}")
    small = ("numerics.cell_m=0.25", "fracture.increment_m=0.25", "domain.width_m=160", "domain.height_m=80", "fracture.path_m=[[80, 0], [80, 1]]")
    run = summary_in(tmp_path, ANALYTIC / "kgd.toml", *water, *small, "stop.time_s=60")
    exact = value("kgd_viscosity", "half_length_m", time_s=60.0, viscosity_Pa_s=1e-3, rate_m2_s=1e-4, youngs_modulus_Pa=10e9, poisson_ratio=0.2)
    assert off[0] < float(run["tips"][0]["y_m"]) / exact - 1.0 < off[1]
    assert marks(run) == marked
