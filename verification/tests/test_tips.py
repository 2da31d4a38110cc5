"""Tips under the fluid's weight: K under a linear pressure, growth in a stress that falls as the fluid's pressure does, and which end goes first; the lower of
two tips in history.csv and as a stop; and what is told of a tip: numbers where there are numbers, null with the reason where there are none."""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.harness.load import Run, read_history
from verification.harness.paths import ANALYTIC
from verification.tests.cases import completed, run_in, strata, summary_of

SCENE = ANALYTIC / "heavy_fluid.toml"
WEIGHTLESS = ("fluid.density_kg_m3=0",)
rho_g, half, net = 9806.65, 10.0, 0.3e6  # N/m^3, m, Pa


def K_of_ends(variant: str, settings: tuple[str, ...] = ()) -> tuple[float, float]:
    """K_I of the lower and the upper tip, Pa sqrt(m)."""
    lower, upper = sorted(completed(SCENE, variant, settings).summary.tips, key=lambda tip: tip.y_m)
    return lower.K_I_Pa_sqrt_m, upper.K_I_Pa_sqrt_m


def test_K_under_the_weight_of_resting_fluid() -> None:
    """sqrt(pi a) (p +- rho g a/2), the sum at the lower tip: 1.9563 and 1.4067 MPa sqrt(m). Their mean to 0.2 %, their difference, all of it the weight's,
    to 1 %, in the summary and in the history, where K_II is none of it and J K^2/E'; the volume is the weightless one's."""
    lower, upper = K_of_ends("")
    scale = math.sqrt(math.pi * half)
    assert (scale * (net + 0.5 * rho_g * half), scale * (net - 0.5 * rho_g * half)) == pytest.approx((1.9563e6, 1.4067e6), rel=1e-4)
    assert 0.5 * (lower + upper) == pytest.approx(scale * net, rel=2e-3)
    assert lower - upper == pytest.approx(scale * rho_g * half, rel=1e-2)
    row = {name: values[-1] for name, values in completed(SCENE).history.items()}
    assert (row["lower_tip_K_I_Pa_sqrt_m"], row["K_I_Pa_sqrt_m"]) == pytest.approx((lower, upper), rel=1e-6)
    assert abs(row["lower_tip_K_II_Pa_sqrt_m"]) < 1e-6 * upper
    assert row["lower_tip_J_N_m"] == pytest.approx(lower**2 / (10e9 / 0.96), rel=2e-2)  # J of the upper tip is half as large
    assert (row["tip_y_m"], row["lower_tip_y_m"]) == pytest.approx((34.0, 14.0), abs=1e-9)
    assert (row["lower_tip_x_m"], row["lower_tip_near"]) == (pytest.approx(row["tip_x_m"]), 0.0)
    heavy, light = completed(SCENE).summary, completed(SCENE, "", WEIGHTLESS).summary
    assert heavy.fracture_volume_m2 == pytest.approx(light.fracture_volume_m2, rel=1e-9)
    # Clapeyron: half of int p w ds, of which the odd part of p adds to the energy: pi a^4 (rho g)^2/(8 E') for both faces' ends.
    E_prime = 10e9 / 0.96
    odd = math.pi * half**4 * rho_g**2 / (8.0 * E_prime)
    assert heavy.energy["strain_J"] - light.energy["strain_J"] == pytest.approx(odd, rel=3e-2)


def test_stress_that_falls_as_the_fluids_pressure_does_takes_the_weight_away() -> None:
    lower, upper = K_of_ends("balanced")
    light = K_of_ends("", WEIGHTLESS)
    assert lower == pytest.approx(upper, rel=1e-9) and lower == pytest.approx(light[0], rel=1e-9)


def starts(variant: str, settings: tuple[str, ...] = ()) -> tuple[float, float]:
    """When the lower and the upper tip of a fracture fed at its middle begin to grow, s; no fluid may be missing."""
    summary = completed(SCENE, variant, settings).summary
    assert abs(summary.monitors["volume_balance"]) < 1e-8
    lower, upper = sorted((event for event in summary.events if event.kind == "start"), key=lambda event: event.tip_y_m)
    return lower.time_s, upper.time_s


def test_a_fed_fracture_grows_as_without_weight_in_such_a_stress() -> None:
    """Both ends start together, to 0.2 % when those under a weightless fluid do. In even stress the weight brings the lower one first: K of
    the two is 7 % more and less than their mean, but it rises fast once the fluid's front is there. The upper one follows the growth of the lower."""
    light, heavy, sinks = starts("fed", WEIGHTLESS), starts("fed_balanced"), starts("fed")
    assert heavy[0] == pytest.approx(heavy[1], rel=1e-3) and heavy[0] == pytest.approx(light[0], rel=2e-3)
    assert sinks[0] < 0.99 * light[0] and sinks[1] > 1.005 * sinks[0]


def test_with_inertia_it_comes_to_rest_at_the_same_K() -> None:
    moved, still = K_of_ends("moving"), K_of_ends("resting")
    assert moved == pytest.approx(still, rel=1e-2) and moved[0] > 1.2 * moved[1]


GROWS = SCENE.read_text(encoding="utf-8").replace('growth = "none"', 'growth = "J"').replace("time_s = 0\n", "lower_tip_y_m = 11\n")
RISES = (*WEIGHTLESS, "fluid.inlet={start_Pa=20.1e6, rate_Pa_s=1e5}", "numerics.far_cell_m=2")


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
    sheared = completed(SCENE, "", (*WEIGHTLESS, "in_situ.shear_Pa=1e5")).history
    assert sheared["lower_tip_K_II_Pa_sqrt_m"] == pytest.approx(sheared["K_II_Pa_sqrt_m"], rel=1e-9)
    assert abs(sheared["K_II_Pa_sqrt_m"][-1]) == pytest.approx(1e5 * math.sqrt(math.pi * 10.0), rel=5e-3)


@pytest.mark.parametrize(("settings", "said"), [
    (("stop.lower_tip_y_m=14",), "stop.lower_tip_y_m = 14 ends the run before it starts: the lower tip is at y = 14 m"),
    (("domain.bottom=symmetry", "fracture.path_m=[[24, 0], [24, 5]]"), "stop.lower_tip_y_m = 11 is never reached: the fracture begins on the symmetry line"),
    (("fracture.growth=none",), "stop.lower_tip_y_m = 11 is never reached: the fracture does not grow"), (("fluid.inlet.rate_Pa_s=0",), "the run could never end"),
])  # fmt: skip
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
        assert run_in(tmp_path / name, SCENE.read_text(encoding="utf-8"), *WEIGHTLESS, *level, f"fracture.path_m={path}").returncode == 0
        assert {(tip["tip"], round(tip["x_m"])) for tip in summary_of(tmp_path / name / "X")["tips"]} == {("left", 14), ("right", 34)}


THREE_LAYERS = ANALYTIC / "three_layers.toml"
SHALE_E_PRIME_PA = 10.0e9 / 0.96


@pytest.mark.parametrize("cell_m", [1.0, 0.5])
def test_no_row_has_a_number_that_no_tip_has(cell_m: float) -> None:
    """Of a straight path in like rocks: K_I >= 0, J >= 0 and within 35 N/m of K_I^2/E' (a sixth of J_c), no kink beyond round-off. A tip without K_I
    has J = 0 and no kink; J and K are absent where the interface is near and only there."""
    history = completed(THREE_LAYERS, "", (f"numerics.cell_m={cell_m}",)).history
    K, J, kink = history["K_I_Pa_sqrt_m"], history["J_N_m"], history["kink_deg"]
    known = np.isfinite(K)
    assert known.sum() > 20 and (K[known] > 1e6).any() and (K[known] == 0.0).any()
    assert (K[known] >= 0.0).all() and (J[np.isfinite(J)] >= 0.0).all()
    assert (np.abs(kink[np.isfinite(kink)]) < 1e-6).all()
    closed = K == 0.0
    assert (J[closed] == 0.0).all() and np.isnan(kink[closed]).all()
    told = np.isfinite(J) & ~closed
    off = np.abs(J[told] - K[told] ** 2 / SHALE_E_PRIME_PA)
    assert (off < 35.0).all()
    assert (history["near"][~known] == 1).all() and set(history["near"]) <= {0.0, 1.0}
    assert (history["at_interface"] == history["near"]).all()


def tip(run: Run) -> dict:
    """The leading tip as summary.json has it."""
    return max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])


def test_J_beside_faces_that_are_apart_is_null_and_why() -> None:
    """2 m below a weak interface that has failed: K alone at 2 cells, J too at 4 and 8, K alike to 1 %."""
    coarse = tip(completed(THREE_LAYERS, "below_frail"))
    assert coarse["J_N_m"] is None and coarse["J_spread"] is None and coarse["kink_deg"] == pytest.approx(0.0, abs=1e-6)
    assert "interface" in coarse["reason"] and coarse["near"] == "interface" and coarse["at_interface"] is True
    fine, finer = (tip(completed(THREE_LAYERS, "below_frail", (f"numerics.cell_m={cell}",))) for cell in (0.5, 0.25))
    for known in (fine, finer):
        assert known["reason"] == known["near"] == "" and known["at_interface"] is False
        assert math.isfinite(known["J_N_m"]) and known["kink_deg"] == pytest.approx(0.0, abs=1e-6)
    assert [one["K_I_Pa_sqrt_m"] for one in (coarse, fine)] == pytest.approx([finer["K_I_Pa_sqrt_m"]] * 2, rel=0.01)


def test_a_bond_between_like_rocks_is_no_obstacle() -> None:
    """Strong enough to hold: K_I 2 cells below it is that of the rock without it, to 1 %, and unmarked."""
    strong = ("interface.frail.shear_strength_Pa=1e9", "interface.frail.tensile_strength_Pa=1e9", "interface.rough.coefficient=1e3")
    bonded = tip(completed(THREE_LAYERS, "below_frail", strong))
    alone = tip(completed(THREE_LAYERS, "below_frail", ("strata.interfaces=[\"perfect\",\"perfect\"]",)))
    assert bonded["reason"] == bonded["near"] == "" and bonded["at_interface"] is False
    assert bonded["K_I_Pa_sqrt_m"] == pytest.approx(alone["K_I_Pa_sqrt_m"], rel=0.01)
