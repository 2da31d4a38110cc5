"""What the figures show, checked by hand on small cases."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reports.claims import choice_rows, claim_rows, sensitivity
from reports.curves import catalogue, height_figure, largest_turn, path_figure, profile_figure, sampled, side_of
from reports.figures import make, suspect_words
from reports.outcome import comparisons, finding, inertia_words, outcome_of, outcomes_of, path_distance
from reports.page import base_of, closure_of, differences, suspicions
from reports.runs import layout_of, load_run, load_runs
from reports.tests.synthetic import STEMS, Plan, claims, write_both, write_run
from reports.words import number, quantity
from verification.harness.claims import NOT_REPRODUCED, Case, CaseResult, Choice, ClaimResult, Point


def test_sides_are_signs_about_the_extended_crack() -> None:
    """A vertical crack: left is -, right and on it +; behind means strictly below the tip."""
    x, y = np.array([39.0, 41.0, 40.0, 39.0, 41.0]), np.array([1.0, 1.0, 2.0, 9.0, 5.0])
    sign, behind = side_of(x, y, np.array([40.0, 40.0]), np.array([0.0, 5.0]))
    assert sign.tolist() == [-1, 1, 1, -1, 1]
    assert behind.tolist() == [True, True, True, False, False]


def test_the_largest_turn_of_a_path() -> None:
    """A right angle among gentle turns is found."""
    assert largest_turn(np.array([0.0, 0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0, 1.1])) == pytest.approx(90.0)
    assert largest_turn(np.array([0.0, 0.0]), np.array([0.0, 1.0])) == 0.0


def test_layout_places_interfaces_by_thickness(tmp_path: Path) -> None:
    """Two layers of 10 m put interfaces at 10 and 20 m; a parallel one lies at 45 m and crosses no height."""
    two = layout_of(load_run(write_run(tmp_path, 3, Plan("weak_soft", ("weak", "soft")))))
    assert two.heights_m == (10.0, 20.0) and [layer.to_m for layer in two.layers] == [10.0, 20.0, 80.0]
    beside = layout_of(load_run(write_run(tmp_path, 5, Plan("perfect"))))
    assert beside.heights_m == () and beside.interfaces[0].at_m == 45.0


def test_an_arrest_at_an_interface_by_J_is_flagged(tmp_path: Path) -> None:
    """A run that decides by J says so of an arrest at an interface, in any mechanics; with the energy criterion, or by its own word, it does not."""
    plan = Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)
    run = load_run(write_run(tmp_path, 1, plan))
    arrest = outcome_of(run).arrests[0]
    assert arrest.by_J and arrest.interface == "weak" and arrest.until_Pa == pytest.approx(3.2e6, abs=5e4)
    for event in run.summary["events"]:
        event["at_interface"] = False
    assert not outcome_of(run).arrests[0].by_J
    run = load_run(write_run(tmp_path, 1, replace(plan, by="energy")))
    assert not outcome_of(run).arrests[0].by_J
    assert outcome_of(load_run(write_run(tmp_path, 1, replace(plan, mechanics="quasistatic")))).arrests[0].by_J


def test_an_arrest_past_its_interface_says_how_far(tmp_path: Path) -> None:
    """The rings of a tip 4 m past an interface may still reach it: the sentence then says where it is."""
    run = load_run(write_run(tmp_path, 1, Plan("soft", ("soft",), stop_at_m=14.0, restart_Pa=3.0e6)))
    assert outcome_of(run).arrests[0].interface is None
    for event in run.summary["events"]:
        event["at_interface"] = event["kind"] == "arrest"
    arrest = outcome_of(run).arrests[0]
    assert arrest.interface == "soft" and arrest.beyond_m == pytest.approx(4.0, abs=1.1)
    assert "past the soft interface) from 2.47 to 3.0" in finding([outcome_of(run)])


def test_an_arrest_that_bonded_interfaces_show_too_is_a_pause(tmp_path: Path) -> None:
    """Stopping where and as long as the bonded twin does is not the interface's doing; stopping longer is."""
    for name, restart in (("perfect", 2.8e6), ("friction", 2.8e6), ("weak", 3.2e6)):
        write_run(tmp_path, 1, Plan(name, (name,), stop_at_m=10.0, restart_Pa=restart))
    runs = load_runs(tmp_path)
    assert [outcome_of(run, runs).arrests[0].interface for run in runs] == [None, None, "weak"]
    assert finding(outcomes_of(runs)).startswith("perfect and friction grew to 70\u00a0m")


def test_profiles_are_taken_at_common_times(tmp_path: Path) -> None:
    """All panels of the opening figure, those without inertia first, show nearly the same instants as far as their runs last."""
    for plan in (Plan("perfect"), Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)):
        write_both(tmp_path, 4, plan)
    panels = profile_figure(load_runs(tmp_path)).panels
    assert [panel.variant for panel in panels] == ["perfect", "weak"] * 2
    assert [panel.mechanics for panel in panels] == ["quasistatic"] * 2 + ["explicit"] * 2
    assert "without inertia" in panels[0].heading
    assert len(panels[1].profiles) > len(panels[0].profiles) >= 3
    assert panels[0].profiles[-1].height_m.max() == 70.0


def test_paths_say_towards_which_rock_they_go(tmp_path: Path) -> None:
    """Experiment 5 has its soft rock on the left: a drift to the left is towards it."""
    write_run(tmp_path, 5, Plan("perfect", drift_m=-0.4))
    panel = path_figure([load_runs(tmp_path)]).panels[0]
    assert "towards the soft rock by 0.4\u00a0m (perfect)" in panel.heading
    assert panel.magnified > 5.0 and panel.aside == "interface 5\u00a0m to the right of the start"


def test_stress_is_that_of_the_nearest_particle() -> None:
    """Rows are heights."""
    points = {"x_m": np.array([1.0, 3.0, 2.0]), "y_m": np.array([1.0, 1.0, 3.0])}
    edges = np.array([0.0, 2.0, 4.0])
    assert sampled(points, np.array([1.0, 2.0, 3.0]), edges, edges).tolist() == [[1.0, 2.0], [3.0, 3.0]]


def test_a_variant_is_told_by_what_differs(tmp_path: Path) -> None:
    """A variant is compared with the interface type it shares most settings with."""
    write_run(tmp_path, 1, Plan("perfect"))
    write_run(tmp_path, 1, Plan("weak", ("weak",)))
    write_run(tmp_path, 1, Plan("weak_uniform", ("weak",), extra='[fluid]\nlaw = "uniform"'))
    runs = load_runs(tmp_path)
    other = runs[-1]
    assert base_of(other, runs).variant == "weak"
    assert differences(other, runs) == "as weak but fluid.law unset → uniform"
    assert closure_of(other) == pytest.approx(0.005)


def test_verdicts_keep_bounds_and_open_cases() -> None:
    """A case that is only bounded says so; one that is open is neither right nor wrong."""
    asked = Case("start_Pa", "soft", at_most=3e6, parameters={"from_m": {"interface": 1, "plus_m": -2}, "interface": 1})
    result = CaseResult(**vars(asked), unit="Pa", value=4e6, low=4e6)
    claim = ClaimResult("2c", STEMS[2], "explicit", "t", "w", "start_Pa", NOT_REPRODUCED, None, (result,), (), ())
    row = claim_rows([claim])[0].cases[0]
    assert row.asked == "≤ 3\u00a0MPa" and row.what == "soft: start (from 2\u00a0m below interface 1, interface 1)"
    assert (row.found[0].holds, row.found[0].measured) == ("open", "at least 4\u00a0MPa")


def test_claims_of_both_mechanics_are_one_row() -> None:
    """One row a claim, its cases with what each mechanics found, in the same order."""
    rows = claim_rows(claims())
    assert [row.id for row in rows] == ["1b", "2c", "5a"]
    assert [(one.mechanics, one.kind) for one in rows[1].verdicts] == [("with inertia", "partly"), ("without inertia", "yes")]
    assert [found.holds for found in rows[1].cases[0].found] == ["no", "yes"]
    assert rows[2].readings[0].partial and rows[2].readings[0].holds == (("with inertia", "open"), ("without inertia", "open"))


def test_numbers_in_words() -> None:
    """Units come from keys; exact numbers lose their trailing zeros."""
    assert quantity("restart_inlet_Pa", 3.21e6) == "3.21\u00a0MPa"
    assert quantity("minimum_opening_m", 2e-4) == "2.00×10⁻⁴\u00a0m"
    assert number(0.0123456) == "0.0123" and number(2.0) == "2" and number(float("nan")) == "not finite"


# --- both mechanics
WEAK = Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)


def test_an_arrest_by_J_is_not_flagged_where_energy_finds_it_too(tmp_path: Path) -> None:
    """The quasi-static run of the same variant confirms an arrest at the same height, and no other."""
    write_both(tmp_path, 1, WEAK)
    runs = load_runs(tmp_path)
    explicit, static = outcome_of(runs[0], runs).arrests[0], outcome_of(runs[1], runs).arrests[0]
    assert explicit.by_J and explicit.confirmed is True and not static.by_J and static.interface == "weak"
    assert suspicions(runs[0], runs) == [] and suspicions(runs[0]) == ["J at interface (10\u00a0m)"]
    write_run(tmp_path, 1, replace(WEAK, mechanics="quasistatic", by="energy", stop_at_m=None))
    runs = load_runs(tmp_path)
    assert outcome_of(runs[0], runs).arrests[0].confirmed is False


def test_an_arrest_that_energy_decides_beyond_its_interface_is_that_interface_s(tmp_path: Path) -> None:
    """Within the reach of the J rings energy decides: such an arrest belongs to the interface; farther off it does not."""
    for stop, name in ((14.0, "weak"), (30.0, None)):
        plan = replace(WEAK, stop_at_m=stop, mechanics="quasistatic", by="energy")
        assert outcome_of(load_run(write_run(tmp_path, 1, plan))).arrests[0].interface == name


def test_figures_overlay_both_mechanics_and_tell_of_the_quasistatic_one(tmp_path: Path) -> None:
    """The explicit curve stands beside; title and caption are the quasi-static run's."""
    write_both(tmp_path, 1, Plan("perfect"))
    runs = load_runs(tmp_path)
    figure = height_figure(runs)
    assert [(curve.label, curve.beside) for curve in figure.curves] == [("perfect, without inertia", False), ("perfect, with inertia", True)]
    assert figure.title.startswith("Without inertia: perfect grew") and figure.title.count("grew") == 1
    assert not height_figure(runs[:1]).curves[0].beside and height_figure(runs[:1]).title.startswith("Perfect grew")


def test_runs_that_are_alike_are_one_curve(tmp_path: Path) -> None:
    """With all names, of both mechanics; a start 30 kPa later, or another end, is another curve. Arrests at interfaces alone are marked."""
    for plan in (Plan("perfect"), Plan("friction", ("friction",)), WEAK, Plan("soft", ("soft",), stop_at_m=10.0)):
        write_run(tmp_path, 1, plan)
    write_run(tmp_path, 1, Plan("perfect", mechanics="quasistatic"))
    write_run(tmp_path, 1, Plan("friction", ("friction",), mechanics="quasistatic", start_Pa=2.43e6))
    curves = height_figure(load_runs(tmp_path)).curves
    assert [curve.label for curve in curves] == [
        "perfect, without inertia; perfect and friction, with inertia", "friction, without inertia", "weak, with inertia", "soft, with inertia"]
    assert [[mark.kind for mark in curve.marks] for curve in curves] == [[], [], ["arrest", "restart"], ["arrest"]]
    assert height_figure(load_runs(tmp_path)[:1], load_runs(tmp_path)).pressure_MPa == height_figure(load_runs(tmp_path)).pressure_MPa


def test_paths_overlay_both_mechanics(tmp_path: Path) -> None:
    """The heading tells the quasi-static path, the explicit one has a label of its own."""
    write_run(tmp_path, 5, Plan("perfect", drift_m=-0.4))
    write_run(tmp_path, 5, Plan("perfect", drift_m=-1.4, mechanics="quasistatic"))
    panel = path_figure([load_runs(tmp_path)]).panels[0]
    assert [(path.variant, path.beside) for path in panel.paths] == [("perfect", False), ("perfect", True)]
    assert "by 1.4\u00a0m (perfect)" in panel.heading and "0.40" in panel.paths[1].label and "with inertia" in panel.paths[1].label


def test_the_difference_that_inertia_makes(tmp_path: Path) -> None:
    """One variant in both mechanics does the same; its energies by hand."""
    write_both(tmp_path, 1, WEAK)
    (row,) = comparisons(load_runs(tmp_path))
    assert row.unlike == () and row.kinetic_ratio == pytest.approx(0.02 / 0.6)
    assert "In 1 of 1 variants" in inertia_words([row]) and "3.3\u00a0%" in inertia_words([row])


@pytest.mark.parametrize("other, words", [
    (Plan("weak", ("weak",)), "arrested only with inertia"),
    (replace(WEAK, restart_Pa=None), "driven on only with inertia"),
    (replace(WEAK, stop_at_m=16.0, restart_Pa=None), "arrested elsewhere"),
])
def test_what_is_not_alike_is_said(tmp_path: Path, other: Plan, words: str) -> None:
    """A quasi-static run that does another thing than the explicit one is told so."""
    write_run(tmp_path, 1, WEAK)
    write_run(tmp_path, 1, replace(other, mechanics="quasistatic", by="energy"))
    (row,) = comparisons(load_runs(tmp_path))
    assert words in row.unlike


def test_paths_apart_are_measured(tmp_path: Path) -> None:
    """A path that drifts by 1 m at its end against a straight one: between nothing and that."""
    straight, bent = (load_run(write_run(tmp_path, 5, Plan("perfect", drift_m=drift, mechanics=name))) for drift, name in ((0.0, "explicit"), (1.0, "quasistatic")))
    # a parabola's root mean square is 1/sqrt(5) of its end; a little less with the straight start
    assert path_distance(straight, bent) == pytest.approx(1.0 / 5.0**0.5, rel=0.05)


def test_a_run_s_own_marks_are_told_with_their_values(tmp_path: Path) -> None:
    """Each with its value against the threshold, where it has one."""
    run = load_run(write_run(tmp_path, 1, Plan("perfect", mechanics="quasistatic")))
    mark = {"monitor": "energy_closure", "value": 0.025, "threshold": 0.01, "why": "the ledger stayed open"}
    run.summary |= {"suspect": [mark, mark | {"value": None, "why": "momentum is not a finite number"}]}
    assert suspicions(run) == ["the ledger stayed open (0.025 against 0.01)", "momentum is not a finite number"]
    (words,) = suspect_words([run])
    assert words.startswith("Experiment 1 perfect, without inertia: ") and "the ledger stayed open (0.025 against 0.01)" in words
    run.summary["suspect"] = []
    assert suspicions(run) == [] and suspect_words([run]) == []


def test_a_figure_s_caption_tells_of_its_suspect_runs_alone(tmp_path: Path) -> None:
    """Of the runs drawn, not of those of other experiments."""
    write_run(tmp_path, 1, Plan("perfect"))
    write_run(tmp_path, 2, Plan("perfect"))
    runs = load_runs(tmp_path)
    runs[1].summary["suspect"] = [{"monitor": "momentum", "value": None, "threshold": 1e-8, "why": "it drifted"}]
    specs = {spec.name: spec for spec in catalogue(runs, tmp_path, tmp_path)}
    assert suspect_words(specs["fig3"].runs) == [] and "it drifted" in suspect_words(specs["fig4"].runs)[0]
    assert "it drifted" in make(specs["fig4"], tmp_path).suspect[0]


# --- open points
POINT = Point("flow", "flow law", "the study's", (
    Choice("uniform", "flow law: uniform", "uniform", {STEMS[1]: {"perfect": "uniform", "weak": "weak"}}),
    Choice("other", "flow law: other", "other", {STEMS[1]: {"weak": "flow"}, STEMS[5]: {"perfect": "near"}}),
))


def test_a_choice_is_told_by_what_it_moves(tmp_path: Path) -> None:
    """Against the default of its own mechanics: start, climb, end, or where the interface is parallel the path; a dash where nothing was run."""
    write_both(tmp_path, 1, Plan("perfect"))
    write_both(tmp_path, 1, WEAK)
    write_run(tmp_path, 1, Plan("uniform", start_Pa=2.6e6))
    write_run(tmp_path, 1, replace(WEAK, variant="flow", start_Pa=2.37e6, restart_Pa=None, mechanics="quasistatic"))
    uniform, other = (row[3] for row in choice_rows([POINT], load_runs(tmp_path)))
    assert uniform.startswith("start +0.2") and uniform.endswith("(perfect, Experiment 1); with inertia")
    assert "the same start" in other and "ends at 10\u00a0m instead of 70\u00a0m (weak, Experiment 1)" in other and other.endswith("without inertia")
    write_run(tmp_path / "paths", 5, Plan("perfect"))
    write_run(tmp_path / "paths", 5, Plan("near", drift_m=2.0))
    assert [row[3][:8] for row in choice_rows([POINT], load_runs(tmp_path / "paths"))] == ["–", "path 0.8"]


def test_the_table_of_claims_against_choices() -> None:
    """Columns are the choices that claims were evaluated under; a claim that some choice overturns is named."""
    point = Point("edges", "edges", "held", (Choice("loaded", "edges: loaded", "loaded", {}), Choice("x", "edges: x", "x", {})))
    table = sensitivity(claims(), [point, POINT])
    assert table.points == [("edges", "edges", 1)] and [column.name for column in table.columns] == ["loaded"]
    kinds = {(line.id, line.mechanics): [cell.kind for cell in line.cells] for line in table.lines}
    assert kinds["2c", "with inertia"] == ["no", "yes"] and kinds["5a", "with inertia"] == ["no", "open"]
    assert "not under others: 2c" in table.finding and "under none: 5a" in table.finding and "that was run: 1b" in table.finding
