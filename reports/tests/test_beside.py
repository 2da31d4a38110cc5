"""Pages beside that of the experiments: the stability atlas and the work-precision chart, from data that are there, wrong, and not there."""

import html
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from reports import precision, stability
from reports.make_page import main
from reports.page import topics
from verification.precision.problem import FAILED, OK, REFUSED, Found, Point, Problem, Sheet, read_sheet, write_sheet
from verification.precision.problems import PROBLEMS
from verification.stability import runner as atlas
from verification.stability.family import GARBAGE


@pytest.mark.parametrize("name", ["stability", "verification"])
def test_without_data_the_reason_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    """A page alone, of an empty folder: status 1, how to fill it, no page."""
    assert main(["--page", name, *(word for one in ("stability", "runs", "records", "out") for word in (f"--{one}", str(tmp_path / one)))]) == 1
    told = capsys.readouterr()
    assert told.out == "" and f"{name}.html: " in told.err
    assert ("ci/" in told.err or name == "verification") and not (tmp_path / "out" / f"{name}.html").exists()


# --- the stability atlas


def test_the_page_shows_every_walk_with_its_edge(tmp_path: Path) -> None:
    """Every family's title, a figure a section, and no word of garbage but the one that explains it."""
    front = stability.write_stability(tmp_path)
    text = html.unescape((tmp_path / stability.NAME).read_text(encoding="utf-8"))
    every = stability.parts()
    assert not front.lack and front.name == stability.NAME and "all as they are to be" in front.words
    for part in every:
        assert f'id="{part.anchor}"' in text and (tmp_path / "figures" / f"stability_{part.anchor}.svg").is_file()
        assert "no garbage" in stability.finding(part)
        assert all(walk.family.title in text for walk in part.walks)
    assert 'class="failures"' not in text


def test_garbage_and_a_wrong_edge_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A record with garbage in it, and one whose edge is 5 % off, are said to be wrong in the headline, the table and the section."""
    records = tmp_path / "records"
    shutil.copytree(atlas.RECORDS, records)
    step, flow = atlas.read("step_bspline2_total_4"), atlas.read("flow_explicit")
    assert step is not None and flow is not None and step.edge is not None and step.edge.predicted is not None
    atlas.write(replace(step, edge=replace(step.edge, measured=1.05 * step.edge.predicted)), records)
    atlas.write(replace(flow, points=(replace(flow.points[0], outcome=GARBAGE), *flow.points[1:])), records)
    every = stability.parts(records)
    assert "2 walks are NOT as they are to be" in stability.headline(every)
    monkeypatch.setattr(stability, "figures_of", lambda part: [])  # are drawn in the test above
    assert not stability.write_stability(tmp_path, records).defect
    text = (tmp_path / stability.NAME).read_text(encoding="utf-8")
    assert text.count('class="failures"') == 3 and "+5.0 % off what theory says" in text
    assert "1 POINTS ARE GARBAGE" in "".join(map(stability.finding, every))


def test_a_torn_record_is_told(tmp_path: Path) -> None:
    """Not raised."""
    (tmp_path / "torn").mkdir()
    (tmp_path / "torn" / "flow_explicit.json").write_text("{", encoding="utf-8")
    front = stability.write_stability(tmp_path, tmp_path / "torn")
    assert "could not be shown" in front.lack and front.defect


# --- the work-precision chart

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
        write_sheet(made_up(problem), tmp_path / "data")
    return tmp_path / "data"


def test_the_chart_has_every_quantity_and_the_table(data: Path) -> None:
    """Nothing that was measured is missing from the section."""
    section = precision.topic(data)
    assert section is not None and section.figure is not None and section.version == "0"
    titles = [one.title for problem in PROBLEMS for one in problem.wanted]
    assert list(dict.fromkeys(row[0] for row in section.tables[0].rows)) == titles == [panel.heading for panel in section.figure.data.panels]
    assert "a processor" in str(section.tables[2].rows) and "median of five runs" in str(section.tables[2].rows)
    assert {row[3] for row in section.tables[1].rows} == {FAILED, REFUSED} and {row[0] for row in section.tables[1].rows} == set(titles)


def test_torn_data_cost_the_chart_alone(data: Path, tmp_path: Path) -> None:
    """A file that cannot be read is told, and the other sections are there."""
    (data / "block.json").write_text("{", encoding="utf-8")
    (only,) = topics(tmp_path / "no.json", data, tmp_path / "none")
    assert "block.json" in only.lack and only.defect


def test_odd_measurements_are_told(data: Path) -> None:
    """Disturbed and single runs, and problems that are not there."""
    sheet = read_sheet("block", data)
    assert sheet is not None
    write_sheet(replace(sheet, points=(replace(sheet.points[0], disturbed=True, once=True), *sheet.points[1:])), data)
    (data / "soft.json").unlink()
    found = precision.measurements(data)
    assert found is not None
    assert any("1 of" in note and "disturbed" in note for note in found.notes) and any("single run" in note for note in found.notes)
    assert any("not measured: soft" in note for note in found.notes)


def test_what_is_drawn_is_what_is_judged(data: Path) -> None:
    """Every dot and every failure is drawn, and the front falls."""
    found = precision.measurements(data)
    assert found is not None
    for panel in found.panels:
        shown = precision.panel_shown(panel)
        assert len(shown.lacks) == len(panel.lacks) > 0 and "failed" in shown.lacks_words and "refused" in shown.lacks_words
        assert sum(len(curve.times_s) for curve in shown.curves) == len(panel.dots)
        assert list(shown.front[1]) == sorted(shown.front[1], reverse=True) and list(shown.front[0]) == sorted(shown.front[0])
    assert precision.front_figure(found.panels).title == precision.finding(found.panels)


def test_the_table_says_where_none_reaches(tmp_path: Path) -> None:
    """A tolerance that no method reaches has no advice."""
    write_sheet(made_up(PROBLEMS[0], error=3.0), tmp_path)
    found = precision.measurements(tmp_path)
    assert found is not None
    row = precision.table_of(found.panels)[0]
    assert all("none reaches it; best" in cell for cell in row[2:])
    assert precision.finding(found.panels).startswith("No quantity")


def test_recommendations_come_from_the_data(data: Path) -> None:
    """A sentence for each group of experiments, with what the scenes ask for."""
    found = precision.measurements(data)
    assert found is not None
    words = precision.recommendations(found.panels)
    assert len(words) == 2 and words[0].startswith("Experiments 1, 2, 3 and 4:") and words[1].startswith("Experiments 5 and 6:")
    own = ("explicit, total, graded", "explicit, total")
    assert all(f"The scenes' own setting, with inertia ({setting}, 1 m)" in line for setting, line in zip(own, words))
