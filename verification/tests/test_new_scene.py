"""`strata new`: a scene to start from that is sound, shows something, and says of each key what `strata keys` says."""

import os
import re
from pathlib import Path

import pytest

from verification.tests.cases import strata, summary_of


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    done = strata(tmp_path, "new", "begun")
    assert (done.returncode, done.stdout, done.stderr, [path.name for path in tmp_path.iterdir()]) == (0, "", "", ["begun.toml"])
    return tmp_path / "begun.toml"


def test_it_runs_at_once_and_its_interface_holds_the_fracture(scene: Path) -> None:
    """Base and variants pass; the base arrests at the interface, in its half of the cells, and goes on, where friction lets it pass; the run takes less than a second of a processor."""
    assert strata(scene.parent, "check", scene).returncode == 0
    assert set(strata(scene.parent, "variants", scene).stdout.split()) == {"clay", "joint"}
    before = os.times()
    assert strata(scene.parent, "run", scene, "--out", "X", "--quiet", "--threads", "1").returncode == 0
    after = os.times()
    assert after.children_user + after.children_system - before.children_user - before.children_system < 1.0
    events = {event["kind"]: event for event in summary_of(scene.parent / "X")["events"]}
    assert strata(scene.parent, "run", scene, "--variant", "joint", "--out", "Y", "--quiet").returncode == 0
    assert "arrest" not in {event["kind"] for event in summary_of(scene.parent / "Y")["events"]}
    assert {"start", "reach_interface", "arrest", "restart", "stop"} <= events.keys() and abs(events["arrest"]["tip_y_m"] - 10.0) < 0.5


def test_alternatives_in_comments_are_sound(scene: Path) -> None:
    """Each line that stands as a comment passes `check` where it is said to belong."""
    text = scene.read_text()
    fed = text.replace('law = "uniform"', 'law = "reynolds"').replace("start_Pa = 2", "# start_Pa = 2").replace("rate_Pa_s = 0", "# rate_Pa_s = 0").replace("inlet_Pa = 4.5e6", "")
    for key, of in {"leakoff_m_sqrt_s": fed, "viscosity_Pa_s": fed, "rate_m2_s": fed, "time_s": text, "damping_1_s": text.replace('"quasistatic"', '"explicit"')}.items():
        other = re.sub(r"^# ((rate_m2_s|%s) = )" % key if of is fed else r"^# (%s = )" % key, r"\1", of, flags=re.MULTILINE)
        (scene.parent / "other.toml").write_text(other)
        done = strata(scene.parent, "check", "other.toml")
        assert done.returncode == 0 and other != of, done.stderr
    assert set(re.findall(r"^# (\w+) = ", text, re.MULTILINE)) == {"leakoff_m_sqrt_s", "viscosity_Pa_s", "rate_m2_s", "time_s", "damping_1_s"}


def test_each_key_is_explained_by_the_list_of_keys(scene: Path) -> None:
    """Above the first line of a key stand, on one or more lines, its name, unit and meaning; no line is long."""
    text = scene.read_text()
    assert max(map(len, text.splitlines())) <= 100
    rows = [[cell.strip() for cell in re.split(r" \| |^\| | \|$", line)[1:]] for line in strata(scene.parent, "keys").stdout.splitlines() if line.startswith("| `")]
    said = {row[0].strip("`"): (row[1], row[4]) for row in rows}
    comments: list[str] = []
    table, explained = "", set()
    for line in text.splitlines():
        if heading := re.match(r"\[([\w.]+)\]", line):
            table = re.sub(r"^(rock|interface)\.\w+", r"\1.NAME", heading[1]) + "."
        key = re.match(r"(?:# )?([\w.]+) = ", line)
        if key is None:
            comments = [*comments, line] if line.startswith("#") else []
            continue
        name, above = (key[1] if table.startswith("variants") else table + key[1]), " ".join(part.lstrip("# ") for part in comments)
        for path in [path for path in said if path == name or path.startswith(name + "[].")]:
            unit, meaning = said[path]
            expected = f"{path.rpartition('.')[2]}{f' ({unit})' if unit else ''}: {re.sub(r' [(]law .*[)]$', '', meaning)}"
            assert path in explained or expected in above, path
            explained.add(path)
        assert name in explained, name
        comments = []
    assert len(explained) > 40


THERE = "begun.toml: the file is there and is left as it is"


@pytest.mark.parametrize(("name", "said"), [("begun", THERE), ("begun.toml", THERE), ("a/b", "a name is made of letters"), ("", "a name is made of letters")])
def test_what_is_refused(name: str, said: str, scene: Path) -> None:
    """With status 2, and nothing is written."""
    scene.write_text("mine")
    done = strata(scene.parent, "new", name)
    assert (done.returncode, done.stdout) == (2, "") and said in done.stderr
    assert [path.name for path in scene.parent.iterdir()] == ["begun.toml"] and scene.read_text() == "mine"
