"""The work-precision chart: what is judged of its measurements, that failures stay, what is measured again, and one problem end to end."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from verification.harness.load import LoadError, Run
from verification.harness.paths import ANALYTIC, ROOT
from verification.ladder.case import Level, Sample
from verification.precision import measure
from verification.precision.__main__ import main
from verification.precision.measure import GROUPS, TOLERANCES, Panel, cheapest, choice_for, judged, nearest, panel_of, pareto, run_at
from verification.precision.problem import (
    ELEMENTS, FAILED, OK, REFUSED, STRATA, TOO_LONG, Found, Method, Point, Problem, Setting, Sheet, Wanted, checked, read_sheet, write_sheet,
)  # fmt: skip
from verification.precision.problems import PROBLEMS

SCENE = ANALYTIC / "static_quasistatic.toml"
MACHINE = {"processor": "a processor", "cores": 2, "caches": "L1 1K", "version": "0"}
EXACT = 4.0


def no_sample(_: Run) -> Sample:
    """Of tests that load no run."""
    raise LoadError("not asked for")


def levels(*sizes: float) -> tuple[Level, ...]:
    return tuple(Level(f"{size:g} m", size, (f"numerics.cell_m={size!r}",)) for size in sizes)


def method(name: str, *sizes: float, setting: Setting | None = None, program: str = STRATA) -> Method:
    return Method(name, name, setting or Setting(), source=SCENE if program == STRATA else "block_crack", levels=levels(*sizes))


def wanted(name: str = "K") -> Wanted:
    return Wanted(name, name, "1", "relative", no_sample)


def point(name: str, size: float, error: float | None, time_s: float, status: str = OK, number: str = "K", doubt: float = 0.0) -> Point:
    """A point that was off by a relative error, or had no value."""
    found = Found(failure="no value") if error is None else Found(EXACT * (1.0 + error), EXACT, error, doubt)
    return Point(name, f"{size:g} m", size, "key", status, "" if status == OK else "it broke", (time_s,) * 3, (time_s,) * 3,
                 "2026-01-01 00:00:00", found={number: found} if status == OK else {})  # fmt: skip


def panel(methods: tuple[Method, ...], points: list[Point], one: Wanted | None = None) -> Panel:
    problem = Problem("made_up", "made up", (one or wanted(),), methods)
    return panel_of(problem, problem.wanted[0], Sheet("made_up", MACHINE, tuple(points)))


def test_the_front_is_what_nothing_beats() -> None:
    one = panel((method("a", 1.0, 0.5), method("b", 1.0, 0.5), method("c", 1.0)), [
        point("a", 1.0, 0.1, 1.0), point("a", 0.5, 0.01, 4.0), point("b", 1.0, -0.05, 2.0), point("b", 0.5, 0.02, 5.0), point("c", 1.0, 0.05, 3.0),
    ])  # fmt: skip
    assert [dot.name for dot in pareto(one.dots)] == ["a, 1 m", "b, 1 m", "a, 0.5 m"]


def test_the_table_takes_the_cheapest_within_and_says_where_there_is_none() -> None:
    one = panel((method("a", 1.0, 0.5), method("b", 1.0)), [point("a", 1.0, 0.04, 1.0), point("a", 0.5, 0.009, 9.0), point("b", 1.0, -0.008, 3.0)])
    choices = [cheapest(one.of(), error) for error in TOLERANCES]
    assert [dot and dot.name for dot in choices] == ["a, 1 m", "b, 1 m", None]
    best = nearest(one.of())
    assert best is not None and best.method.name == "b"


@pytest.mark.parametrize("wrong", ["zero", "twice", "flipped sign"])
def test_a_result_that_is_wrong_in_a_plain_way_is_never_advised(wrong: str) -> None:
    sample = Sample.of(EXACT * 1.001, EXACT)
    assert abs(sample.error()) < 0.0011
    error = sample.mutants()[wrong]
    one = panel((method("right", 1.0), method("wrong", 1.0)), [point("right", 1.0, 0.02, 50.0), point("wrong", 1.0, error, 0.001)])
    for tolerance in (0.05, 0.01, 0.001):
        found = cheapest(one.dots, tolerance)
        assert found is None or found.method.name == "right"
    assert pareto(one.dots)[-1].method.name == "right"


def test_an_error_of_exactly_zero_is_worth_what_the_reference_is_known_to() -> None:
    one = panel((method("a", 1.0),), [point("a", 1.0, 0.0, 1.0, doubt=0.02)])
    assert one.dots[0].judged == 0.02
    assert cheapest(one.dots, 0.01) is None and cheapest(one.dots, 0.05) is not None


@pytest.mark.parametrize(("errors", "sizes", "by_order", "counted"), [
    ([0.001, 0.02, 0.004], [4.0, 2.0, 1.0], True, [0.02, 0.02, 0.004]),  # with the worst of those finer
    ([0.08, -0.0001], [2.0, 1.0], True, [0.08, 0.01]),  # a change of sign with what third order leaves
    ([0.08, 0.0001], [2.0, 1.0], True, [0.08, 0.0001]), ([0.08, -0.0001], [2.0, 1.0], False, [0.08, 0.0001]),
])  # fmt: skip
def test_errors_as_they_are_judged(errors: list[float], sizes: list[float], by_order: bool, counted: list[float]) -> None:
    assert judged(errors, [0.0] * len(errors), sizes, by_order) == pytest.approx(counted, rel=1e-12)


def test_luck_is_marked() -> None:
    one = panel((method("a", 2.0, 1.0),), [point("a", 2.0, 0.0001, 1.0), point("a", 1.0, 0.01, 2.0)])
    assert [dot.lucky for dot in one.dots] == [True, False]
    assert [dot.point.level for dot in pareto(one.dots)] == ["2 m"] and nearest(one.dots) is one.dots[0]


def test_failures_are_kept_with_their_reason() -> None:
    one = panel((method("a", 2.0, 1.0, 0.5), method("b", 1.0)), [
        point("a", 2.0, 0.01, 1.0), point("a", 1.0, None, 2.0), point("a", 0.5, None, 3.0, FAILED), point("b", 1.0, None, 0.1, REFUSED),
    ])  # fmt: skip
    assert [(lack.method.name, lack.level, lack.status, lack.reason) for lack in one.lacks] == [
        ("a", "1 m", "no value", "no value"), ("a", "0.5 m", FAILED, "it broke"), ("b", "1 m", REFUSED, "it broke"),
    ]  # fmt: skip
    assert len(one.dots) == 1


def test_methods_with_inertia_and_boundary_elements_have_rows_of_their_own() -> None:
    moving, elements = method("m", 1.0, setting=Setting("explicit")), method("e", 1.0, program=ELEMENTS)
    one = panel((method("a", 1.0), moving, elements), [point("a", 1.0, 0.01, 1.0), point("m", 1.0, 0.01, 5.0), point("e", 1.0, 1e-6, 0.1)])
    assert {group: dot.method.name for group in GROUPS if (dot := cheapest(one.of(group), 0.01))} == {"any method": "a", "with inertia": "m", "boundary elements": "e"}


def two_panels(errors: dict[str, tuple[float, float]]) -> list[Panel]:
    """Two numbers of one problem, each method with an error in both; times in the order given."""
    both = (wanted("K"), wanted("L"))
    problem = Problem("made_up", "made up", both, tuple(method(name, 1.0) for name in errors))
    points = []
    for k, (name, (first, second)) in enumerate(errors.items()):
        found = {"K": Found(1.0, 1.0, first), "L": Found(1.0, 1.0, second)}
        points.append(replace(point(name, 1.0, 0.0, 1.0 + k), found=found))
    sheet = Sheet("made_up", MACHINE, tuple(points))
    return [panel_of(problem, one, sheet) for one in both]


def test_an_experiment_uses_the_cheapest_run_that_is_right_in_all() -> None:
    found = choice_for(two_panels({"half": (0.001, 0.3), "good": (0.009, -0.008), "better": (0.001, 0.001)}), 0.01)
    assert found is not None and found[1] and found[0][0].method.name == "good"


def test_where_none_is_right_it_uses_the_nearest_and_says_so() -> None:
    panels = two_panels({"half": (0.001, 0.3), "good": (0.04, 0.05)})
    found = choice_for(panels, 0.01)
    assert found is not None and not found[1] and found[0][0].method.name == "good"
    assert run_at(panels, "half", "1 m") is not None and run_at(panels, "half", "2 m") is None


def test_the_key_changes_with_scene_settings_and_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program, scene = tmp_path / "strata", tmp_path / "scene.toml"
    program.write_text("one")
    scene.write_text('title = "a"\n[domain]\nwidth_m = 80\n[variants.x]\ndomain.width_m = 40\n')
    monkeypatch.setenv("STRATA", str(program))
    one = Method("a", "a", Setting(), source=scene, levels=levels(1.0))
    keys = [measure.key_of(one, one.levels[0])]
    assert measure.key_of(replace(one, name="b", label="other words"), one.levels[0]) == keys[0]
    keys.append(measure.key_of(one, replace(one.levels[0], settings=("numerics.cell_m=0.5",))))
    keys.append(measure.key_of(one, replace(one.levels[0], variant="x")))
    scene.write_text('title = "b"\n[domain]\nwidth_m = 81\n')
    keys.append(measure.key_of(one, one.levels[0]))
    program.write_text("two")
    keys.append(measure.key_of(one, one.levels[0]))
    assert len(set(keys)) == len(keys)


def test_short_runs_are_warmed_up_and_long_ones_made_once() -> None:
    def counted(time_s: float) -> tuple[int, int]:
        calls = []
        times = measure.repeated(lambda: (calls.append(1), (time_s, time_s))[1])
        return len(calls), len(times)

    assert counted(0.1) == (6, 5) and counted(5.0) == (3, 3) and counted(60.0) == (1, 1)


def test_sheets_are_read_as_they_were_written(tmp_path: Path) -> None:
    sheet = Sheet("made_up", MACHINE, (point("b", 1.0, 0.01, 1.5), point("a", 2.0, None, 0.5, FAILED), point("a", 1.0, None, 0.5)))
    write_sheet(sheet, tmp_path, ["a", "b"])
    back = read_sheet("made_up", tmp_path)
    assert back is not None and back.points == (sheet.points[1], sheet.points[2], sheet.points[0]) and back.machine == sheet.machine


def test_problems_are_as_the_chart_relies_on() -> None:
    assert len({one.name for problem in PROBLEMS for one in problem.wanted}) == sum(len(problem.wanted) for problem in PROBLEMS)
    good = Problem("p", "", (wanted(),), (method("a", 1.0),))
    for bad in (replace(good, methods=(method("a", 1.0), method("a", 2.0))), replace(good, methods=(method("a", 1.0, 2.0),))):
        with pytest.raises(ValueError):
            checked((bad,))


def test_one_problem_from_the_command_to_the_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["--quick", "--only", "block", "--out", str(tmp_path)]
    assert main(command) == 0
    sheet = read_sheet("block", tmp_path)
    assert sheet is not None and {point.method for point in sheet.points} >= {"qs_graded", "ex_updated", "ex_total"}
    for one in sheet.points:
        assert one.ok and one.time_s > 0.0 and min(one.cpu_s) > 0.0, one.reason
        error = one.found["block_K_I"].error
        assert error is not None and 0.0 < abs(error) < 0.01  # zero, twice and the flipped sign are 1 or 2 off
    capsys.readouterr()
    assert main([*command, "--list"]) == 0
    assert f"{len(sheet.points)} points, 0 to measure" in capsys.readouterr().out
    text = (tmp_path / "block.json").read_text(encoding="utf-8")
    content = json.loads(text.replace(sheet.points[0].key, "another"))
    (tmp_path / "block.json").write_text(json.dumps(content))
    assert main([*command, "--list"]) == 0
    assert "1 to measure" in capsys.readouterr().out


@pytest.mark.parametrize(("scene", "settings", "status", "said"), [
    ("static_quasistatic", ("numerics.mechanics=quasistatic", "numerics.shape=gimp"), REFUSED, "numerics.shape=gimp"),
    ("kgd", ("numerics.mechanics=explicit",), REFUSED, "verification/analytic/kgd.toml:"),
    ("static_quasistatic", ("numerics.mechanics=quasistatic", "numerics.cell_m=0.125"), TOO_LONG, "not done after 0.2 s"),
])  # fmt: skip
def test_what_has_no_result_is_a_point(tmp_path: Path, scene: str, settings: tuple[str, ...], status: str, said: str) -> None:
    """A scene is named by its place in the project: data of one machine are read on others. Mutation that fails: the reason as the solver gives it."""
    one = replace(method("odd", 1.0), source=ANALYTIC / f"{scene}.toml", levels=(Level("1 m", 1.0, settings),))
    found = measure.measured(Problem("odd", "odd", (wanted(),), (one,), limit_s=0.2), one, one.levels[0], tmp_path)
    assert found.status == status and said in found.reason and str(ROOT) not in found.reason and len(found.wall_s) == 1
