"""The ladder's own rules on made-up numbers: samples, orders, gates, verdicts, runs that fail."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from verification.ladder import __main__ as command
from verification.ladder import case as catalogue
from verification.ladder import gates
from verification.ladder.case import Case, Families, Level, Quantity, Sample, cell_levels
from verification.ladder.gates import CannotAccept, Gate
from verification.ladder.__main__ import text
from verification.ladder.measure import HALF_AN_ORDER, Row, accepted, judged, make_all, mutants_of, order_of, rows_of, rungs_of, tally
from verification.tests.fake_run import changed, program, write_run

MUTANTS = {"zero": -1.0, "twice": 1.02, "flipped sign": -2.0}


def ladder_of(*errors: float, no_order: str = "") -> list[Row]:
    """Rows of one quantity on cells halved from level to level, with their orders."""
    rows = [Row("made_up", "case", "quasistatic", "K", "", f"{0.5**k:g} m", 0.5**k, no_order, 1, 1.0 + error, 1.0, error=error, mutants=MUTANTS)
            for k, error in enumerate(errors)]  # fmt: skip
    return [replace(row, order=order_of(before.error, row.error, 2.0) if before else None) for before, row in zip([None, *rows], rows)]


def gated(rows: list[Row]) -> dict[str, gates.Gates]:
    """The gates that rows ask for, all of which can be accepted."""
    now, refused = accepted(rows, {})
    assert refused == []
    return now


@pytest.mark.parametrize(("sample", "error", "mutants"), [
    (Sample.of(1.1, 1.0), 0.1, {"zero": -1.0, "twice": 1.2, "flipped sign": -2.1}),
    (Sample.of(0.9, 1.0), -0.1, {"zero": -1.0, "twice": 0.8, "flipped sign": -1.9}),
    (Sample.of(-0.9, -1.0), 0.1, {"zero": 1.0, "twice": -0.8, "flipped sign": 1.9}),  # value less exact, by the size of the exact one
    (Sample(np.array([1.0, 2.0, 4.0]), np.array([1.0, 2.0, 3.0]), np.array([1.0, 1.0, 2.0])), math.sqrt(2.0 / (1.0 + 4.0 + 18.0)), None),
    (Sample(np.array([3.0, 4.0]), np.array([3.0, 4.0])), 0.0, {"zero": 1.0, "twice": 1.0, "flipped sign": 2.0}),
    (Sample.of(1e-3, 0.0, scale=10.0), 1e-4, {"off by its scale": 1.0001}), (Sample.of(3.0, 0.0, scale=100.0), 0.03, None),
])  # fmt: skip
def test_errors_of_samples_and_of_their_mutants(sample: Sample, error: float, mutants: dict[str, float] | None) -> None:
    assert sample.error() == pytest.approx(error)
    assert mutants is None or sample.mutants() == {name: pytest.approx(value) for name, value in mutants.items()}
    with pytest.raises(ValueError, match="needs a scale"):
        Sample.of(3.0, 0.0).error()


@pytest.mark.parametrize("no_order", ["", "the reference's own error is as large"])
def test_gates_are_never_wider_than_one_and_a_half_times_the_error_and_lose_less_than_half_an_order(no_order: str) -> None:
    for error in np.geomspace(2e-12, 0.6, 997):
        gate = gates.gate_of(no_order, float(error), None, MUTANTS)
        assert 1.36 * error < gate.error <= 1.5 * error and gate.error == float(f"{gate.error:.2g}"), "two digits"
        assert gate.measured <= error and gates.too_wide(gate, False) == ""
    for order in np.linspace(0.31, 4.0, 370):
        gate = gates.gate_of("", 1e-3, float(order), MUTANTS)
        assert order - 0.3 - 1e-9 <= gate.order < order - 0.28 and gates.too_wide(gate, False) == ""


@pytest.mark.parametrize(("error", "allowed"), [(0.0, 1e-12), (3e-16, 1e-12), (9e-14, 1e-12), (2e-13, 1e-11), (4e-10, 1e-8), (3e-8, 1e-6), (3e-7, 1e-6)])
def test_gates_of_round_off_have_a_floor(error: float, allowed: float) -> None:
    assert gates.gate_of("round-off: exact on any mesh", error, None, MUTANTS).error == pytest.approx(allowed)


@pytest.mark.parametrize(("no_order", "error", "order", "why"), [
    ("", math.nan, None, "error is nan"), ("", 0.9, None, "so large that zero, twice would pass"), ("", 0.68, None, "so large that zero would pass"),
    ("", 1e-3, 0.3, "no convergence"), ("", 1e-3, -0.6, "no convergence"), ("", 1e-3, math.nan, "no convergence"),
    ("", 1e-15, None, "is round-off"), ("round-off", 4e-7, None, "no round-off"),
])  # fmt: skip
def test_what_no_gate_can_be_made_of(no_order: str, error: float, order: float | None, why: str) -> None:
    with pytest.raises(CannotAccept, match=why):
        gates.gate_of(no_order, error, order, MUTANTS)


@pytest.mark.parametrize(("gate", "round_off", "why"), [
    (Gate(0.0151, 0.01), False, "more than 1.5 times"), (Gate(0.015, 0.01, 0.69, 1.0), False, "below the measured"),
    (Gate(0.015, 0.01, 0.7, None), False, "without"), (Gate(1e-5, 1e-15), True, "no gate of round-off"),
    (Gate(1e-12, 1e-15), False, "more than 1.5 times"),
])  # fmt: skip
def test_gates_widened_by_hand_are_seen(gate: Gate, round_off: bool, why: str) -> None:
    assert why in gates.too_wide(gate, round_off)
    rows = ladder_of(gate.measured, no_order="round-off" if round_off else "")
    row = judged(rows, {"made_up": {rows[0].key: gate}})[0]
    assert row.verdict == "FAIL" and why in "".join(row.problems)


def test_gates_are_written_and_read_back(tmp_path: Path) -> None:
    known = gated(ladder_of(0.04, 0.02, 0.005))["made_up"]
    gates.write("made_up", known, tmp_path)
    assert gates.read("made_up", tmp_path) == known and len(known) == 3
    assert gates.read("other", tmp_path) == {}
    (tmp_path / "torn.json").write_text('{"cases": {"a": 3}}')
    with pytest.raises(ValueError, match="torn.json"):
        gates.read("torn", tmp_path)


def test_changed_gates_are_told_and_wider_ones_marked() -> None:
    one, two, w, v = (("c", *key) for key in (("K", "1 m"), ("K", "2 m"), ("w", "1 m"), ("v", "1 m")))
    before = {one: Gate(0.01, 0.007), two: Gate(0.1, 0.07), w: Gate(0.02, 0.014, 0.7, 1.0)}
    now = {one: Gate(0.02, 0.014), w: Gate(0.02, 0.014, 0.6, 0.9), v: Gate(0.1, 0.08)}
    assert gates.changes(before, now) == [
        "c / K / 1 m: error 0.01 -> error 0.02  WIDER", "c / K / 2 m: error 0.1 -> none",
        "c / w / 1 m: error 0.02 order 0.7 -> error 0.02 order 0.6  WIDER", "c / v / 1 m: none -> error 0.1",
    ]  # fmt: skip
    assert gates.changes(now, now) == []


def test_what_was_accepted_passes_and_refuses_its_mutants() -> None:
    rows = judged(ladder_of(0.04, 0.021, 0.005), gated(ladder_of(0.04, 0.021, 0.005)))
    found = tally(rows)
    assert [row.verdict for row in rows] == ["pass"] * 3 and (found.gates, found.mutants, found.refused) == (5, 11, 11)
    assert found.words() == "3 comparisons: 3 pass; 5 gates, 11 mutants, all refused"


@pytest.mark.parametrize(("finest", "why"), [
    (0.0076, "error 0.0076 above 0.0075"), (0.00701, "order 1.52 below 1.71"),  # half an order lost
    (-0.005, "changes its sign"), (math.nan, "above"),
])  # fmt: skip
def test_what_went_wrong_fails(finest: float, why: str) -> None:
    rows = judged(ladder_of(0.04, 0.0201, finest), gated(ladder_of(0.04, 0.0201, 0.005)))
    assert rows[2].verdict == "FAIL" and why in "; ".join(rows[2].problems)


def test_what_became_better_is_noted_and_passes() -> None:
    known = gated(ladder_of(0.04, 0.0201, 0.005))
    for finest, note in ((0.0046, ""), (0.0044, "gate can be tightened (error 0.0044, accepted at 0.005): --accept"),  # 0.92 of the error is the same
                         (0.0025, "gate can be tightened (error 0.0025, accepted at 0.005; order 3.01, accepted at 2.01): --accept")):  # fmt: skip
        rows = judged(ladder_of(0.04, 0.0201, finest), known)
        assert [(row.verdict, row.note) for row in rows] == [("pass", ""), ("pass", ""), ("pass", note)]
    assert f"pass: {rows[2].note}" in text(rows)
    found = tally(rows)
    assert (found.mutants, found.refused, found.loose) == (11, 11, 1) and found.words().endswith("all refused; 1 can be tightened")
    assert judged(ladder_of(0.04, 0.0201, 0.0025), gated(rows))[2].note == "", "accepting tightens it"
    assert judged(ladder_of(0.0, no_order="round-off"), gated(ladder_of(1e-15, no_order="round-off")))[0].note == ""


def test_a_missing_gate_fails() -> None:
    known = gated(ladder_of(0.04, 0.02))
    assert all(row.verdict == "FAIL" and "no gate" in row.problems[0] for row in judged(ladder_of(0.04, 0.02), {}))
    key = ladder_of(0.04, 0.02)[1].key
    known["made_up"][key] = replace(known["made_up"][key], order=None, measured_order=None)
    assert "no gate of order" in judged(ladder_of(0.04, 0.02), known)[1].problems[0]


def test_half_an_order_lost_is_refused_by_the_order_where_the_error_alone_would_pass() -> None:
    rows = ladder_of(0.04, 0.02)
    known = gated(rows)
    gate = known["made_up"][rows[1].key]
    lost = mutants_of(rows[1], rows[0], gate)[HALF_AN_ORDER]
    assert abs(lost) <= gate.error, "the gate of the error does not see it here"
    assert order_of(rows[0].error, lost, 2.0) == pytest.approx(0.5)
    assert judged(rows, known)[1].verdict == "pass"
    # With an order gate 0.6 below half an order lost would pass: so the gate fails.
    loose = replace(gate, order=0.4)
    row = judged(rows, {"made_up": {**known["made_up"], rows[1].key: loose}})[1]
    assert row.problems[-1] == f"the gate lets {HALF_AN_ORDER} pass" and "more than 0.3 below" in row.problems[0]
    assert row.refused == 3
    # Where the order rose since, half is lost from the accepted one.
    before = replace(gate, order=0.4, measured_order=0.7)
    row = judged(rows, {"made_up": {**known["made_up"], rows[1].key: before}})[1]
    assert order_of(rows[0].error, mutants_of(rows[1], rows[0], before)[HALF_AN_ORDER], 2.0) == pytest.approx(0.2)
    assert row.problems == () and row.refused == 4 and "order 1.00, accepted at 0.70" in row.note


def test_a_gate_that_lets_a_mutant_pass_fails() -> None:
    rows = ladder_of(0.04)
    near = [replace(rows[0], mutants={**MUTANTS, "twice": 0.05})]
    row = judged(near, gated(rows))[0]
    assert row.problems == ("the gate lets twice pass",)
    assert tally([row]).words() == "1 comparisons: 0 pass, 1 not as their gates ask; 1 gates, 3 mutants, 1 NOT REFUSED"
    assert accepted(near, {})[1] == ["made_up/case K 1 m: an error of 0.04 is so large that twice would pass"]


def test_a_reason_spares_the_order_and_nothing_else() -> None:
    rows, worse = (ladder_of(0.002, finest, no_order="the error changes its sign") for finest in (-0.003, -0.005))
    known = gated(rows)
    assert [row.verdict for row in judged(rows, known)] == ["pass", "pass"] and judged(worse, known)[1].verdict == "FAIL"
    assert all(gate.order is None for gate in known["made_up"].values())


def test_a_failed_level_takes_the_order_with_it_and_keeps_its_gate() -> None:
    known = gated(ladder_of(0.04, 0.02))
    rows = ladder_of(0.04, 0.02)
    rows = judged([replace(rows[0], failure="a mechanism"), replace(rows[1], order=None)], known)
    assert [row.verdict for row in rows] == ["FAILED", "FAIL"] and "level before failed" in rows[1].problems[0] and tally(rows).failed == 1
    now, refused = accepted(rows, known)
    assert now == known and len(refused) == 2


MOUTH = Quantity("mouth", "m", lambda run: Sample.of(run.summary.mouth_opening_m, 1.0e-3, reference_error=1e-6))
BROKEN = Quantity("broken", "m", lambda run: run.history["no such column"])


@pytest.fixture()
def a_case(tmp_path: Path) -> Case:
    scene = tmp_path / "made_up.toml"
    scene.write_text('title = "made up"\nnumerics.cell_m = 1.0\n')
    return Case("two_levels", "Nothing.", scene, "explicit", cell_levels(1.0, 0.5), (MOUTH,), smoke=1)


@pytest.fixture()
def solver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program in the solver's place: copies a run whose opening is off by cell / 100, and fails on cells of 0.25 m."""
    for name, opening in (("1.0", 1.01e-3), ("0.5", 1.005e-3)):
        changed(write_run(tmp_path / "made" / name, [(2.4e6, 40.0, 6.0)]), mouth_opening_m=opening)
    made = program(tmp_path / "strata")
    monkeypatch.setenv("STRATA", str(made))
    return made


def test_runs_are_made_once_and_measured(tmp_path: Path, solver: Path, a_case: Case) -> None:
    rungs = rungs_of({"fam": (a_case,)}, runs=tmp_path / "ladder")
    rows = rows_of(make_all(rungs, jobs=2))
    assert [row.error for row in rows] == [pytest.approx(0.01), pytest.approx(0.005)]
    assert rows[0].order is None and rows[1].order == pytest.approx(1.0) and rows[1].cost["particles"] == 25600 and rows[1].reference_error == 1e-6
    again = make_all(rungs)
    assert all(outcome.skipped for _, (outcome, _) in again) and len((tmp_path / "calls").read_text().splitlines()) == 2
    assert (tmp_path / "ladder" / "fam" / "two_levels" / "0.5_m" / "summary.json").is_file()
    assert "numerics.mechanics=explicit" in (tmp_path / "calls").read_text()


def test_a_failed_run_is_a_failed_row(tmp_path: Path, solver: Path, a_case: Case) -> None:
    case = replace(a_case, levels=cell_levels(1.0, 0.5, 0.25), quantities=(MOUTH, BROKEN))
    rows = judged(rows_of(make_all(rungs_of({"fam": (case,)}, runs=tmp_path / "ladder"))), {})
    assert [row.verdict for row in rows] == ["FAIL", "FAIL", "FAILED", "FAILED", "FAILED", "FAILED"]
    assert rows[2].failure == "the block is a mechanism" and rows[3].failure == "not measured: KeyError: 'no such column'"
    assert "FAILED: the block is a mechanism" in text(rows)


def test_a_run_in_other_mechanics_is_no_measurement(tmp_path: Path, solver: Path, a_case: Case) -> None:
    rows = rows_of(make_all(rungs_of({"fam": (replace(a_case, mechanics="quasistatic"),)}, runs=tmp_path / "ladder")))
    assert [row.failure for row in rows] == ["the solver ran explicit instead of quasistatic"] * 2


@pytest.fixture()
def ladder(tmp_path: Path, solver: Path, a_case: Case, monkeypatch: pytest.MonkeyPatch) -> Families:
    """The command line on made-up cases, gates and runs."""
    known = {"fam": (a_case,)}
    monkeypatch.setattr(command, "families", lambda: known)
    monkeypatch.setattr(gates, "FOLDER", tmp_path / "gates")
    return known


# The keys of a row that reports/ladder.py reads, and what its tests make up.
READ_BY_THE_PAGE = {
    "family", "case", "mechanics", "quantity", "unit", "level", "size", "no_order", "values", "value", "reference",
    "reference_error", "scale", "error", "order", "cost", "mutants", "failure", "gate", "problems", "note", "refused", "verdict",
}  # fmt: skip


def asked(tmp_path: Path, *options: str) -> int:
    """The command's exit status."""
    return command.main(["--runs", str(tmp_path / "ladder"), *options])


def test_the_command_from_no_gates_to_a_pass(tmp_path: Path, ladder: Families, capsys: pytest.CaptureFixture[str]) -> None:
    assert asked(tmp_path) == 1 and "no gate" in capsys.readouterr().out
    assert asked(tmp_path, "--accept") == 0
    said = capsys.readouterr().out
    assert "two_levels / mouth / 0.5 m: none -> error 0.0075 order 0.7" in said or "error 0.0074" in said
    assert asked(tmp_path) == 0 and "2 comparisons: 2 pass; 3 gates, 7 mutants, all refused" in capsys.readouterr().out
    content = json.loads((tmp_path / "ladder" / "ladder.json").read_text())
    assert [row["verdict"] for row in content["rows"]] == ["pass", "pass"] and not content["part"]
    assert set(content["rows"][0]) == READ_BY_THE_PAGE


def test_the_command_at_smoke_size_keeps_the_other_gates(tmp_path: Path, ladder: Families) -> None:
    assert asked(tmp_path, "--accept") == 0
    before = (tmp_path / "gates" / "fam.json").read_text()
    assert asked(tmp_path, "--smoke", "--accept") == 0 and (tmp_path / "gates" / "fam.json").read_text() == before
    content = json.loads((tmp_path / "ladder" / "ladder_part.json").read_text())
    assert len(content["rows"]) == 1 and content["part"]


def test_the_command_tells_a_run_that_fails_and_gates_of_nothing(tmp_path: Path, ladder: Families, capsys: pytest.CaptureFixture[str]) -> None:
    assert asked(tmp_path, "--accept") == 0
    known = ladder["fam"]
    ladder["fam"] = (replace(known[0], levels=cell_levels(1.0, 0.5, 0.25)),)
    assert asked(tmp_path) == 3 and "1 failed" in capsys.readouterr().out
    ladder["fam"] = known
    ladder["fam"] = (replace(ladder["fam"][0], name="renamed"),)
    assert asked(tmp_path) == 1
    assert "gate of nothing: fam/two_levels / mouth / 1 m" in capsys.readouterr().out
    assert asked(tmp_path, "--accept") == 0, "accepting removes them"
    (tmp_path / "gates" / "gone.json").write_text((tmp_path / "gates" / "fam.json").read_text())
    assert asked(tmp_path) == 1 and "gone.json: there is no family gone; remove the file" in capsys.readouterr().out
    assert asked(tmp_path, "--accept") == 1 and (tmp_path / "gates" / "gone.json").exists(), "files are removed by hand"


def test_accepting_touches_the_files_of_its_families_alone(tmp_path: Path, ladder: Families, a_case: Case) -> None:
    def content() -> dict[str, tuple[str, int]]:
        return {path.name: (path.read_text(), path.stat().st_mtime_ns) for path in folder.iterdir()}

    folder = tmp_path / "gates"
    ladder["other"] = (replace(a_case, name="another"),)
    assert asked(tmp_path, "--accept") == 0 and {path.name for path in folder.iterdir()} == {"fam.json", "other.json"}
    gates.write("later", gates.read("fam"), folder)  # of a family that came after the command began
    for path in folder.iterdir():
        path.write_text(path.read_text().replace("0.01", "0.02"))
    before = content()
    assert asked(tmp_path, "--family", "fam", "--accept") == 0
    assert asked(tmp_path, "--case", "two_levels", "--smoke", "--accept") == 0
    after = content()
    assert after.pop("fam.json") != before.pop("fam.json") and after == before
    asked(tmp_path, "--accept")
    assert (folder / "later.json").is_file()


def test_gates_that_were_changed_while_the_runs_were_made_stay(
    tmp_path: Path, ladder: Families, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert asked(tmp_path, "--accept") == 0
    known = gates.read("fam")
    changed = {("new_case", "mouth", "1 m"): Gate(0.01, 0.007), **{key: replace(gate, error=0.001) for key, gate in known.items()}}
    make = command.make_all

    def slowly(*rest: object, **more: object) -> object:
        gates.write("fam", changed)
        return make(*rest, **more)

    monkeypatch.setattr(command, "make_all", slowly)
    assert asked(tmp_path, "--accept") == 1 and gates.read("fam") == changed
    assert "fam: its gates were changed while the runs were made" in capsys.readouterr().out
    assert asked(tmp_path, "--accept") == 0 and gates.read("fam") == known, "the second time it is what was there"


def test_the_command_with_nothing_to_judge_is_no_pass(tmp_path: Path, ladder: Families) -> None:
    ladder.clear()
    assert asked(tmp_path) == 1


@pytest.mark.parametrize(("change", "why"), [
    ({"levels": ()}, "no levels"), ({"levels": cell_levels(1.0, 2.0)}, "do not fall"), ({"levels": (Level("a", 1.0), Level("a", 0.5))}, "same name"),
    ({"quantities": ()}, "no levels or no quantities"), ({"smoke": 3}, "3 smoke levels of 2"), ({"smoke": 0}, "0 smoke levels"),
    ({"scene": Path("nowhere.toml")}, "no scene"),
    ({"quantities": (replace(MOUTH, no_order_at={"4 m": "why"}),)}, "names no level: 4 m"),
])  # fmt: skip
def test_cases_that_cannot_be_judged_are_refused(a_case: Case, change: dict[str, object], why: str) -> None:
    catalogue.check("fam", (a_case,))
    with pytest.raises(ValueError, match=why):
        catalogue.check("fam", (replace(a_case, **change),))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="same name"):
        catalogue.check("fam", (a_case, a_case))


def test_cases_are_chosen_by_family_and_name(a_case: Case) -> None:
    known = {"a": (a_case, replace(a_case, name="other")), "b": (a_case,)}
    assert {family: len(members) for family, members in catalogue.chosen(known).items()} == {"a": 2, "b": 1}
    assert catalogue.chosen(known, ["a"], ["oth"]) == {"a": (known["a"][1],)}
    assert list(catalogue.chosen(known, (), ["other"])) == ["a"]
    for family, name, why in ((["c"], [], "no family c"), (["b"], ["other"], "no case other")):
        with pytest.raises(ValueError, match=why):
            catalogue.chosen(known, family, name)
