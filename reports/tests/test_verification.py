"""The page of verification shows every comparison, says what was found, and survives what is broken or missing."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from reports.charts.precision import spread_apart
from reports.ladder import convergence_figure, load_ladder, topic
from reports.make_page import main as make_page
from reports.words import Shown, relative
from verification.harness.front_table import LINES
from verification.harness.paths import ROOT

SIZES = (2.0, 1.0, 0.5)


def a_row(case: str, quantity: str, level: int, error: float | None, **more: Any) -> dict[str, Any]:
    """A comparison as ladder.json has it."""
    size = SIZES[level]
    row = {
        "family": "cracks", "case": case, "mechanics": "explicit" if "moving" in case else "quasistatic", "quantity": quantity,
        "unit": "m", "level": f"{size:g} m", "size": size, "no_order": "", "values": 1,
        "value": None if error is None else 2.0 * (1.0 + error), "reference": 2.0, "reference_error": 1e-7, "error": error,
        "order": 1.0 if level else None, "scale": None, "mutants": {"zero": -1.0}, "failure": "", "problems": [], "refused": 4,
        "cost": {"wall_s": 0.5 * 8**level, "particles": 6400 * 4**level, "steps": 0, "peak_memory_MB": 40.5},
        "gate": {"error": 0.06 / 2**level, "measured": 0.04 / 2**level, "order": 0.7 if level else None,
                 "measured_order": 1.0 if level else None}, "verdict": "pass",
    }
    return {**row, **more}


def write_ladder(root: Path, rows: list[dict[str, Any]], **more: Any) -> Path:
    """A ladder.json below a folder of runs; returns that folder."""
    cases = dict.fromkeys((row["family"], row["case"], row["mechanics"]) for row in rows)
    families = [
        {"name": name, "says": f"About {name}.", "cases": [
            {"name": case, "says": f"It shows {case}.", "mechanics": mechanics, "scene": "a.toml"}
            for family, case, mechanics in cases if family == name]}
        for name in dict.fromkeys(row["family"] for row in rows)
    ]
    tally = {"rows": len(rows), "wrong": 0, "failed": 0, "gates": 7, "mutants": 31, "refused": 31, "words": ""}
    content = {"part": False, "machine": "made up", "tally": tally, "stale": [], "families": families, "rows": rows, **more}
    path = root / "runs" / "ladder" / "ladder.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content), encoding="utf-8")
    return root / "runs"


def some_rows() -> list[dict[str, Any]]:
    """Two cases: one converges in one quantity and is exact in another, one falls short and fails."""
    rows = [a_row("at_rest", "K_I", k, 0.04 / 2**k) for k in range(3)]
    exact = {"no_order": "round-off: symmetric", "scale": 1234.5}
    rows += [a_row("at_rest", "K_II", k, -2e-9, order=None if k == 0 else 0.3, **exact) for k in range(3)]
    rows += [a_row("moving", "mouth", k, 0.03 / 2**k, no_order="" if k != 1 else "still <coarse>", values=50) for k in range(2)]
    rows[-1] |= {"verdict": "FAIL", "problems": ["order 0.20 below 0.7"]}
    rows.append(a_row("moving", "mouth", 2, None, failure="a mechanism", verdict="FAILED", values=0, cost=None, order=None))
    return rows


def rows_of(root: Path, rows: list[dict[str, Any]]) -> list[Shown]:
    """The rows as they are read."""
    ladder = load_ladder(write_ladder(root, rows) / "ladder" / "ladder.json", root)
    assert ladder is not None
    return ladder.rows


def main(runs: Path, out: Path) -> int:
    """Make the page from runs; its exit status."""
    return make_page(["--page", "verification", "--runs", str(runs), "--records", str(runs), "--out", str(out), "--strict"])


def page_of(runs: Path, out: Path) -> str:
    """The page made from runs."""
    assert main(runs, out) == 0
    return (out / "verification.html").read_text(encoding="utf-8")


def test_every_comparison_is_listed_with_its_numbers(tmp_path: Path) -> None:
    """A row each, with value, reference, error, order, cost and gate."""
    page = page_of(write_ladder(tmp_path, some_rows()), tmp_path / "out")
    table = page[page.index('class="ladder"') :].split("</table>")[0]
    assert table.count('class="mark ') == 9
    for words in ("2.04", "+2\u00a0%", "1.00", "≥ 0.7", "3\u00a0%", "4.0", "25\u202f600", "40", "−2.0×10⁻⁹", "(0.30)"):
        assert words in table, words
    assert "rms of 50 values" in table and "errors relative to 1\u202f234 m" in table
    assert 'no order <a href="#cracks_1">[1]' in table and 'no order at 1 m <a href="#cracks_2">[2]' in table
    assert '<li id="cracks_1">round-off: symmetric</li><li id="cracks_2">still &lt;coarse&gt;</li>' in page
    assert "It shows at_rest." in table and "About cracks." in page


def test_what_falls_short_is_said_first_and_marked(tmp_path: Path) -> None:
    """Failing and failed rows stand above everything else with their reasons, and are marked in the table."""
    page = page_of(write_ladder(tmp_path, some_rows()), tmp_path / "out")
    assert "Of 9 comparisons with references (2 cases in 1 family), 2 are not as their gates ask." in page
    top = page[: page.index("<figure")]
    assert "cracks / moving: mouth at 1 m FAIL" in top and "order 0.20 below 0.7" in top and "a mechanism" in top
    table = page[page.index('class="ladder"') :]
    assert table.count('class="mark no"') == 2 and ">FAILED<" in table
    assert re.search(r'rowspan="5" class="quantity">mouth', table), "a quantity's cell spans its levels and their reasons"


def test_gates_that_can_be_tightened_are_noted(tmp_path: Path) -> None:
    """A note has a line of its own in the table, and makes nothing red; the tally of mutants is told."""
    rows = some_rows()[:6]
    rows[2] |= {"note": "gate can be tightened (error 0.01, accepted at 0.02): --accept"}
    page = page_of(write_ladder(tmp_path, rows), tmp_path / "out")
    assert "0.5 m: gate can be tightened (error 0.01, accepted at 0.02)" in page
    assert re.search(r'rowspan="4" class="quantity">K_I', page), "its quantity's cell spans it"
    assert 'class="failures"' not in page and 'class="mark no"' not in page and "31 in all: all were refused" in page
    assert "All 6 comparisons with references (1 case in 1 family) are within their gates." in page


def test_gates_that_let_mutants_pass_and_stale_ones_are_told(tmp_path: Path) -> None:
    """The page hides nothing of the gates' own trial."""
    tally = {"gates": 7, "mutants": 31, "refused": 30}
    page = page_of(write_ladder(tmp_path, some_rows(), tally=tally, stale=["cracks/gone / K / 1 m"], part=True), tmp_path / "out")
    assert "1 passed, which makes" in page and "A gate of nothing: cracks/gone" in page and "a part of the ladder only" in page


def test_figures_say_what_the_numbers_say(tmp_path: Path) -> None:
    """Titles come from the rows: other errors, another title."""
    titles = []
    for factor in (1.0, 2.0):
        rows = [row | {"error": row["error"] * factor} for row in some_rows()[:3]]
        titles.append(convergence_figure(rows_of(tmp_path, rows)).title)
    assert titles[0] == "Errors of 1\u00a0% (K_I, at rest) at the finest level; orders 1.0 between the finest two levels"
    assert titles[1].startswith("Errors of 2\u00a0%")
    two = some_rows()[:3] + [row | {"quantity": "J", "no_order": "rings"} for row in some_rows()[:3]]
    assert convergence_figure(rows_of(tmp_path, two)).title == (
        "Errors from 1\u00a0% to 1\u00a0% (K_I, at rest) at the finest level; 1 of 2 are judged by their order, 1.0 between the finest two levels"
    )


def test_round_off_is_not_drawn_but_counted(tmp_path: Path) -> None:
    """A curve at 1e-15 would leave no room for the others."""
    figure = convergence_figure(rows_of(tmp_path, some_rows()))
    assert [(panel.heading, panel.unit) for panel in figure.panels] == [("at rest, without inertia", "m"), ("moving, with inertia", "m")]
    assert [curve.quantity for panel in figure.panels for curve in panel.curves] == ["K_I", "mouth"] and figure.left_out == 1
    assert "1 quantity that holds to round-off" in page_of(tmp_path / "runs", tmp_path / "out")
    assert convergence_figure(rows_of(tmp_path, some_rows()[3:6])) is None
    assert "Everything holds to round-off" in page_of(tmp_path / "runs", tmp_path / "out2")


def test_tables_are_a_click_away_while_all_is_well(tmp_path: Path) -> None:
    """A sentence says so; a family with a row that falls short stands open."""
    rows = [row | {"case": "flight"} for row in some_rows()[3:6]] + some_rows()[:3]
    page = page_of(write_ladder(tmp_path, rows), tmp_path / "out")
    assert "<details><summary>All 6 comparisons are within their gates: the table" in page and page.count('class="mark yes"') == 6
    rows[0] |= {"verdict": "FAIL", "problems": ["error above"]}
    page = page_of(write_ladder(tmp_path, rows), tmp_path / "out")
    assert "<details open><summary>1 of 6 comparisons are not as their gates ask" in page


def test_what_was_accepted_stands_in_until_the_ladder_is_run(tmp_path: Path) -> None:
    """Without ladder.json every gate of the repository is a comparison, and the five of README.md stand on the front page with the errors that they were made of."""
    gates = ROOT / "verification" / "ladder" / "gates"
    kept = load_ladder(tmp_path / "none.json", gates)
    books = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(gates.glob("*.json"))]
    levels = [level for book in books for case in book["cases"].values() for quantity in case.values() for level in quantity.values()]
    assert kept is not None and kept.accepted and [row.error for row in kept.rows] == [level["measured"] for level in levels]
    section = topic(kept)
    assert section is not None and section.shown is not None and len(section.shown.rows) == len(LINES)
    few = tmp_path / "records" / "ladder" / "gates"
    few.mkdir(parents=True)
    (few / "junction.json").write_text((gates / "junction.json").read_text(encoding="utf-8"), encoding="utf-8")
    assert make_page(["--page", "verification", "--runs", str(tmp_path), "--records", str(tmp_path / "records"), "--out", str(tmp_path / "out"), "--strict"]) == 0
    page = (tmp_path / "out" / "verification.html").read_text(encoding="utf-8")
    assert "the errors that were last accepted" in page and "has not been run" not in page and "<th>Value</th>" not in page


def test_nothing_run_and_nothing_kept_is_no_page(tmp_path: Path) -> None:
    """Without a ladder and gates there is no page."""
    assert main(tmp_path, tmp_path / "out") == 1
    assert not (tmp_path / "out" / "verification.html").exists()


@pytest.mark.parametrize("content", ['{"rows": [', '{"rows": [{}]}', "{}"])
def test_a_torn_judgement_is_a_defect(tmp_path: Path, content: str, capsys: pytest.CaptureFixture[str]) -> None:
    """It is told, with the exit status."""
    runs = write_ladder(tmp_path, [])
    (runs / "ladder" / "ladder.json").write_text(content, encoding="utf-8")
    assert main(runs, tmp_path / "out") == 1
    assert "could not be read" in capsys.readouterr().err


def test_relative_errors_in_words() -> None:
    """Per cent, and powers of ten where these would be all zeros."""
    assert [relative(error) for error in (0.0123, -0.0123, 2.5e-5, 3.2e-9, -1e-15, 0.0)] == [
        "1.2\u00a0%", "−1.2\u00a0%", "0.0025\u00a0%", "3.2×10⁻⁹", "−1.0×10⁻¹⁵", "0",
    ]
    assert relative(0.0123, signed=True) == "+1.2\u00a0%" and relative(float("nan")) == "–"


def test_labels_that_would_overlap_are_moved_apart() -> None:
    """By no more than a gap, and about where they were."""
    assert spread_apart([0.1, 0.5], 0.05) == [0.1, 0.5] and spread_apart([], 0.05) == []
    moved = spread_apart([0.05, 0.30, 0.31, 0.31, 0.9], 0.05)
    assert [moved[0], moved[4]] == pytest.approx([0.05, 0.9]), "what is far off stays"
    assert moved[2] - moved[1] == pytest.approx(0.05) and moved[3] - moved[2] == pytest.approx(0.05)
    assert sum(moved[1:4]) == pytest.approx(0.92)
    assert spread_apart([0.2, 0.24, 0.26], 0.05) == pytest.approx([0.7 / 3 - 0.05, 0.7 / 3, 0.7 / 3 + 0.05])
