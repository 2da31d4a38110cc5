"""What the figures show, checked by hand on small cases."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reports.crack import raster, side_of
from reports.curves import height_figure, largest_turn, path_figure, profile_figure
from reports.layout import layout_of
from reports.ledger import base_of, closure_of, differences
from reports.outcome import finding, outcome_of, outcomes_of
from reports.runs import load_run, load_runs
from reports.tests.synthetic import Plan, write_run
from reports.verdicts import claim_rows
from reports.words import number, quantity


def test_sides_are_signs_about_the_extended_crack() -> None:
    """A vertical crack: left is -, right and on it +; behind means strictly below the tip."""
    x, y = np.array([39.0, 41.0, 40.0, 39.0, 41.0]), np.array([1.0, 1.0, 2.0, 9.0, 5.0])
    sign, behind = side_of(x, y, np.array([40.0, 40.0]), np.array([0.0, 5.0]))
    assert sign.tolist() == [-1, 1, 1, -1, 1]
    assert behind.tolist() == [True, True, True, False, False]


def test_the_largest_turn_of_a_path() -> None:
    """A right angle among gentle turns is found where it is."""
    turn, at = largest_turn(np.array([0.0, 0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0, 1.1]))
    assert turn == pytest.approx(90.0) and at == (0.0, 1.0)
    assert largest_turn(np.array([0.0, 0.0]), np.array([0.0, 1.0]))[0] == 0.0


def test_layout_places_interfaces_by_thickness(tmp_path: Path) -> None:
    """Two layers of 10 m put interfaces at 10 and 20 m; a parallel one lies at 45 m and crosses no height."""
    two = layout_of(load_run(write_run(tmp_path, 3, Plan("weak_soft", ("weak", "soft")))))
    assert two.heights_m == (10.0, 20.0) and [layer.to_m for layer in two.layers] == [10.0, 20.0, 80.0]
    beside = layout_of(load_run(write_run(tmp_path, 5, Plan("perfect"))))
    assert beside.heights_m == () and beside.interfaces[0].at_m == 45.0


def test_an_arrest_at_an_interface_by_J_is_flagged(tmp_path: Path) -> None:
    """An explicit run decides by J, and says so of an arrest at an interface; with the energy criterion it does not."""
    plan = Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)
    run = load_run(write_run(tmp_path, 1, plan))
    arrest = outcome_of(run).arrests[0]
    assert arrest.by_J and arrest.interface == "weak" and arrest.until_Pa == pytest.approx(3.2e6, abs=5e4)
    assert height_figure([run]).flagged
    run.scene["fracture"]["crossing"] = "energy"
    assert not outcome_of(run).arrests[0].by_J and not height_figure([run]).flagged


def test_an_event_of_its_own_word_is_believed(tmp_path: Path) -> None:
    """Where the solver itself says whether an arrest is at an interface, that counts."""
    run = load_run(write_run(tmp_path, 1, Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)))
    for event in run.summary["events"]:
        event["at_interface"] = False
    assert not outcome_of(run).arrests[0].by_J


def test_an_arrest_past_its_interface_says_how_far(tmp_path: Path) -> None:
    """The rings of a tip 4 m past an interface may still reach it: the sentence then says where it is."""
    run = load_run(write_run(tmp_path, 1, Plan("soft", ("soft",), stop_at_m=14.0, restart_Pa=3.0e6)))
    assert outcome_of(run).arrests[0].interface is None
    for event in run.summary["events"]:
        event["at_interface"] = event["kind"] == "arrest"
    arrest = outcome_of(run).arrests[0]
    assert arrest.interface == "soft" and arrest.beyond_m == pytest.approx(4.0, abs=1.1)
    assert "past the soft interface) until 3.0" in finding([outcome_of(run)])


def test_an_arrest_that_bonded_interfaces_show_too_is_a_pause(tmp_path: Path) -> None:
    """Stopping where and as long as the bonded twin does is not the interface's doing; stopping longer is."""
    for name, restart in (("perfect", 2.8e6), ("friction", 2.8e6), ("weak", 3.2e6)):
        write_run(tmp_path, 1, Plan(name, (name,), stop_at_m=10.0, restart_Pa=restart))
    runs = load_runs(tmp_path)
    assert [outcome_of(run, runs).arrests[0].interface for run in runs] == [None, None, "weak"]
    assert finding(outcomes_of(runs)).startswith("Perfect and friction grew to")


def test_like_outcomes_are_told_together(tmp_path: Path) -> None:
    """Two variants that run through share a clause; one that stops for good has its own."""
    for plan in (Plan("perfect"), Plan("friction", ("friction",)), Plan("soft", ("soft",), stop_at_m=10.0)):
        write_run(tmp_path, 1, plan)
    sentence = finding(outcomes_of(load_runs(tmp_path)))
    assert sentence.startswith("Perfect and friction grew to 70\u00a0m by 2.9")
    assert sentence.endswith("soft stopped at 10\u00a0m to the end at 4.00\u00a0MPa")


def test_profiles_are_taken_at_common_times(tmp_path: Path) -> None:
    """Both panels of the opening figure show nearly the same instants as far as their runs last."""
    for plan in (Plan("perfect"), Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=3.2e6)):
        write_run(tmp_path, 4, plan)
    panels = profile_figure(load_runs(tmp_path)).panels
    assert [panel.variant for panel in panels] == ["perfect", "weak"]
    assert len(panels[1].profiles) > len(panels[0].profiles) >= 3
    assert panels[0].profiles[-1].height_m.max() == 70.0


def test_paths_say_towards_which_rock_they_go(tmp_path: Path) -> None:
    """Experiment 5 has its soft rock on the left: a drift to the left is towards it."""
    write_run(tmp_path, 5, Plan("perfect", drift_m=-0.4))
    panel = path_figure([load_runs(tmp_path)]).panels[0]
    assert "towards the soft rock by 0.4\u00a0m (perfect)" in panel.heading
    assert panel.magnified > 5.0 and panel.aside == "interface 5\u00a0m to the right of the start"


def test_a_raster_averages_particles(tmp_path: Path) -> None:
    """One value a square of a particle's spacing; empty squares are NaN."""
    layout = layout_of(load_run(write_run(tmp_path, 1, Plan("perfect"))))
    points = {"x_m": np.array([10.0, 11.0]), "y_m": np.array([10.0, 11.0]), "volume_m2": np.array([400.0, 400.0])}
    _, _, field = raster(points, np.array([1.0, 3.0]), layout)
    assert field.shape == (4, 4) and field[0, 0] == 2.0 and np.isnan(field[1:, :]).all()


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
    case = {"observable": "start_Pa", "variant": "soft", "unit": "Pa", "value": 4e6, "low": 4e6, "high": None,
            "holds": None, "at_most": 3e6, "parameters": {"from_m": 6, "interface": 1}}
    row = claim_rows([{"id": "2c", "text": "t", "verdict": "not reproduced", "cases": [case]}])[0].cases[0]
    assert (row.holds, row.measured, row.asked) == ("open", "at least 4\u00a0MPa", "≤ 3\u00a0MPa")
    assert row.what == "soft: start (from 6\u00a0m, interface 1)"


def test_numbers_in_words() -> None:
    """Units come from keys; exact numbers lose their trailing zeros."""
    assert quantity("restart_inlet_Pa", 3.21e6) == "3.21\u00a0MPa"
    assert quantity("minimum_opening_m", 2e-4) == "2.00×10⁻⁴\u00a0m"
    assert number(0.0123456) == "0.0123" and number(2.0) == "2" and number(float("nan")) == "not finite"
