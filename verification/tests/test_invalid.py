"""Scenes that must be refused: with status 2, all that is expected of them on stderr, and nothing written; `strata new`: a scene to start from that is sound,
shows something, and says of each key what `strata keys` says."""

import os
import re
from pathlib import Path

import pytest

from verification.mistakes import BASES, changed, mistakes
from verification.tests.cases import SCENES, strata, summary_of

MISTAKES = mistakes()
assert len(MISTAKES) >= 200  # as many as there were when this was written


@pytest.fixture()
def place(tmp_path: Path) -> Path:
    """Where a scene is, away from where the solver runs."""
    (tmp_path / "scene").mkdir()
    (tmp_path / "here").mkdir()
    return tmp_path / "scene" / "mistake.toml"


@pytest.mark.parametrize("name", MISTAKES)
def test_check_says_what_is_wrong(name: str, place: Path, tmp_path: Path) -> None:
    """`check` ends with 2 and says, for every expected text, a line with the file's name that holds it."""
    place.write_text(MISTAKES[name].text, encoding="utf-8")
    done = strata(tmp_path / "here", "check", place)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert MISTAKES[name].expect and all(text in done.stderr for text in MISTAKES[name].expect), done.stderr
    for line in done.stderr.splitlines():
        assert re.match(re.escape(str(place)) + r":\d+:\d+: \S", line), f"no place in: {line}"


@pytest.mark.parametrize("name", MISTAKES)
def test_run_writes_nothing(name: str, place: Path, tmp_path: Path) -> None:
    """`run` ends with 2 and leaves no folder behind; a mistake that only a variant makes is met with that variant."""
    mistake = MISTAKES[name]
    place.write_text(mistake.text, encoding="utf-8")
    done = strata(tmp_path / "here", "run", place, *(["--variant", mistake.variant] if mistake.variant else []), "--out", "X")
    assert done.returncode == 2, done.stderr
    assert all(text in done.stderr or text.startswith("[variant") for text in mistake.expect), done.stderr
    assert list((tmp_path / "here").iterdir()) == [] and [path.name for path in place.parent.iterdir()] == [place.name]


@pytest.mark.parametrize("base", [name for name in BASES if name])
def test_what_mistakes_are_made_in_is_sound(base: str, place: Path, tmp_path: Path) -> None:
    place.write_text(BASES[base], encoding="utf-8")
    done = strata(tmp_path, "check", place)
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith(f"{place}: mechanics = ") and done.stdout.count("\n") == 1


def test_a_mistake_is_put_in_its_place() -> None:
    """A section replaces that of its heading, a second one of the same heading and a new one stand behind the one before, at the end where none is."""
    base = "[a]\nx = 1\n\n[b]\ny = 2\n\n[c]\nz = 3\n"
    assert changed(base, "[b]\ny = 4\n[d]\n[b]\n", ["[c]"]) == "[a]\nx = 1\n\n[b]\ny = 4\n\n[d]\n\n[b]\n"
    assert changed(base, "[d]\n", ["[a]"]) == "[b]\ny = 2\n\n[c]\nz = 3\n\n[d]\n" and changed("", "q = 1\n[a]\n", []) == "q = 1\n\n[a]\n"


GOOD = (SCENES / "good.toml").read_text(encoding="utf-8")
BAD = {"one.toml": GOOD.replace("width_m = 8", "width_m = -8"), "two.toml": GOOD.replace("height_m", "heigth_m")}
BOTH_WRONG = {"bad.toml": BAD["one.toml"].replace("height_m", "heigth_m")}
RUN = ("run", "good.toml", "--out", "X")


@pytest.mark.parametrize(("arguments", "files", "status", "stdout", "stderr"), [
    (("check", "good.toml"), {}, 0, "good.toml: mechanics = explicit, no fracture, y = 0 is a mirror (domain.bottom); 2.6e+02 points, 0.021 GB by estimate\n", []),  # what differs from the scenes above is not refused for another reason
    (("check", "one.toml", "none.toml", "two.toml"), BAD, 2, "", [  # goes on after a bad file, and after one that is not there
        "one.toml:2:1: domain.width_m = -8 is outside (0, inf)", "none.toml: there is no such file",
        "two.toml:3:1: unknown key domain.heigth_m. Did you mean height_m?"]),
    (("variants", "good.toml"), {}, 0, "fine\ncoarse\n", []), (("variants", "none.toml"), {}, 2, "", [""]),
    (("resolve", "bad.toml", "--set", "numerics.shape=gmp"), BOTH_WRONG, 2, "", [
        "width_m = -8 is outside (0, inf)", "Did you mean height_m?", '--set numerics.shape=gmp: numerics.shape = "gmp" is not allowed']),
    (("resume", "nowhere"), {}, 2, "", ["nowhere: this is not the folder of a run"]),
    ((*RUN, "--variant", "fin"), {}, 2, "", ["good.toml: there is no variant fin. It has fine, coarse. Did you mean fine?"]),
    *(((*RUN, "--set", setting), {}, 2, "", [said]) for setting, said in (
        ("numerics.courant=3", "--set numerics.courant=3: numerics.courant = 3 is outside (0, 2]"),
        ("numerics.shape=gmp", '--set numerics.shape=gmp: numerics.shape = "gmp" is not allowed'),
        ("numerics.cel_m=2", "--set numerics.cel_m=2: unknown key numerics.cel_m. Did you mean cell_m?"),
        ("numerics.cell_m", "--set numerics.cell_m: this is not key.path=value"),
        ("rock.stiff.youngs_modulus_Pa=10,0e9", "10,0e9 is neither TOML nor a bare word"),
        ("rock.stiff.youngs_modulus_Pa=10 GPa", "a number has a decimal point and no unit, which stands in the key."),
        ("strata.interfaces=[weak]", "[weak] is neither TOML nor a bare word"),
        ("numerics.cell_m=3", "--set numerics.cell_m=3: numerics.cell_m = 3 does not divide the block"))),
    ((*RUN, "--threads", "-1"), {}, 2, "", ["threads"]), ((*RUN, "--thread", "1"), {}, 2, "", ["--thread"]),
])  # fmt: skip
def test_what_commands_say(arguments: tuple[str, ...], files: dict[str, str], status: int, stdout: str, stderr: list[str], tmp_path: Path) -> None:
    """Status, all of stdout, what stderr has in it (nothing at all of what is good), and nothing written."""
    for name, text in {"good.toml": GOOD, **files}.items():
        (tmp_path / name).write_text(text)
    done = strata(tmp_path, *arguments)
    assert (done.returncode, done.stdout) == (status, stdout)
    assert all(text in done.stderr for text in stderr) and bool(done.stderr) == bool(stderr), done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"good.toml", *files}


def test_resolve_prints_what_a_run_writes(tmp_path: Path) -> None:
    """`resolve` prints the scene.toml of the run with the same variant and settings, and nothing else; no folder appears."""
    (tmp_path / "good.toml").write_text(GOOD)
    chosen = ["good.toml", "--variant", "fine", "--set", "stop.time_s=1e-4", "--set", "numerics.damping_1_s=3"]
    done = strata(tmp_path, "resolve", *chosen)
    assert (done.returncode, done.stderr, [path.name for path in tmp_path.iterdir()]) == (0, "", ["good.toml"])
    assert "cell_m = 0.5\n" in done.stdout and "damping_1_s = 3.0\n" in done.stdout and "time_s = 0.0001\n" in done.stdout
    assert strata(tmp_path, "run", *chosen, "--out", "X", "--quiet").returncode == 0
    assert (tmp_path / "X" / "scene.toml").read_text() == done.stdout


def test_keys_are_listed(tmp_path: Path) -> None:
    """`keys` prints a Markdown table with every key's default."""
    done = strata(tmp_path, "keys")
    assert done.returncode == 0 and "| `rock.NAME.poisson_ratio` |  | 0.2 | [0, 0.5) |" in done.stdout


ENDLESS = "q" * 100_000


@pytest.mark.parametrize(("text", "arguments"), [
    (f"{ENDLESS} = 1\n" + GOOD, []), (GOOD.replace("10e9", ENDLESS), []), (GOOD.replace("10e9", "1" * 100_000), []),
    (GOOD.replace('"stiff"', f'"{ENDLESS}"'), []), (GOOD.replace("rock.stiff", f"rock.{ENDLESS}"), []),
    (GOOD.replace("width_m = 8", '"' + "a b " * 25_000 + '" = 8'), []), (GOOD + "a" + ".a" * 100_000 + " = 1\n", []),
    (GOOD + "[a" + ".a" * 100_000 + "]\n", []), (GOOD + "x = " + "[" * 100_000 + "\n", []),
    *((GOOD, arguments) for arguments in (["--variant", ENDLESS], ["--set", ENDLESS], ["--set", f"{ENDLESS}=1"], ["--set", f"numerics.cell_m={ENDLESS}"],
                                          ["--out", ENDLESS], ["--threads", ENDLESS], [ENDLESS])),
], ids=range(16))  # fmt: skip
def test_no_message_is_endless(text: str, arguments: list[str], tmp_path: Path) -> None:
    """Whatever is endless is refused with status 2 and lines of less than 2100 characters that a person can read."""
    (tmp_path / "s.toml").write_text(text)
    done = strata(tmp_path, "run", "s.toml", *([] if "--out" in arguments else ["--out", "X"]), *arguments)
    assert done.returncode == 2, done.stderr[:3000]
    assert 0 < len(done.stderr) < 10_000 and all(len(line) < 2100 for line in done.stderr.splitlines()) and "a bug" not in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


def test_resume_of_an_endless_name(tmp_path: Path) -> None:
    """A name that no system takes is bad input, no bug."""
    done = strata(tmp_path, "resume", ENDLESS)
    assert done.returncode == 2 and "this is not the folder of a run" in done.stderr and len(done.stderr) < 2100


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
