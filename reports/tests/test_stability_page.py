"""The page of the stability atlas: what it shows of records that are there, that are wrong, and that are not there."""

from __future__ import annotations

import html
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from reports import stability
from reports.stability import NAME, finding, headline, parts, write_stability
from verification.stability import store
from verification.stability.family import GARBAGE


def test_the_page_shows_every_walk_with_its_edge(tmp_path: Path) -> None:
    """Every family's title, a figure a section, and no word of garbage but the one that explains it."""
    front = write_stability(tmp_path)
    text = html.unescape((tmp_path / NAME).read_text(encoding="utf-8"))
    every = parts()
    assert not front.lack and front.link == NAME and "all as they are to be" in front.words
    for part in every:
        assert f'id="{part.anchor}"' in text and (tmp_path / "figures" / f"stability_{part.anchor}.svg").is_file()
        assert "no garbage" in finding(part)
        assert all(walk.family.title in text for walk in part.walks)
    assert 'class="failures"' not in text


def test_garbage_and_a_wrong_edge_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A record with garbage in it, and one whose edge is 5 % off, are said to be wrong in the headline, the table and the section."""
    records = tmp_path / "records"
    shutil.copytree(store.RECORDS, records)
    step, flow = store.read("step_bspline2_total_4"), store.read("flow_explicit")
    assert step is not None and flow is not None and step.edge is not None and step.edge.predicted is not None
    store.write(replace(step, edge=replace(step.edge, measured=1.05 * step.edge.predicted)), records)
    store.write(replace(flow, points=(replace(flow.points[0], outcome=GARBAGE), *flow.points[1:])), records)
    every = parts(records)
    assert "2 walks are NOT as they are to be" in headline(every)
    monkeypatch.setattr(stability, "figures_of", lambda part: [])  # are drawn in the test above
    assert not write_stability(tmp_path, records).defect
    text = (tmp_path / NAME).read_text(encoding="utf-8")
    assert text.count('class="failures"') == 2 and "+5.0 % off what theory says" in text and "1 POINTS ARE GARBAGE" in "".join(map(finding, every))


def test_without_records_the_page_says_how_to_make_them(tmp_path: Path) -> None:
    """No record, and one that is torn."""
    assert "ci/atlas" in write_stability(tmp_path, tmp_path / "none").lack
    (tmp_path / "torn").mkdir()
    (tmp_path / "torn" / "flow_explicit.json").write_text("{", encoding="utf-8")
    front = write_stability(tmp_path, tmp_path / "torn")
    assert "could not be shown" in front.lack and front.defect
