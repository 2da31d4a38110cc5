"""What a run says when it ends, and what `resume` does where the scene in the run's folder was changed. Messages have colours on a terminal and nowhere else;
letter by letter they are the same."""

import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import pytest

from verification.faults.same import differences
from verification.harness.paths import solver
from verification.tests.cases import on_terminal, strata, summary_of

BLOCK = """\
domain = {width_m = 20, height_m = 20}
in_situ = {vertical_Pa = 3.0e6, horizontal_Pa = 2.0e6}
rock.shale.youngs_modulus_Pa = 10.0e9
strata.layers = [{rock = "shale"}]
fracture.path_m = [[10, 0], [10, 5]]
fluid = {law = "uniform", inlet = {start_Pa = 2.0e6, rate_Pa_s = 0.35e6}}
numerics = {mechanics = "quasistatic", cell_m = 1.0}
stop.tip_y_m = 12
variants.explicit.numerics = {mechanics = "explicit", damping_1_s = 20}
[variants.mechanism]
domain.sides = "traction"
rock.shale.toughness_Pa_sqrt_m = 1e9
strata = {layers = [{rock = "shale", thickness_m = 10}, {rock = "shale"}], interfaces = ["cut"]}
interface.cut = {law = "friction", coefficient = 0}
fracture.path_m = [[10, 0], [10, 9]]
stop.inlet_Pa = 4e6
"""


def content(folder: Path) -> dict[str, bytes]:
    """All files of a folder."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run that has ended, and what it said."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "block.toml").write_text(BLOCK)
    done = strata(folder, "run", "block.toml", "--out", "X")
    assert (done.returncode, done.stdout) == (0, "")
    return folder / "X", done.stderr


def test_a_run_ends_with_five_lines(whole: tuple[Path, str]) -> None:
    """They say what the summary says."""
    folder, said = whole
    summary = summary_of(folder)
    how, growth, tip, monitors, where = said.splitlines()[-5:]
    assert how.startswith(f"completed at step {summary['steps']}, t = ") and how.endswith(": tip reached y = 12 m")
    start = next(event for event in summary["events"] if event["kind"] == "start")
    assert growth == f"growth: start {1e-6 * start['inlet_Pa']:.4g} MPa at y = {start['tip_y_m']:.2f} m"
    last = summary["tips"][0]
    assert tip.startswith(f"tip: x = {last['x_m']:.2f} m, y = {last['y_m']:.2f} m, K_I {1e-6 * last['K_I_Pa_sqrt_m']:.3f} and ")
    assert tip.endswith(f"inlet {1e-6 * summary['inlet_Pa']:.4g} MPa")
    marks = [mark["monitor"] for mark in summary["suspect"]]
    assert monitors.startswith("SUSPECT: ") if marks else monitors == "monitors: none suspect"
    assert all(mark in monitors for mark in marks)
    assert where == "results in X: summary.json, history.csv, result.h5, result.xdmf"


def test_quiet_is_quiet(tmp_path: Path) -> None:
    (tmp_path / "block.toml").write_text(BLOCK)
    for arguments in (("run", "block.toml", "--out", "X", "--quiet"), ("resume", "X", "--quiet")):
        done = strata(tmp_path, *arguments)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_run_that_fails_says_so_in_its_first_line(tmp_path: Path) -> None:
    (tmp_path / "block.toml").write_text(BLOCK)
    done = strata(tmp_path, "run", "block.toml", "--variant", "mechanism", "--out", "X")
    assert done.returncode == 3, done.stderr
    reason, lines = summary_of(tmp_path / "X")["reason"], done.stderr.splitlines()
    assert next(line for line in lines if line.startswith("failed at step ")).endswith(reason) and done.stderr.count(reason) == 1
    assert lines[-1].startswith("results in X: summary.json")


def interrupted(folder: Path) -> str:
    """Make folder/X a run that was interrupted after its first output; what it said."""
    (folder / "block.toml").write_text(BLOCK)
    arguments = [str(solver()), "run", "block.toml", "--variant", "explicit", "--out", "X", "--threads", "1"]
    process, history = subprocess.Popen(arguments, cwd=folder, stderr=subprocess.PIPE, text=True), folder / "X" / "history.csv"
    while process.poll() is None and (not history.exists() or history.read_text().count("\n") < 2):
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130, said
    return said


def test_a_run_that_is_interrupted_says_what_goes_on(tmp_path: Path) -> None:
    said = interrupted(tmp_path)
    first = next(line for line in said.splitlines() if line.startswith("interrupted at step "))
    assert ": `strata resume X` goes on from " in first
    assert said.splitlines()[-1].startswith("results in X: history.csv, ")


EDITS = {
    "later stop": ("tip_y_m = 12.0", "tip_y_m = 14.0", "it says stop.tip_y_m = 14.0; the run has stop.tip_y_m = 12.0"),
    "another stop": ("[stop]\n", "[stop]\ntime_s = 9\n", "it says stop.time_s = 9.0; the run has nothing"),
    "modulus": ("youngs_modulus_Pa = 10000000000.0", "youngs_modulus_Pa = 11e9", "it says rock.shale.youngs_modulus_Pa = 11000000000.0; the run has rock.shale.youngs_modulus_Pa = 10000000000.0"),
}


@pytest.mark.parametrize("edit", EDITS)
@pytest.mark.parametrize("ended", [True, False])
def test_a_changed_scene_is_refused_and_nothing_is_lost(edit: str, ended: bool, tmp_path: Path, whole: tuple[Path, str]) -> None:
    """Exit 2, the key with both values, what to type; put back, it goes on or is left as it is."""
    if ended:
        shutil.copytree(whole[0], tmp_path / "X")
    else:
        interrupted(tmp_path)
    scene = tmp_path / "X" / "scene.toml"
    before, (old, new, told) = scene.read_text(), EDITS[edit]
    assert old in before
    scene.write_text(before.replace(old, new, 1))
    files = content(tmp_path / "X")
    done = strata(tmp_path, "resume", "X", "--quiet")
    words = (f"X/scene.toml: was changed after the run began: {told}.", "strata run X/scene.toml --out DIR", "--replace")
    assert done.returncode == 2 and all(word in done.stderr for word in words), done.stderr
    assert content(tmp_path / "X") == files
    scene.write_text("# a comment changes nothing\n" + before)
    assert strata(tmp_path, "resume", "X", "--quiet", "--threads", "1").returncode == 0
    assert (tmp_path / "X" / "summary.json").exists()


def test_what_the_refusal_advises_runs_the_changed_scene(tmp_path: Path, whole: tuple[Path, str]) -> None:
    shutil.copytree(whole[0], tmp_path / "X")
    scene = tmp_path / "X" / "scene.toml"
    scene.write_text(scene.read_text().replace("tip_y_m = 12.0", "tip_y_m = 14.0"))
    assert strata(tmp_path, "run", "X/scene.toml", "--out", "Y", "--quiet").returncode == 0
    assert strata(tmp_path, "run", "X/scene.toml", "--out", "X", "--replace", "--quiet").returncode == 0
    assert summary_of(tmp_path / "X")["tips"][0]["y_m"] == pytest.approx(14.0, abs=1e-6)
    assert differences(tmp_path / "X", tmp_path / "Y") == []


def test_a_run_that_has_ended_is_left_as_it_is_and_says_so(tmp_path: Path, whole: tuple[Path, str]) -> None:
    shutil.copytree(whole[0], tmp_path / "X")
    files = content(tmp_path / "X")
    done = strata(tmp_path, "resume", "X")
    reason = summary_of(tmp_path / "X")["reason"]
    assert (done.returncode, done.stdout, done.stderr) == (0, "", f"X: has ended and is left as it is (completed: {reason})\n")
    assert content(tmp_path / "X") == files


def test_another_version_is_named(tmp_path: Path) -> None:
    interrupted(tmp_path)
    with h5py.File(tmp_path / "X" / "result.h5.fields" / "00000.h5", "r+") as store:
        store.attrs["version"] = "0.0.1"
    done = strata(tmp_path, "resume", "X", "--threads", "1")
    assert done.returncode == 0 and "X: begun by strata 0.0.1, goes on with " in done.stderr


WRONG = BLOCK.replace("height_m", "heigth_m").replace("10.0e9", "-10.0e9").replace('"quasistatic"', '"quasistatc"')
COLOUR = re.compile(r"\x1b\[(\d+)m(.*?)\x1b\[0m")
PARTS = {"31": "place", "1": "key", "33": "value", "32": "suggestion"}


def shown(folder: Path, *arguments: str, **environment: str) -> str:
    """What a command leaves on a terminal, the bar of a run being gone."""
    return on_terminal([solver(), *arguments], folder, **environment).replace("\r\n", "\n").rpartition("\r\x1b[K")[2]


def test_an_error_has_its_parts_in_colours(tmp_path: Path) -> None:
    """Place, key, value and suggestion of each line; without colours it is what a pipe gets."""
    (tmp_path / "s.toml").write_text(WRONG)
    arguments = ("check", "s.toml", "none.toml")
    text, plain = shown(tmp_path, *arguments), strata(tmp_path, *arguments).stderr
    assert COLOUR.sub(r"\2", text) == plain and "\x1b" not in plain
    assert [{PARTS[number]: part for number, part in COLOUR.findall(line)} for line in text.splitlines()] == [
        {"place": "s.toml:1:1", "key": "domain.height_m"},
        {"place": "s.toml:1:25", "key": "domain.heigth_m", "suggestion": "height_m"},
        {"place": "s.toml:3:12", "key": "rock.shale.youngs_modulus_Pa", "value": "-10000000000.0"},
        {"place": "s.toml:7:13", "key": "numerics.mechanics", "value": '"quasistatc"', "suggestion": "quasistatic"},
        {"place": "none.toml"}]  # fmt: skip


@pytest.mark.parametrize(("variant", "how"), [([], ("32", "completed")), (["--variant", "mechanism"], ("31", "failed"))])
def test_how_a_run_ended_has_a_colour(variant: list[str], how: tuple[str, str], tmp_path: Path) -> None:
    """Green or red, with no letter changed; --quiet shows nothing of a run that completes, on a terminal either."""
    (tmp_path / "s.toml").write_text(BLOCK)
    text = shown(tmp_path, "run", "s.toml", *variant, "--out", "X")
    assert COLOUR.findall(text)[0] == how and re.search(f"^{how[1]} at step ", COLOUR.sub(r"\2", text), re.MULTILINE)
    assert {part for _, part in COLOUR.findall(text)} <= {how[1], "SUSPECT"}
    assert "\x1b" not in shown(tmp_path, "run", "s.toml", *variant, "--out", "Y", "--quiet")


@pytest.mark.parametrize(("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)])
def test_who_wants_no_colours_has_none(environment: dict[str, str], coloured: bool, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(WRONG)
    assert bool(COLOUR.search(shown(tmp_path, "check", "s.toml", **environment))) is coloured
