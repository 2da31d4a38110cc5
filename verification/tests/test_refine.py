"""The refinement study: what is followed of a run, what is said where sizes lack it, what it would cost; one real study; orders, limits and their
uncertainty of made-up sequences, and what is said where there is no order."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from verification.harness import refine
from verification.harness.load import Event, Run, load
from verification.harness.paths import EXPERIMENTS
from verification.harness.quantities import Pause, Quantity, noise_of, pause_at, path_gap, pauses, quantities_of
from verification.harness.refine import Level, job_of, main, row_of, study_of
from verification.harness.richardson import estimate, estimate_of_changes, observed_order, told
from verification.harness.run import Outcome, about_s
from verification.harness.scenes import scene_of
from verification.tests.fake_run import Step, changed, climb, write_run

EXP1 = EXPERIMENTS / "exp1_single_interface.toml"
CONTENT: dict[str, Any] = {
    "domain": {"width_m": 80, "height_m": 80}, "strata": {"along": "y", "interfaces": ["weak"]},
    "fracture": {"path_m": [[40, 0], [40, 5]], "increment_m": 1.0}, "numerics": {"cell_m": 1.0}, "stop": {"tip_y_m": 70, "inlet_Pa": 4.0e6},
}  # fmt: skip


def level(cell_m: float, run: Run | None, status: int = 0) -> Level:
    return Level(cell_m, Outcome("exp", "weak", "completed" if status == 0 else "failed", status, "" if status == 0 else "why", 1.0, "k"), run)


def made(folder: Path, steps: list[Step], end_Pa: float = 3.0e6) -> Run:
    return load(write_run(folder, steps, end_Pa=end_Pa))


def held(folder: Path, plateau_Pa: float = 0.2e6, **over: float) -> Run:
    """A run that climbs with a plateau at the interface, 10 m up."""
    return made(folder, climb(plateaus={10.0: plateau_Pa}, **over))


def names_of(content: dict[str, Any], *heights_m: float) -> list[str]:
    return [one.name for one in quantities_of(content, heights_m)]


def quantity(name: str) -> Quantity:
    return next(one for one in quantities_of(CONTENT) if one.name == name)


def test_a_pause_is_the_rise_between_two_growth_events(tmp_path: Path) -> None:
    found = pauses(made(tmp_path / "r", [(2.40e6, 40.0, 6.0), (2.41e6, 40.0, 7.0), (2.60e6, 40.0, 8.0)]))
    assert found == [Pause(6.0, 2.40e6, 2.41e6), Pause(7.0, 2.41e6, 2.60e6), Pause(8.0, 2.60e6, math.inf)]
    assert found[1].rise_Pa == pytest.approx(0.19e6)


def test_the_longest_pause_at_an_interface_is_its_arrest(tmp_path: Path) -> None:
    run = made(tmp_path / "r", climb(plateaus={6.0: 0.5e6, 10.0: 0.1e6, 11.0: 0.2e6, 30.0: 0.5e6}), 4.5e6)
    found = pause_at(run, 1)
    assert isinstance(found, Pause) and found.height_m == 11.0 and found.rise_Pa == pytest.approx(0.205e6)
    measured = quantity("restart_1_Pa").measure(run)
    assert measured.exact and measured.low == pytest.approx(found.to_Pa) and measured.flags == ()


def test_a_pause_of_less_than_an_arrest_is_flagged_and_an_open_one_is_a_bound(tmp_path: Path) -> None:
    short, stuck = quantity("arrest_1_m").measure(held(tmp_path / "short", 0.04e6)), made(tmp_path / "stuck", climb(to_m=10.0))
    assert short.low == 10.0 and short.flags == ("no arrest",)
    restart, rise = quantity("restart_1_Pa").measure(stuck), quantity("plateau_1_Pa").measure(stuck)
    assert (restart.low, restart.high) == (3.0e6, math.inf) and "does not grow on" in restart.note
    assert rise.low == pytest.approx(3.0e6 - 2.38e6) and not rise.exact
    assert "does not reach the interface" in quantity("arrest_1_m").measure(made(tmp_path / "low", climb(to_m=7.0))).note


def test_a_scene_has_the_quantities_that_it_can_have() -> None:
    every = ["start_Pa", "arrest_1_m", "restart_1_Pa", "plateau_1_Pa", "pressure_at_20_Pa", "final_height_m", "final_Pa"]
    assert names_of(CONTENT, 4.0, 20.0, 75.0) == every
    turning = {**CONTENT, "strata": {"along": "x", "interfaces": ["weak"]}, "fracture": {**CONTENT["fracture"], "direction": "max_hoop"}}
    assert {"deflection_m", "final_angle_deg"} < set(names_of(turning)) and not any(name.startswith("arrest") for name in names_of(turning))
    second = names_of({**CONTENT, "strata": {"interfaces": ["perfect", "soft"]}})
    assert "arrest_2_m" in second and "arrest_1_m" not in second


TWO_TIPS: dict[str, Any] = {
    "domain": {"width_m": 40, "height_m": 40, "bottom": "traction"},
    "strata": {"layers": [{"thickness_m": 8}, {"thickness_m": 20}, {}], "interfaces": ["weak", "weak"]},
    "fracture": {"path_m": [[20, 14], [20, 22]], "increment_m": 1.0}, "numerics": {"cell_m": 0.5}, "stop": {"lower_tip_y_m": 4},
}  # fmt: skip


def two_tips(folder: Path, down: list[tuple[float, float]]) -> Run:
    """A run whose upper tip makes a step at 2.5 MPa and whose lower tip comes down to heights (m) at pressures (Pa) of their own."""
    layers = '[{rock = "a", thickness_m = 8.0}, {rock = "a", thickness_m = 20.0}, {rock = "a"}]'
    run = load(write_run(folder, [(2.5e6, 20.0, 23.0), *[(P, 20.0, 23.0) for P, _ in down]], end_Pa=3.0e6, layers=layers))
    rows = len(run.history["tip_y_m"])
    lower = np.full(rows, 14.0)
    for pressure, y in down:
        lower[run.history["inlet_Pa"] >= pressure] = y
    history = run.history | {"lower_tip_x_m": np.full(rows, 20.0), "lower_tip_y_m": lower}
    starts = tuple(Event("start", 0.0, P, 20.0, y, False, "J", tip) for P, y, tip in ((2.5e6, 22.0, "upper"), (down[0][0], 14.0, "lower")))
    return replace(run, history=history, summary=replace(run.summary, events=starts))


def test_the_lower_of_two_tips_is_followed_downwards(tmp_path: Path) -> None:
    """Its own start, its pause at the interface below, heights below its first place: none of them the upper tip's. Mutations that fail: the upper
    tip's columns; growth upwards; the interface above given to it."""
    down = [(2.52e6, 12.0), (2.55e6, 9.0), (2.56e6, 8.0), (2.80e6, 5.0)]
    found = {one.name: one.measure(two_tips(tmp_path / "r", down)) for one in quantities_of(TWO_TIPS, (5.0, 10.0, 16.0, 23.0, 2.0))}
    assert {name: one.low for name, one in found.items() if one.exact} == pytest.approx({
        "start_Pa": 2.5e6, "start_upper_Pa": 2.5e6, "start_lower_Pa": 2.52e6, "arrest_1_lower_m": 8.0, "restart_1_lower_Pa": 2.80e6,
        "plateau_1_lower_Pa": 0.24e6, "pressure_at_23_Pa": 2.5e6, "pressure_at_5_lower_Pa": 2.80e6, "pressure_at_10_lower_Pa": 2.55e6,
        "final_height_m": 23.0, "final_height_lower_m": 5.0, "final_Pa": 3.0e6,
    })  # fmt: skip
    assert [name for name, one in found.items() if not one.exact] == ["arrest_2_m", "restart_2_Pa", "plateau_2_Pa"]
    assert refine.unlike(TWO_TIPS, (4.0, 2.0))[0] == "at 4 m the first tip (y = 22 m) lies at mid-cell, at 2 m on a grid line"
    assert "at 4 m the lower tip (y = 14 m) lies at mid-cell, at 2 m on a grid line" in refine.unlike(TWO_TIPS, (4.0, 2.0))


def test_a_level_fracture_has_a_left_and_a_right_tip() -> None:
    names = [one.name for one in quantities_of({**TWO_TIPS, "fracture": {"path_m": [[14, 20], [26, 20]]}}, ())]
    assert names[:3] == ["start_Pa", "start_left_Pa", "start_right_Pa"]


@pytest.mark.parametrize(("in_situ", "layers", "closing_Pa"), [
    ({"horizontal_Pa": 2.2e6}, [{}, {}], 2.2e6), ({}, [{"horizontal_Pa": 2.1e6}, {"horizontal_Pa": 1.9e6}], 1.9e6),
    ({"horizontal_Pa": 2.2e6}, [{"horizontal_Pa": 1.8e6}, {}], 1.8e6), ({"horizontal_Pa": "2e6 + 1e3*Y"}, [{}], 2.0e6),
])  # fmt: skip
def test_what_a_pressure_resolves_goes_by_the_stress_of_the_layers(tmp_path: Path, in_situ: dict[str, Any], layers: list[Any], closing_Pa: float) -> None:
    """1e-4 of the pressure above the least stress, above the first inlet pressure (2 MPa) where the stress is a formula, which ended the study."""
    run = held(tmp_path / "r")
    run = replace(run, scene=run.scene | {"in_situ": in_situ, "strata": {"layers": layers}}, summary=replace(run.summary, mechanics="quasistatic"))
    assert noise_of(quantity("start_Pa"), run, 2.5e6) == pytest.approx(1e-4 * (2.5e6 - closing_Pa))


def test_a_path_begins_at_the_end_that_does_not_lead(tmp_path: Path) -> None:
    """Whichever end of path_m comes first; it folded back where that was the leading one."""
    run = made(tmp_path / "r", [(2.40e6, 40.0, 6.0), (2.41e6, 40.0, 7.0)])
    turned = replace(run, scene=run.scene | {"fracture": run.scene["fracture"] | {"path_m": [[40.0, 5.0], [40.0, 0.0]]}})
    assert turned.path.tolist() == run.path.tolist() == [[40.0, y] for y in (0.0, 5.0, 6.0, 7.0)]


def test_paths_are_compared_from_their_first_points_over_what_both_have(tmp_path: Path) -> None:
    straight = made(tmp_path / "a", [(2.4e6, 40.0, 6.0), (2.5e6, 40.0, 9.0)])
    aside = made(tmp_path / "b", [(2.4e6, 41.0, 6.0), (2.5e6, 41.0, 9.0), (2.6e6, 49.0, 15.0)])
    rms, far = path_gap(aside, straight, 8.0) or (0.0, 0.0)
    assert 0.3 < rms < far == pytest.approx(1.0, abs=0.2)
    assert path_gap(straight, straight) == (0.0, 0.0) and path_gap(made(tmp_path / "c", []), straight) is None


def test_sizes_without_a_value_are_named_and_left_out_of_the_order(tmp_path: Path) -> None:
    levels = [level(h, held(tmp_path / f"{h}", start_Pa=2.4e6 + 4.0e4 * h)) for h in (1.0, 0.5, 0.25)]
    row = row_of(quantity("start_Pa"), [level(2.0, None, 2), *levels, level(0.125, None, 3)])
    assert row.values == (None, pytest.approx(2.44e6), pytest.approx(2.42e6), pytest.approx(2.41e6), None)
    assert row.notes == ("2 m: refused", "0.125 m: failed")
    assert row.estimate.kind == "clean" and row.estimate.extrapolate == pytest.approx(2.40e6)


def test_a_height_that_is_not_reached_is_a_bound_and_no_value(tmp_path: Path) -> None:
    row = row_of(quantity("pressure_at_40_Pa"), [level(2.0, held(tmp_path / "a")), level(1.0, made(tmp_path / "b", climb(to_m=30.0), 2.9e6))])
    assert row.values[1] is None and row.notes == ("1 m: does not reach 40 m, at least 2.9e+06 Pa",) and row.estimate.kind == "too few"


def test_a_size_whose_run_is_marked_is_told(tmp_path: Path) -> None:
    """In the table and in the file, by size and monitor; not those of sound runs."""
    mark = {"monitor": "held_tip", "value": 2.0, "threshold": 1.1, "why": "held"}
    runs = [held(tmp_path / "coarse"), held(tmp_path / "fine")]
    levels = [level(1.0, load(changed(runs[0].folder, suspect=[mark]))), level(0.5, runs[1])]
    study = study_of(EXP1, "quasistatic", "weak", levels)
    assert [line for line in refine.table(study).splitlines() if "suspect" in line] == ["  1 m is suspect: held_tip"]
    assert [one["suspect"] for one in refine.as_json(EXP1, (), [study])["studies"][0]["levels"]] == [["held_tip"], []]


def test_arrests_that_no_size_has_are_left_out_and_some_are_told(tmp_path: Path) -> None:
    none = [level(h, held(tmp_path / f"n{h}", 0.01e6)) for h in (1.0, 0.5)]
    assert "arrest_1_m" not in {row.name for row in study_of(EXP1, "quasistatic", "weak", none).rows}
    some = study_of(EXP1, "quasistatic", "weak", [none[0], level(0.5, held(tmp_path / "some"))])
    assert next(row for row in some.rows if row.name == "arrest_1_m").notes == ("1 m: no arrest",)


def test_what_no_size_has_is_told_in_a_note(tmp_path: Path) -> None:
    study = study_of(EXP1, "quasistatic", "weak", [level(h, made(tmp_path / f"{h}", climb(to_m=30.0), 2.9e6)) for h in (1.0, 0.5)])
    names = {row.name for row in study.rows}
    assert "pressure_at_40_Pa" not in names and "pressure_at_20_Pa" in names
    assert study.notes == ("weak: nothing to follow at any size: pressure at 40 m, pressure at 60 m",)


@pytest.mark.parametrize(("along", "first_m", "cells_m", "said"), [
    ("y", 10, (1.0, 0.5, 0.25), ()), ("y", 10, (2.0, 1.0), ("at 2 m the first tip (y = 5 m) lies at mid-cell, at 1 m on a grid line",)),
    ("x", 42.5, (1.0, 0.5), ("at 1 m the interface (x = 42.5 m) lies at mid-cell, at 0.5 m on a grid line",)),
])  # fmt: skip
def test_sizes_at_which_tip_or_interface_lie_otherwise_are_named(along: str, first_m: float, cells_m: tuple[float, ...], said: tuple[str, ...]) -> None:
    strata = {"along": along, "layers": [{"rock": "a", "thickness_m": first_m}, {"rock": "b"}]}
    assert refine.unlike({**CONTENT, "strata": strata}, cells_m) == said


def test_the_increment_stays_as_the_cells_shrink() -> None:
    for variant, increment in (("weak", 1.0), ("half_increment_weak", 0.5)):
        settings = [job_of(EXP1, "quasistatic", variant, cell).settings for cell in (2.0, 0.25)]
        assert all(f"fracture.increment_m={increment!r}" in one for one in settings) and "numerics.cell_m=0.25" in settings[1]
    assert "fracture.increment_m=3.0" in job_of(EXP1, "explicit", "weak", 1.0, ("fracture.increment_m=3.0",)).settings


@pytest.mark.parametrize("mechanics, ratio", [("explicit", 64.0), ("quasistatic", 16.0)])
def test_an_estimate_goes_by_points_and_with_inertia_by_steps(mechanics: str, ratio: float) -> None:
    coarse, fine = ({**CONTENT, "numerics": {"cell_m": cell, "mechanics": mechanics, "particles_per_cell": 4}} for cell in (1.0, 0.25))
    assert about_s(fine) / about_s(coarse) == pytest.approx(ratio)


def test_what_costs_too_much_is_not_run_without_yes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["exp1", "--mechanics", "explicit", "--cells", "0.25", "--variants", "weak", "--out", str(tmp_path)]) == 2
    said = capsys.readouterr()
    assert "1 of 1 runs to make" in said.out and "above the limit of 30 min" in said.err and not list(tmp_path.iterdir())


def test_an_experiment_is_named_by_its_beginning_or_its_file() -> None:
    assert scene_of("exp1") == EXP1 == scene_of(str(EXP1))


def test_a_study_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Experiment 5 with its interface at 42.5 m: 2.5 m cells carry it, 4 m cells do not and are named, the study goes on."""
    settings = [word for one in ("stop.tip_y_m=9", "fracture.increment_m=2.0", "fluid.law=uniform") for word in ("--set", one)]
    arguments = ["exp5", "--variants", "near", "--cells", "5,4,2.5", *settings, "--heights", "8", "--out", str(tmp_path)]
    assert main(arguments) == 3
    assert "42.5 m, neither on a grid line nor at mid-cell of cells of 4 m" in capsys.readouterr().out
    study = json.loads((tmp_path / "exp5_parallel_interface" / "refine.json").read_text())["studies"][0]
    assert [one["status"] for one in study["levels"]] == ["completed", "refused", "completed"] and study["increment_m"] == 2.0
    row = next(row for row in study["rows"] if row["name"] == "start_Pa")
    start = row["values"]
    assert start[1] is None and 2.0e6 < start[2] < start[0] < 5.0e6 and row["estimate"]["kind"] == "too few"
    assert main(arguments) == 3
    assert capsys.readouterr().out.count("done before") == 2


HALVES, THREE = (2.0, 1.0, 0.5, 0.25), (1.0, 0.5, 0.25)


def law(sizes: tuple[float, ...], limit: float, factor: float, order: float) -> list[float]:
    """f + C h^p."""
    return [limit + factor * h**order for h in sizes]


@pytest.mark.parametrize("order", [0.5, 0.73, 1.0, 1.5, 2.0, 3.0, -0.3, -1.0])
@pytest.mark.parametrize("sizes", [(1.0, 0.5, 0.25), (2.0, 1.0, 0.5), (1.0, 0.7, 0.2), (3.0, 2.9, 0.1)])
def test_the_order_of_a_power_is_its_exponent_for_any_sizes(order: float, sizes: tuple[float, float, float]) -> None:
    assert observed_order(sizes, law(sizes, 2.4e6, -3.0e4, order)) == pytest.approx(order, abs=1e-7)
    assert observed_order(sizes, [math.log(h) for h in sizes]) == pytest.approx(0.0, abs=1e-9), "an order of zero is a logarithm"


@pytest.mark.parametrize("order", [0.55, 1.0, 2.0, 2.9])
def test_the_limit_of_a_clean_order_is_found_and_its_uncertainty_is_the_index(order: float) -> None:
    values = law(HALVES, 2.4e6, 5.0e4, order)
    found = estimate(HALVES, values, unit="Pa")
    assert found.kind == "clean" and found.order == pytest.approx(order, abs=1e-7) and found.extrapolate == pytest.approx(2.4e6, abs=1.0)
    assert found.uncertainty == pytest.approx(1.25 * (values[-1] - 2.4e6), rel=1e-5)
    assert [item.order for item in found.triples] == pytest.approx([order, order], abs=1e-6)


@pytest.mark.parametrize(("values", "expected"), [((8.0, 4.0, 2.0), (1.0, 0.0, 2.5)), ((17.0, 5.0, 2.0), (2.0, 1.0, 1.25))])
def test_hand_numbers(values: tuple[float, ...], expected: tuple[float, ...]) -> None:
    """Celik et al. 2008 ask for GCI = 1.25 e/(r^p - 1)."""
    found = estimate((4.0, 2.0, 1.0), values)
    assert (found.order, found.extrapolate, found.uncertainty) == pytest.approx(expected, abs=1e-9)


def test_a_limit_lies_within_its_uncertainty_where_a_second_term_is_small() -> None:
    rng = np.random.default_rng(7)
    for _ in range(200):
        limit, first, order = rng.uniform(1.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(0.8, 2.0)
        second = 0.05 * first * rng.uniform(-1.0, 1.0)
        found = estimate(HALVES, [limit + first * h**order + second * h ** (order + 1.0) for h in HALVES])
        assert found.kind == "clean" and found.extrapolate is not None and found.uncertainty is not None
        assert abs(found.extrapolate - limit) <= found.uncertainty


@pytest.mark.parametrize(("values", "noise", "kind", "order", "says"), [
    ((1.0, 3.0, 2.0), 0.0, "oscillates", None, "oscillates: spread 2 m over the finest three, last change 1 m"),
    (law(THREE, 0.0, 1.0, -0.3), 0.0, "diverges", -0.3, "order -0.30: not converging"),
    (law(THREE, 1.0, 1.0, 0.3), 0.0, "odd order", 0.3, "order 0.30 is outside"), (law(THREE, 1.0, 1.0, 4.0), 0.0, "odd order", 4.0, "order 4.00 is outside"),
    ((2.0, 2.0 + 3e-5, 2.0 - 4e-5), 1e-4, "still", None, "the same"), ((11.0, 11.0, 11.0), 0.0, "still", None, "the same at the finest three sizes"),
    ((2.5, 2.0, 2.00004), 1e-4, "settled", None, "settled"), ((2.0, 2.00004, 2.5), 1e-4, "diverges", None, "not converging"),
    ((2.5, 2.0, 2.00004), 1e-6, "oscillates", None, "oscillates"),
])  # fmt: skip
def test_what_has_no_clean_order_has_no_limit(values: tuple[float, ...], noise: float, kind: str, order: float | None, says: str) -> None:
    found = estimate(THREE, values, noise, "m")
    assert (found.kind, found.extrapolate, found.uncertainty) == (kind, None, None) and found.says.startswith(says)
    assert found.order == (order if order is None else pytest.approx(order)) and found.spread == max(values) - min(values)


def test_a_coarse_size_that_does_not_fit_raises_the_factor_of_safety() -> None:
    fine = law(THREE, 2.0, 0.1, 1.0)
    alone, with_coarse = estimate(THREE, fine), estimate(HALVES, [0.0, *fine])
    assert with_coarse.extrapolate == pytest.approx(alone.extrapolate) and with_coarse.uncertainty == pytest.approx(3.0 / 1.25 * alone.uncertainty)
    assert "factor of safety is 3" in with_coarse.says and "oscillates with 2 m" in with_coarse.says


def test_changes_give_the_order_of_a_path() -> None:
    """Distances 4, 2, 1 between successive sizes: order 1; the finest is still 1 (with the factor 1.25) from the limit."""
    found = estimate_of_changes(HALVES, (4.0, 2.0, 1.0))
    assert found.kind == "clean" and found.extrapolate is None and (found.order, found.uncertainty) == pytest.approx((1.0, 1.25), abs=1e-9)
    assert estimate_of_changes(HALVES, (1.0, 2.0, 3.0)).kind == "diverges"


def test_few_values_say_so_and_wrong_ones_are_refused() -> None:
    assert estimate((1.0, 0.5), (2.0, 1.5), unit="m").says == "two sizes only, 0.5 m apart"
    assert estimate((1.0,), (2.0,)).says == "one size only (1 m)" and estimate((), ()).kind == "too few"
    assert (told(5770.0, "Pa"), told(0.5, "m"), told(0.5, "")) == ("5.77 kPa", "0.5 m", "0.5")
    wrong = ((observed_order, (1.0, 1.0, 0.5), (1.0, 2.0, 3.0), "do not fall"), (estimate, THREE, (1.0, 2.0), "sizes and"),
             (estimate_of_changes, (1.0, 0.5), (1.0, 2.0), "changes"))  # fmt: skip
    for function, sizes, values, why in wrong:
        with pytest.raises(ValueError, match=why):
            function(sizes, values)
