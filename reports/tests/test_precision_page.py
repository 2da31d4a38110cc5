"""The work-precision chart on the page: drawn from data alone, failures kept, and told how to make it where there are none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from reports.precision import (finding, front_figure, lack_rows, measurements, panel_shown, point_rows, recommendations, table_of, write_precision)
from verification.precision import store
from verification.precision.problem import Problem
from verification.precision.problems import PROBLEMS
from verification.precision.store import FAILED, OK, REFUSED, Found, Point, Sheet

MACHINE = {
    "processor": "a processor", "cores": 2, "caches": "L1 1K", "memory_GB": 8.0, "system": "a system", "compiler": "a compiler",
    "flags": "-O3", "version": "0", "revision": "abc",
}


def made_up(problem: Problem, error: float = 0.02) -> Sheet:
    """Every method of a problem, off by an error that falls with its size; the second one failed, the third was refused."""
    points = []
    for k, method in enumerate(problem.methods):
        status = {1: FAILED, 2: REFUSED}.get(k, OK)
        for level in method.levels:
            off = error * (1.0 + k) * level.size
            found = {one.name: Found(4.0 * (1.0 + off), 4.0, off) for one in problem.wanted}
            points.append(Point(method.name, level.label, level.size, "key", status, "" if status == OK else "it broke",
                                (1.0 / level.size + k,) * 3, (1.0 / level.size,) * 3, "2026-01-01 00:00:00", particles=1000,
                                found=found if status == OK else {}))
    return Sheet(problem.name, MACHINE, tuple(points))


@pytest.fixture()
def data(tmp_path: Path) -> Path:
    """Data of all problems."""
    for problem in PROBLEMS:
        store.write(made_up(problem), tmp_path / "data")
    return tmp_path / "data"


def test_the_page_has_every_quantity_every_failure_and_the_table(data: Path, tmp_path: Path) -> None:
    """Nothing that was measured is missing from the page of all settings."""
    front = write_precision(tmp_path / "out", data)
    assert not front.lack and front.figure is not None
    assert [row["title"] for row in front.rows if row["first"]] == [one.title for problem in PROBLEMS for one in problem.wanted]
    text = (tmp_path / "out" / "precision.html").read_text(encoding="utf-8")
    for problem in PROBLEMS:
        for one in problem.wanted:
            assert (tmp_path / "out" / "figures" / f"precision_{one.name}.svg").is_file()
            assert one.title in text
    assert text.count("it broke") == 2 * sum(len(problem.wanted) for problem in PROBLEMS)
    assert "a processor" in text and "median of five runs" in text


def test_without_data_the_page_says_how_to_make_them(tmp_path: Path) -> None:
    """No data is no defect."""
    front = write_precision(tmp_path / "out", tmp_path / "nothing")
    assert "ci/chart" in front.lack and not front.defect


def test_torn_data_cost_the_chart_alone(data: Path, tmp_path: Path) -> None:
    """A file that cannot be read is told."""
    (data / "block.json").write_text("{", encoding="utf-8")
    front = write_precision(tmp_path / "out", data)
    assert "block.json" in front.lack and front.defect


def test_odd_measurements_are_told(data: Path) -> None:
    """Disturbed and single runs, and problems that are not there."""
    sheet = store.read("block", data)
    assert sheet is not None
    store.write(replace(sheet, points=(replace(sheet.points[0], disturbed=True, once=True), *sheet.points[1:])), data)
    (data / "soft.json").unlink()
    found = measurements(data)
    assert found is not None
    assert any("1 of" in note and "disturbed" in note for note in found.notes) and any("single run" in note for note in found.notes)
    assert any("not measured: soft" in note for note in found.notes)


def test_what_is_drawn_is_what_is_judged(data: Path) -> None:
    """Every dot and every failure is drawn, and the front falls."""
    found = measurements(data)
    assert found is not None
    for panel in found.panels:
        shown = panel_shown(panel)
        assert len(shown.lacks) == len(panel.lacks) > 0 and "failed" in shown.lacks_words and "refused" in shown.lacks_words
        assert sum(len(curve.times_s) for curve in shown.curves) == len(panel.dots) == len(point_rows(panel))
        assert list(shown.front[1]) == sorted(shown.front[1], reverse=True) and list(shown.front[0]) == sorted(shown.front[0])
        assert {row[2] for row in lack_rows(panel)} >= {FAILED, REFUSED}
    assert front_figure(found.panels).title == finding(found.panels)


def test_the_table_says_where_none_reaches(tmp_path: Path) -> None:
    """A tolerance that no method reaches has no advice."""
    store.write(made_up(PROBLEMS[0], error=3.0), tmp_path)
    found = measurements(tmp_path)
    assert found is not None
    row = table_of(found.panels)[0]
    assert not any(cell["ok"] for cell in row["cells"])  # type: ignore[index, attr-defined]
    assert "none reaches it; best" in row["cells"][0]["words"]  # type: ignore[index]
    assert finding(found.panels).startswith("No quantity")


def test_recommendations_come_from_the_data(data: Path) -> None:
    """A sentence for each group of experiments, with what the scenes ask for."""
    found = measurements(data)
    assert found is not None
    words = recommendations(found.panels)
    assert len(words) == 2 and words[0].startswith("Experiments 1, 2, 3 and 4:") and words[1].startswith("Experiments 5 and 6:")
    own = ("explicit, total, graded", "explicit, total")
    assert all(f"The scenes' own setting ({setting}, 1 m)" in line for setting, line in zip(own, words))
