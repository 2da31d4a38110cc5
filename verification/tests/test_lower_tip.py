"""The lower of two tips: its place and K in history.csv, the stop by its place, and what is refused."""

import math
from pathlib import Path

import pytest

from verification.harness.load import read_history
from verification.harness.paths import ANALYTIC
from verification.tests.cases import completed, run_in, strata, summary_of

SCENE = ANALYTIC / "heavy_fluid.toml"
WEIGHTLESS = "fluid.density_kg_m3=0"
GROWS = SCENE.read_text(encoding="utf-8").replace('growth = "none"', 'growth = "J"').replace("time_s = 0\n", "lower_tip_y_m = 11\n")
RISES = (WEIGHTLESS, "fluid.inlet={start_Pa=20.1e6, rate_Pa_s=1e5}", "numerics.far_cell_m=2")


def test_K_of_both_tips_under_the_weight_of_the_fluid() -> None:
    """sqrt(pi a) (p +- rho g a/2), the sum at the lower tip: 1.9563 and 1.4067 MPa sqrt(m), to 0.5 %; K_II is none of it."""
    row = {name: values[-1] for name, values in completed(SCENE).history.items()}
    by_weight = {sign: math.sqrt(math.pi * 10.0) * (0.3e6 + sign * 9806.65 * 5.0) for sign in (1.0, -1.0)}
    assert (by_weight[1.0], by_weight[-1.0]) == pytest.approx((1.9563e6, 1.4067e6), rel=1e-4)
    assert row["lower_tip_K_I_Pa_sqrt_m"] == pytest.approx(by_weight[1.0], rel=5e-3)
    assert row["K_I_Pa_sqrt_m"] == pytest.approx(by_weight[-1.0], rel=5e-3)
    assert abs(row["lower_tip_K_II_Pa_sqrt_m"]) < 1e-6 * row["K_I_Pa_sqrt_m"]
    assert (row["tip_y_m"], row["lower_tip_y_m"]) == pytest.approx((34.0, 14.0), abs=1e-9)
    assert row["lower_tip_J_N_m"] == pytest.approx(by_weight[1.0] ** 2 / (10e9 / 0.96), rel=2e-2)  # K^2/E'; J of the upper tip is half as large
    assert (row["lower_tip_x_m"], row["lower_tip_near"]) == (pytest.approx(row["tip_x_m"]), 0.0)


def test_a_symmetric_fracture_has_two_equal_tips_and_stops_by_the_lower_one(tmp_path: Path) -> None:
    """About y = 24 m: K_I equal to round-off, the places mirror images in each row. A scene that shears turns K_II about alike at both."""
    assert run_in(tmp_path, GROWS, *RISES).returncode == 0
    summary = summary_of(tmp_path / "X")
    assert summary["reason"] == "lower tip reached y = 11 m"
    assert [tip["tip"] for tip in sorted(summary["tips"], key=lambda tip: tip["y_m"])] == ["lower", "upper"]
    assert {(event["tip"], round(event["tip_y_m"])) for event in summary["events"] if event["kind"] == "start"} == {("lower", 14), ("upper", 34)}
    stop = summary["events"][-1]
    assert (stop["kind"], stop["tip"], stop["tip_y_m"]) == ("stop", "lower", pytest.approx(11.0, abs=1e-2))
    history = read_history(tmp_path / "X" / "history.csv")
    assert history["lower_tip_K_I_Pa_sqrt_m"] == pytest.approx(history["K_I_Pa_sqrt_m"], rel=1e-9)
    assert 0.5e6 < min(history["K_I_Pa_sqrt_m"]) < 0.6e6
    assert history["lower_tip_y_m"] == pytest.approx(48.0 - history["tip_y_m"], abs=1e-9)
    assert history["lower_tip_y_m"][0] == pytest.approx(14.0) and history["lower_tip_y_m"][-1] <= 11.001
    sheared = completed(SCENE, "", (WEIGHTLESS, "in_situ.shear_Pa=1e5")).history
    assert sheared["lower_tip_K_II_Pa_sqrt_m"] == pytest.approx(sheared["K_II_Pa_sqrt_m"], rel=1e-9)
    assert abs(sheared["K_II_Pa_sqrt_m"][-1]) == pytest.approx(1e5 * math.sqrt(math.pi * 10.0), rel=5e-3)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (("stop.lower_tip_y_m=14",), "stop.lower_tip_y_m = 14 ends the run before it starts: the lower tip is at y = 14 m"),
        (("domain.bottom=symmetry", "fracture.path_m=[[24, 0], [24, 5]]"), "stop.lower_tip_y_m = 11 is never reached: the fracture begins on the symmetry line"),
        (("fracture.growth=none",), "stop.lower_tip_y_m = 11 is never reached: the fracture does not grow"),
        (("fluid.inlet.rate_Pa_s=0",), "the run could never end"),
    ],
)
def test_what_is_refused(tmp_path: Path, settings: tuple[str, ...], said: str) -> None:
    (tmp_path / "scene.toml").write_text(GROWS, encoding="utf-8")
    done = strata(tmp_path, "resolve", "scene.toml", *(word for one in (*RISES, *settings) for word in ("--set", one)))
    assert done.returncode == 2 and said in done.stderr


def test_fine_cells_reach_to_the_lower_stop(tmp_path: Path) -> None:
    """Fluid with a weight drives the lower tip down first, further than the 2 m that stop.tip_y_m leaves the upper one: no coarse cells hold it."""
    settings = ("fluid.inlet={start_Pa=20.05e6, rate_Pa_s=1e5}", "numerics.far_cell_m=2", "stop.tip_y_m=36", "stop.lower_tip_y_m=4")
    assert run_in(tmp_path, GROWS, *settings).returncode == 0
    assert summary_of(tmp_path / "X")["reason"] == "lower tip reached y = 4 m"


def test_a_run_tells_its_two_tips_apart(tmp_path: Path) -> None:
    """Last lines and the reason name the tip; a level fracture has a left and a right one, whichever end of its path comes first. Mutation that fails:
    the name left out, or taken from the other tip."""
    (tmp_path / "scene.toml").write_text(GROWS, encoding="utf-8")
    settings = [word for one in (*RISES, "stop.tip_y_m=36", "stop.lower_tip_y_m=9") for word in ("--set", one)]
    done = strata(tmp_path, "run", "scene.toml", *settings, "--out", "X")
    assert done.returncode == 0 and ": upper tip reached y = 36 m" in done.stderr and "growth: " in done.stderr
    assert "upper tip start 20.1" in done.stderr and "MPa at y = 34.00 m" in done.stderr and "lower tip start 20.1" in done.stderr
    assert "tips: " in done.stderr and "lower tip x = 24.00 m, y = " in done.stderr
    level = ("in_situ.vertical_Pa=20e6", "stop.time_s=0", "fluid.inlet.rate_Pa_s=0")
    for name, path in (("a", "[[14, 24], [34, 24]]"), ("b", "[[34, 24], [14, 24]]")):
        (tmp_path / name).mkdir()
        assert run_in(tmp_path / name, SCENE.read_text(encoding="utf-8"), WEIGHTLESS, *level, f"fracture.path_m={path}").returncode == 0
        assert {(tip["tip"], round(tip["x_m"])) for tip in summary_of(tmp_path / name / "X")["tips"]} == {("left", 14), ("right", 34)}
