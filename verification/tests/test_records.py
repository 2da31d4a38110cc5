"""What all lists of cases share: records as JSON, choosing by name, tables, options; every command says how it is used, and refuses what it cannot do with
status 2 and a word on what there is."""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from verification.ablation.__main__ import ablate, budget
from verification.benchmarks.__main__ import main as bench
from verification.crossing_map.__main__ import main as crossing
from verification.faults.__main__ import main as kill
from verification.harness import campaign, claims, front_table, refine, smoke, store, sweep
from verification.harness.command import aligned, beginnings, choose, command, count, folder_name, number, twice
from verification.harness.run import claimed
from verification.ladder.__main__ import main as verify
from verification.measured.__main__ import main as beside
from verification.precision.__main__ import main as chart
from verification.stability.__main__ import main as atlas
from verification.tests.cases import SCENES


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


COMMANDS: dict[str, Callable[[list[str]], int]] = {
    "ablate": ablate, "accept": smoke.main, "atlas": atlas, "beside": beside, "bench": bench, "budget": budget, "chart": chart, "claims": claims.main,
    "crossing_map": crossing, "front_table": front_table.main, "kill": kill, "refine": refine.main, "reproduce": campaign.main, "sweep": sweep.main, "verify": verify,
}  # fmt: skip


def exit_of(name: str, *arguments: str) -> int:
    try:
        return COMMANDS[name](list(arguments))
    except SystemExit as how:
        return int(how.code or 0)


@pytest.mark.parametrize("name", COMMANDS)
def test_it_says_how_it_is_used(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_of(name, "--help") == 0
    said = capsys.readouterr().out
    assert said.startswith("usage: ") and len(said.splitlines()) > 5
    assert exit_of(name, "--no-such-option") == 2


@pytest.mark.parametrize(("name", "arguments", "said"), [
    ("ablate", ["exp9"], "no experiment begins with exp9"), ("ablate", ["exp1", "--ingredients", "flaw"], "no flaw to change; there are"),
    ("ablate", ["exp1", "--variants", "soft", "--set", "numerics.cell_m=3.0"], "does not divide the block"),
    ("budget", ["exp1", "--factors", "mash"], "no mash to change; there are"), ("budget", ["exp1", "--variants", "week"], "has no variant week"),
    ("refine", ["exp"], "several experiments"), ("refine", ["exp9"], "no experiment begins"), ("refine", ["no.toml"], "there is no file"),
    ("refine", ["exp1", "--cells", "1,x"], "--cells 1,x"), ("refine", ["exp1", "--cells", "1,-2"], "sizes are positive"),
    ("refine", ["exp1", "--variants", "week"], "has no variant week"), ("refine", ["exp1", "--variants", "undamped"], "runs in quasistatic"),
    ("reproduce", ["--only", "exp9"], "no experiment begins with exp9; there are"),
    ("verify", ["--family", "craks"], "no family craks; there are"), ("verify", ["--case", "nobody"], "no case nobody"), ("verify", ["--jobs", "0"], "--jobs 0"),
    ("atlas", ["--family", "nobody"], "no family nobody; there are"), ("atlas", ["--smoke", "--accept", "--family", "rings"], "without --smoke"),
    ("chart", ["--only", "blok"], "no problem blok; there are block"), ("chart", ["--methods", "qx"], "no method qx; there are"),
    ("crossing_map", ["--family", "nobody"], "no map nobody; there are"), ("crossing_map", ["--size", "1"], "--size 1 is below 2"),
    ("sweep", ["no.toml"], "no.toml"), ("sweep", [str(SCENES / "sweep.toml"), "--observe", "json:dumpz"], "--observe json:dumpz"),
    ("bench", ["--only", "("], "ci/bench: "), ("bench", ["--quick", "--record"], "--quick goes with neither"),
])  # fmt: skip
def test_what_it_cannot_do_is_refused_by_name(name: str, arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_of(name, *arguments) == 2
    assert said in capsys.readouterr().err
