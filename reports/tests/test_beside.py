"""Pages and sections beside those of the experiments: the stability atlas and the work-precision chart, from data that are there, wrong, and not there; what each
experiment needs; beside measurements; the gallery's pictures and rows. Animations show what the runs hold, a frame an output time, and say so in words."""

import html
import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from reports import kept, stability
from reports.kept import ablation_figure, beside_topic, needs_topic, wu_fronts
from reports.animation import animations, chosen, largest_principal, main as animate, movie
from reports.charts.animation import write_animation
from reports.charts.records import draw_gallery
from reports.charts.style import save
from reports.gallery import row, shown
from reports.make_page import main
from reports.page import topics
from reports.runs import load_run, load_runs
from reports.tests.synthetic import OUTPUTS, Plan, write_run
from reports.words import Shown
from verification.ablation.table import RECORDS, read_all
from verification.gallery import FOLDER, SCENES, Scene
from verification.harness import store
from verification.measured import rubin
from verification.precision.problem import FAILED, OK, REFUSED, Found, Point, Problem, Sheet, read_sheet, write_sheet
from verification.precision.problems import PROBLEMS
from verification.stability import runner as atlas
from verification.stability.family import GARBAGE
from verification.tests.cases import completed


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
    section = kept.chart_topic(data)
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
    found = kept.measurements(data)
    assert found is not None
    assert any("1 of" in note and "disturbed" in note for note in found.notes) and any("single run" in note for note in found.notes)
    assert any("not measured: soft" in note for note in found.notes)


def test_what_is_drawn_is_what_is_judged(data: Path) -> None:
    """Every dot and every failure is drawn, and the front falls."""
    found = kept.measurements(data)
    assert found is not None
    for panel in found.panels:
        shown = kept.panel_shown(panel)
        assert len(shown.lacks) == len(panel.lacks) > 0 and "failed" in shown.lacks_words and "refused" in shown.lacks_words
        assert sum(len(curve.times_s) for curve in shown.curves) == len(panel.dots)
        assert list(shown.front[1]) == sorted(shown.front[1], reverse=True) and list(shown.front[0]) == sorted(shown.front[0])
    assert kept.front_figure(found.panels).title == kept.chart_finding(found.panels)


def test_the_table_says_where_none_reaches(tmp_path: Path) -> None:
    """A tolerance that no method reaches has no advice."""
    write_sheet(made_up(PROBLEMS[0], error=3.0), tmp_path)
    found = kept.measurements(tmp_path)
    assert found is not None
    row = kept.chart_table(found.panels)[0]
    assert all("none reaches it; best" in cell for cell in row[2:])
    assert kept.chart_finding(found.panels).startswith("No quantity")


def test_recommendations_come_from_the_data(data: Path) -> None:
    """A sentence for each group of experiments, with what the scenes ask for."""
    found = kept.measurements(data)
    assert found is not None
    words = kept.recommendations(found.panels)
    assert len(words) == 2 and words[0].startswith("Experiments 1, 2, 3 and 4:") and words[1].startswith("Experiments 5 and 6:")
    own = ("explicit, total, graded", "explicit, total")
    assert all(f"The scenes' own setting, with inertia ({setting}, 1 m)" in line for setting, line in zip(own, words))


def test_the_section_has_a_column_a_scene_and_what_each_needs(tmp_path: Path) -> None:
    """The chart has a column for each whole table, the table a row for each; without records there is no section."""
    kept, found = read_all(RECORDS), needs_topic(RECORDS)
    assert found is not None and needs_topic(tmp_path) is None and len(found.tables[0].rows) == len(kept) > 6
    assert len(ablation_figure(kept).columns) == sum(one.extent != "interfaces" for one in kept)
    needed = [one for one in kept if one.needs()]
    assert needed and needed[0].needs()[0].label in str(found.tables[0].rows[kept.index(needed[0])][1])


def test_the_section_has_points_curves_and_a_row_a_run(tmp_path: Path) -> None:
    """Twelve points a panel, a curve for each run that is drawn, a row a result and one of GEOS; the finding follows the record."""
    kept, section = rubin.kept(), beside_topic(rubin.RECORD)
    assert kept is not None and section is not None and section.figure is not None and beside_topic(tmp_path / "none.json") is None
    data, table = section.figure.data, section.tables[0]
    assert [len(panel.points) for panel in data.panels] == [12, 12, 12] and all(len(panel.curves) == 3 for panel in data.panels)
    assert len(table.rows) == len(kept.results) + 1 and table.rows[-1][0] == "GEOS"
    plain = kept.results[-2]
    worse = replace(plain, errors=plain.errors | {rubin.LENGTH: replace(plain.errors[rubin.LENGTH], late=0.5)})
    store.write(replace(kept, results=(*kept.results[:-2], worse, kept.results[-1])), tmp_path / "rubin.json")
    assert "length 50\u00a0%" in beside_topic(tmp_path / "rubin.json").says[0] and "length 50\u00a0%" not in section.says[0]


def test_wu_s_fronts_go_on_where_the_stress_is_less() -> None:
    """Four fronts in the order of time: as verification/measured/README.md has them."""
    found = wu_fronts()
    assert [round(one.bottom_mm) for one in found] == [-46, -95, -133, -164] and all(one.up_Pa - one.down_Pa > 2.0e6 for one in found)


@pytest.mark.smoke
@pytest.mark.parametrize("scene", SCENES, ids=[scene.name for scene in SCENES])
def test_a_scene_has_its_picture_and_its_row(tmp_path: Path, scene: Scene) -> None:
    """A source and a run of finite values over the same range; the row tells the expected number before the one that was got."""
    runs = [completed(FOLDER / f"{scene.name}.toml", variant) for variant in ("", *scene.variants)]
    data = shown(scene.name, runs)
    assert [curve[1] for curve in data.curves] == ["source", "run", "other"][: len(data.curves)] and len(data.curves) > len(scene.variants) + 1
    assert all(len(x) == len(y) > 1 and np.isfinite(x).all() and np.isfinite(y).all() for _, _, x, y, _ in data.curves)
    (source, run) = (y for _, _, _, y, _ in data.curves[:2])
    assert 0.6 < np.ptp(run) / np.ptp(source) < 1.6 or scene.name == "shut_in"  # which begins with the pressure that breaks its first metre
    save(draw_gallery(data), tmp_path / f"{scene.name}.svg")
    assert (tmp_path / f"{scene.name}.svg").stat().st_size < 60_000
    got, expected = scene.pair(runs[0])
    assert f"{scene.number}: {scene.told(expected)} ({scene.source}) | {scene.told(got)}, " in row(scene, runs[0], 1.0)


SOFT = Plan("soft", ("soft",), stop_at_m=10.0, restart_Pa=3.2e6)


def test_principal_stress_by_hand() -> None:
    """Mohr's circle: uniaxial tension 3, pure shear 2, and (1, -1) with shear 0 on any axes."""
    cases = [((3.0, 0.0, 0.0), 3.0), ((0.0, 0.0, 2.0), 2.0), ((0.0, 0.0, -2.0), 2.0), ((-5.0, -3.0, 0.0), -3.0), ((6.0, 0.0, 4.0), 8.0)]
    points = {name: np.array([stress[k] for stress, _ in cases]) for k, name in enumerate(("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"))}
    assert largest_principal(points) == pytest.approx([expected for _, expected in cases])


def test_frames_are_the_output_times(tmp_path: Path) -> None:
    """Time, pressure, opening and stress of each are those of the made-up fields."""
    data = movie(load_run(write_run(tmp_path, 1, SOFT)))
    assert len(data.frames) == OUTPUTS and data.frames[0].height_m == 5.0
    assert [frame.time_s for frame in data.frames] == sorted(frame.time_s for frame in data.frames)
    for frame in data.frames:
        # By the made-up field: the pressure falls to half the inlet's at the tip, the opening is 0.1 mm sqrt(h^2 - s^2).
        assert frame.pressure_MPa[0] == pytest.approx(frame.inlet_MPa) and frame.pressure_MPa[-1] == pytest.approx(0.5 * frame.inlet_MPa)
        assert frame.opening_mm[0] == pytest.approx(0.1 * frame.height_m)
        row, column = np.unravel_index(np.argmax(frame.stress_MPa), frame.stress_MPa.shape)
        assert abs((row + 0.5) * 80 / 120 - frame.height_m) < 1.5 and abs((column + 0.5) * 80 / 120 - 40.0) < 1.5, "largest at the tip; points are 1 m apart"
    last = f"{data.frames[-1].height_m:.0f} m"
    assert last in data.caption and last in data.alt and "interface at 10 m" in data.alt


def test_the_soft_interface_without_inertia_comes_first(tmp_path: Path) -> None:
    """One run an experiment."""
    for number, plan in ((1, SOFT), (1, Plan("soft", ("soft",), mechanics="quasistatic")), (1, Plan("weak", ("weak",))), (3, Plan("weak_soft", ("weak", "soft")))):
        write_run(tmp_path, number, plan)
    assert [(run.number, run.variant, run.mechanics) for run in chosen(load_runs(tmp_path))] == [(1, "soft", "quasistatic"), (3, "weak_soft", "explicit")]


def test_a_gif_moves_and_its_words_stand_beside_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """First and last frame differ; a run that cannot be read is told and left out."""
    write_run(tmp_path, 1, SOFT)
    (write_run(tmp_path, 2, SOFT) / "result.h5").write_bytes(b"torn")
    assert animate(["--runs", str(tmp_path), "--out", str(tmp_path / "out")]) == 0
    assert "no animation of exp2_soft_above/soft: " in capsys.readouterr().err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["exp1_single_interface.gif", "exp1_single_interface.json"]
    with Image.open(tmp_path / "out" / "exp1_single_interface.gif") as picture:
        assert picture.n_frames == OUTPUTS
        first = np.asarray(picture.convert("RGB"))
        picture.seek(OUTPUTS - 1)
        assert np.mean(np.any(first != np.asarray(picture.convert("RGB")), axis=-1)) > 0.01
    assert (tmp_path / "out" / "exp1_single_interface.gif").stat().st_size < 1e6
    assert set(json.loads((tmp_path / "out" / "exp1_single_interface.json").read_text())) == {"caption", "alt"}


@pytest.mark.parametrize("name", ["stress_MPa", "pressure_MPa", "opening_mm", "y_m", "height_m", "time_s"])
def test_whatever_changes_is_seen(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames that differ in one thing are two pictures; equal ones are one."""
    monkeypatch.setattr("reports.charts.animation.HOLD", 0)
    data = movie(load_run(write_run(tmp_path, 1, SOFT)))
    first = data.frames[4]
    for shift, pictures in ((0.0, 1), (1.0, 2)):
        data.frames = [first, Shown(**{**vars(first), name: getattr(first, name) + shift})]
        with Image.open(write_animation(data, tmp_path / "two.gif")) as picture:
            assert picture.n_frames == pictures


def test_nothing_to_animate_is_said(tmp_path: Path) -> None:
    """By the exit status."""
    assert animations([], tmp_path / "out") == [] and animate(["--runs", str(tmp_path), "--out", str(tmp_path / "out")]) == 1
