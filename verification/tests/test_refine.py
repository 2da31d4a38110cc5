"""The refinement study: what is followed of a run, what is said where sizes lack it, what it would cost; and one real study.

Mutations that were run and fail here: the increment left to follow the cells, pauses counted from the first row, a bound taken
for a value, the cost without the particles of finer cells, the path compared over all its length.
"""

import json
import math
from pathlib import Path

import pytest

from verification.harness import refine
from verification.harness.load import Run, load
from verification.harness.paths import EXPERIMENTS
from verification.harness.plan import about_s
from verification.harness.quantities import Pause, pause_at, path_gap, pauses, quantities_of
from verification.harness.refine import Level, job_of, main, row_of, study_of
from verification.harness.run import Outcome
from verification.harness.scenes import scene_of
from verification.tests.fake_run import climb, write_run

EXP1 = EXPERIMENTS / "exp1_single_interface.toml"
CONTENT = {
    "domain": {"width_m": 80, "height_m": 80},
    "rock": {"stiff": {"youngs_modulus_Pa": 1e10, "poisson_ratio": 0.2, "density_kg_m3": 2500}},
    "strata": {"along": "y", "interfaces": ["weak"]},
    "fracture": {"path_m": [[40, 0], [40, 5]], "increment_m": 1.0},
    "fluid": {"inlet": {"start_Pa": 2.0e6, "rate_Pa_s": 0.35e6}},
    "numerics": {"cell_m": 1.0},
    "stop": {"tip_y_m": 70, "inlet_Pa": 4.0e6},
}


def level(cell_m: float, run: Run | None, status: int = 0) -> Level:
    """A level with a made-up outcome."""
    return Level(cell_m, Outcome("exp", "weak", "completed" if status == 0 else "failed", status, "" if status == 0 else "why", 1.0, "k"), run)


def made(folder: Path, plateau_Pa: float = 0.2e6, **over: float) -> Run:
    """A run that climbs with a plateau at the interface, 10 m up."""
    return load(write_run(folder, climb(plateaus={10.0: plateau_Pa}, **over)))


def quantity(name: str, **over: object) -> refine.Quantity:
    """One of the quantities of the made-up scene."""
    return next(one for one in quantities_of({**CONTENT, **over}) if one.name == name)


# --- what is followed


def test_a_pause_is_the_rise_between_two_growth_events(tmp_path: Path) -> None:
    steps = [(2.40e6, 40.0, 6.0), (2.41e6, 40.0, 7.0), (2.60e6, 40.0, 8.0)]
    found = pauses(load(write_run(tmp_path / "r", steps, end_Pa=3.0e6)))
    assert found == [Pause(6.0, 2.40e6, 2.41e6), Pause(7.0, 2.41e6, 2.60e6), Pause(8.0, 2.60e6, math.inf)]
    assert found[1].rise_Pa == pytest.approx(0.19e6)


def test_the_longest_pause_at_an_interface_is_its_arrest(tmp_path: Path) -> None:
    run = load(write_run(tmp_path / "r", climb(plateaus={6.0: 0.5e6, 10.0: 0.1e6, 11.0: 0.2e6, 30.0: 0.5e6}), end_Pa=4.5e6))
    found = pause_at(run, 1)
    assert isinstance(found, Pause) and found.height_m == 11.0 and found.rise_Pa == pytest.approx(0.205e6)
    measured = quantity("restart_1_Pa").measure(run)
    assert measured.exact and measured.low == pytest.approx(found.to_Pa) and measured.flags == ()


def test_a_pause_of_less_than_an_arrest_is_flagged_and_an_open_one_is_a_bound(tmp_path: Path) -> None:
    short = quantity("arrest_1_m").measure(made(tmp_path / "short", 0.04e6))
    assert short.low == 10.0 and short.flags == ("no arrest",)
    stuck = load(write_run(tmp_path / "stuck", climb(to_m=10.0), end_Pa=3.0e6))
    restart, rise = quantity("restart_1_Pa").measure(stuck), quantity("plateau_1_Pa").measure(stuck)
    assert (restart.low, restart.high) == (3.0e6, math.inf) and "does not grow on" in restart.note
    assert rise.low == pytest.approx(3.0e6 - 2.38e6) and not rise.exact
    low = load(write_run(tmp_path / "low", climb(to_m=7.0)))
    assert "does not reach the interface" in quantity("arrest_1_m").measure(low).note


def test_a_scene_has_the_quantities_that_it_can_have() -> None:
    names = [one.name for one in quantities_of(CONTENT, (4.0, 20.0, 75.0))]
    assert names == ["start_Pa", "arrest_1_m", "restart_1_Pa", "plateau_1_Pa", "pressure_at_20_Pa", "final_height_m", "final_Pa"]
    turning = {**CONTENT, "strata": {"along": "x", "interfaces": ["weak"]}, "fracture": {**CONTENT["fracture"], "direction": "max_hoop"}}
    assert {"deflection_m", "final_angle_deg"} < {one.name for one in quantities_of(turning)}
    assert not any(one.name.startswith("arrest") for one in quantities_of(turning))
    perfect = {**CONTENT, "strata": {"interfaces": ["perfect", "soft"]}}
    assert "arrest_2_m" in {one.name for one in quantities_of(perfect)} and "arrest_1_m" not in {one.name for one in quantities_of(perfect)}


def test_paths_are_compared_from_their_first_points_over_what_both_have(tmp_path: Path) -> None:
    straight = load(write_run(tmp_path / "a", [(2.4e6, 40.0, 6.0), (2.5e6, 40.0, 9.0)]))
    aside = load(write_run(tmp_path / "b", [(2.4e6, 41.0, 6.0), (2.5e6, 41.0, 9.0), (2.6e6, 49.0, 15.0)]))
    rms, far = path_gap(aside, straight, 8.0) or (0.0, 0.0)
    assert 0.3 < rms < far == pytest.approx(1.0, abs=0.2)
    assert path_gap(straight, straight) == (0.0, 0.0)
    assert path_gap(load(write_run(tmp_path / "c", [])), straight) is None


# --- what is said


def test_sizes_without_a_value_are_named_and_left_out_of_the_order(tmp_path: Path) -> None:
    runs = [made(tmp_path / f"{k}", start_Pa=2.4e6 + 4.0e4 * h) for k, h in enumerate((1.0, 0.5, 0.25))]
    levels = [level(2.0, None, 2), *(level(h, run) for h, run in zip((1.0, 0.5, 0.25), runs)), level(0.125, None, 3)]
    row = row_of(quantity("start_Pa"), levels)
    assert row.values == (None, pytest.approx(2.44e6), pytest.approx(2.42e6), pytest.approx(2.41e6), None)
    assert row.notes == ("2 m: refused", "0.125 m: failed")
    assert row.estimate.kind == "clean" and row.estimate.extrapolate == pytest.approx(2.40e6)


def test_a_height_that_is_not_reached_is_a_bound_and_no_value(tmp_path: Path) -> None:
    levels = [level(2.0, made(tmp_path / "a")), level(1.0, load(write_run(tmp_path / "b", climb(to_m=30.0), end_Pa=2.9e6)))]
    row = row_of(quantity("pressure_at_40_Pa"), levels)
    assert row.values[1] is None and row.notes == ("1 m: does not reach 40 m, at least 2.9e+06 Pa",)
    assert row.estimate.kind == "too few"


def test_arrests_that_no_size_has_are_left_out_and_some_are_told(tmp_path: Path) -> None:
    none = [level(h, made(tmp_path / f"n{h}", 0.01e6)) for h in (1.0, 0.5)]
    assert "arrest_1_m" not in {row.name for row in study_of(EXP1, "quasistatic", "weak", none).rows}
    some = [none[0], level(0.5, made(tmp_path / "some", 0.2e6))]
    row = next(row for row in study_of(EXP1, "quasistatic", "weak", some).rows if row.name == "arrest_1_m")
    assert row.notes == ("1 m: no arrest",)


def test_what_no_size_has_is_told_in_a_note(tmp_path: Path) -> None:
    low = [level(h, load(write_run(tmp_path / f"{h}", climb(to_m=30.0), end_Pa=2.9e6))) for h in (1.0, 0.5)]
    study = study_of(EXP1, "quasistatic", "weak", low)
    assert not any(row.name == "pressure_at_40_Pa" for row in study.rows)
    assert study.notes == ("weak: at no size is there a pressure at 40 m, pressure at 60 m",)
    assert any(row.name == "pressure_at_20_Pa" for row in study.rows)


def test_sizes_at_which_tip_or_interface_lie_otherwise_in_their_cells_are_named() -> None:
    content = {**CONTENT, "strata": {"layers": [{"rock": "a", "thickness_m": 10}, {"rock": "b"}]}}
    assert refine.unlike(content, (1.0, 0.5, 0.25)) == ()
    assert refine.unlike(content, (2.0, 1.0)) == ("at 2 m the first tip (y = 5 m) lies at mid-cell, at 1 m on a grid line",)
    sideways = {**CONTENT, "strata": {"along": "x", "layers": [{"rock": "a", "thickness_m": 42.5}, {"rock": "b"}]}}
    assert refine.unlike(sideways, (1.0, 0.5)) == ("at 1 m the interface (x = 42.5 m) lies at mid-cell, at 0.5 m on a grid line",)


# --- jobs, their cost and the command line


def test_the_increment_stays_as_the_cells_shrink() -> None:
    for variant, increment in (("weak", 1.0), ("half_increment_weak", 0.5)):
        settings = [job_of(EXP1, "quasistatic", variant, cell).settings for cell in (2.0, 0.25)]
        assert all(f"fracture.increment_m={increment!r}" in one for one in settings)
        assert "numerics.cell_m=0.25" in settings[1]
    assert "fracture.increment_m=3.0" in job_of(EXP1, "explicit", "weak", 1.0, ("fracture.increment_m=3.0",)).settings


@pytest.mark.parametrize("mechanics, ratio", [("explicit", 64.0), ("quasistatic", 16.0)])
def test_an_estimate_goes_by_points_and_with_inertia_by_steps(mechanics: str, ratio: float) -> None:
    coarse, fine = ({**CONTENT, "numerics": {"cell_m": cell, "mechanics": mechanics, "particles_per_cell": 4}} for cell in (1.0, 0.25))
    assert about_s(fine) / about_s(coarse) == pytest.approx(ratio)


def test_what_costs_too_much_is_not_run_without_yes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["exp1", "--mechanics", "explicit", "--cells", "0.25", "--variants", "weak", "--out", str(tmp_path)]
    assert main(arguments) == 2
    said = capsys.readouterr()
    assert "1 of 1 runs to make" in said.out and "above the limit of 30 min" in said.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments, message",
    [(["exp"], "several experiments"), (["exp9"], "no experiment begins"), (["no.toml"], "there is no file"),
     (["exp1", "--cells", "1,x"], "--cells 1,x"), (["exp1", "--cells", "1,-2"], "sizes are positive"),
     (["exp1", "--variants", "week"], "has no variant week"), (["exp1", "--variants", "undamped"], "runs in quasistatic")],
)  # fmt: skip
def test_bad_input_is_refused_by_name(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert ended.value.code == 2 and message in capsys.readouterr().err


def test_experiments_are_found_by_the_beginning_of_their_names() -> None:
    assert scene_of("exp1") == EXP1 == scene_of(str(EXP1))


def test_a_study_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Experiment 5 with its interface at 42.5 m: 2.5 m cells carry it, 4 m cells do not and are named, the study goes on."""
    arguments = ["exp5", "--variants", "near", "--cells", "5,4,2.5", "--set", "stop.tip_y_m=9", "--set", "fracture.increment_m=2.0",
                 "--set", "fluid.law=uniform", "--heights", "8", "--out", str(tmp_path)]  # fmt: skip
    assert main(arguments) == 3
    said = capsys.readouterr().out
    assert "42.5 m, neither on a grid line nor at mid-cell of cells of 4.0 m" in said
    study = json.loads((tmp_path / "exp5_parallel_interface" / "refine.json").read_text())["studies"][0]
    assert [one["status"] for one in study["levels"]] == ["completed", "refused", "completed"]
    rows = {row["name"]: row for row in study["rows"]}
    start = rows["start_Pa"]["values"]
    assert start[1] is None and 2.0e6 < start[2] < start[0] < 5.0e6
    assert rows["start_Pa"]["estimate"]["kind"] == "too few" and study["increment_m"] == 2.0
    assert main(arguments) == 3
    assert capsys.readouterr().out.count("done before") == 2
