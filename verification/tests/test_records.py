"""What all lists of cases share: records as JSON, choosing by name, tables, options."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from verification.harness import store
from verification.harness.choose import beginnings, choose, claimed, folder_name, twice
from verification.harness.command import aligned, command, count, number


@dataclass(frozen=True)
class Inner:
    """A number of a record."""

    value: float
    words: str = ""


@dataclass(frozen=True)
class Outer:
    """A record of all shapes that are kept."""

    name: str
    edge: Inner | None
    points: tuple[Inner, ...]
    named: Mapping[str, Inner]
    pair: tuple[str, float] = ("", 0.0)
    plain: dict[str, float] = field(default_factory=dict)
    size: float | None = None


RECORD = Outer("a", Inner(1.5), (Inner(math.nan, "none"), Inner(2.0)), {"x": Inner(math.inf)}, ("b", 3.0), {"y": 1.0 / 3.0})


def test_a_record_is_read_as_it_was_written(tmp_path: Path) -> None:
    """Nested dataclasses, tuples and tables come back; what is not finite comes back as NaN."""
    back = store.read(Outer, store.write(RECORD, tmp_path / "new" / "a.json", ("edge", "points")))
    assert back is not None and math.isnan(back.points[0].value) and math.isnan(back.named["x"].value)
    assert (back.edge, back.points[1], back.pair, back.plain, back.size) == (RECORD.edge, Inner(2.0), ("b", 3.0), RECORD.plain, None)
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["a.json"]


def test_a_record_has_an_item_a_line(tmp_path: Path) -> None:
    """So that a change of one point is one line of difference; digits are as asked. Else what fits stands on a line, what does not has one an item."""
    path = store.write(RECORD, tmp_path / "a.json", ("edge", "points"), digits=3)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[:5] == ["{", ' "name": "a",', ' "edge": {"value": 1.5, "words": ""},', ' "points": [', '  {"value": null, "words": "none"},']
    assert ' "plain": {"y": 0.333},' in lines and lines[-1] == "}"
    long = {"a": [], "b": {"c": [{"d": "x" * store.WIDTH}, {"e": [1.0, {}]}]}}
    told = store.text_of(long)
    assert store.text_of(long, ("c",)) == told, "of the record itself, not of what is in it"
    assert json.loads(told) == long and told.splitlines()[:3] == ["{", ' "a": [],', ' "b": {'] and '   {"e": [1.0, {}]}' in told.splitlines()


@pytest.mark.parametrize("broken", ["{", "[]", '{"name": "a"}', '{"name": "a", "edge": 1, "points": [], "named": {}}',
                                    '{"name": "a", "edge": null, "points": [], "named": {}, "more": 1}'])  # fmt: skip
def test_a_broken_record_is_named(tmp_path: Path, broken: str) -> None:
    """A file of another shape is a ValueError with its path; one that is not there is None."""
    path = tmp_path / "broken.json"
    assert store.read(Outer, path) is None
    path.write_text(broken, encoding="utf-8")
    with pytest.raises(ValueError, match="broken.json"):
        store.read(Outer, path)


def test_names_are_chosen_by_their_beginnings(tmp_path: Path) -> None:
    """All without any; one that nothing begins with is named, with what there is."""
    known = {"tip": 1, "tip_near": 2, "edge": 3}
    assert choose(known, ()) == known
    assert choose(known, beginnings("tip,,e")) == known and list(choose(known, ["tip_"])) == ["tip_near"]
    with pytest.raises(ValueError, match="no case x; there are tip, tip_near, edge"):
        choose(known, ["x", "tip"], "case")
    assert twice(["a", "b", "a"]) == ["a"] and folder_name("0.5 m, 1e+3/x=-2") == "0.5_m__1e+3_x=-2"
    with claimed(tmp_path / "runs" / "a"):  # the lock stands beside the folder, which the run may empty
        assert [path.name for path in (tmp_path / "runs").iterdir()] == ["a.lock"]


def test_tables_and_options() -> None:
    """Numbers right, words left, nothing after the last column; a command takes the shared options that it names, with its own defaults."""
    table = aligned([("name", "size", "why"), ("a", "1.25", "long words"), ("bcd", "10", "")], right=(1,))
    assert table == ["name  size  why", "a     1.25  long words", "bcd     10"]
    assert (number(1.0 / 3.0), number(math.nan), count(12345), count(2.5e6), count(12)) == ("0.333333", "-", "12.3k", "2.5M", "12")
    options = command("x", "About.", "family", "smoke", "runs", runs=Path("here")).parse_args(["--family", "a,b"])
    assert (options.family, options.smoke, options.runs) == ("a,b", False, Path("here"))
    with pytest.raises(SystemExit):
        command("x", "About.", "family").parse_args(["--jobs", "2"])
