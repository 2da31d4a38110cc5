"""A run whose disc, folder or process fails: it says so, what it had written is whole, and `resume` ends as if nothing had been. What a run says when it ends, and
what `resume` does where the scene in the run's folder was changed. Messages have colours on a terminal and nowhere else; letter by letter they are the same."""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import h5py
import pytest

from verification.faults.__main__ import COARSE, EXP1, KILLED, QUASISTATIC, RECORD, campaign, run_words
from verification.faults.same import differences, torn
from verification.harness.paths import EXPERIMENTS, solver
from verification.harness.run import Job, ended
from verification.tests.cases import SCENES, on_terminal, strata, summary_of

LONG = KILLED["explicit updated"]


# Further ones that are interrupted: interfaces that part and slide on the way.
GROWING = (
    Job(EXP1, "weak", Path(), (QUASISTATIC, "fluid.law=uniform", "stop.tip_y_m=20")),
    Job(EXPERIMENTS / "exp6_stress_reversal.toml", "friction", Path(), (QUASISTATIC, *COARSE)),
)


def started(arguments: list[str], file: Path, cwd: Path | None = None) -> subprocess.Popen[str]:
    """A run that has begun to write: a file of its folder is there."""
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=cwd)
    while not file.exists() and process.poll() is None:
        time.sleep(0.002)
    return process


def stopped(process: subprocess.Popen[str], which: signal.Signals) -> str:
    """What a run says that ends after a signal."""
    process.send_signal(which)
    return process.communicate(timeout=60)[1]


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of LONG that nothing happens to."""
    folder = tmp_path_factory.mktemp("alone") / "run"
    assert ended(run_words(LONG, folder, 60.0), None) == (0, "")
    return folder


def test_a_folder_in_use_is_refused(tmp_path: Path, alone: Path) -> None:
    process = started(run_words(LONG, tmp_path / "X", 0.0), tmp_path / "X" / "result.xdmf")
    process.send_signal(signal.SIGSTOP)  # it is in the middle of its run, and stays there
    try:
        again = [str(tmp_path / "X") if word == str(tmp_path / "Y") else word for word in run_words(LONG, tmp_path / "Y", 60.0)[1:]]
        for arguments in (["resume", "X"], [*again, "--replace"]):
            done = strata(tmp_path, *arguments)
            assert done.returncode == 2 and "X: in use by a run that is going on" in done.stderr
    finally:
        process.send_signal(signal.SIGCONT)
    assert process.wait() == 0, process.communicate()
    assert differences(alone, tmp_path / "X") == []


def test_a_file_that_may_not_grow_ends_the_run_and_loses_nothing(tmp_path: Path, alone: Path) -> None:
    """The limit rises little by little: each time the run goes on from its checkpoint, which must not be lost either."""
    folder = tmp_path / "X"
    refusals, limits = [], [400, *range(20_000, (alone / "result.h5").stat().st_size + 900_000, 400_000), 1 << 30]
    for limit in limits:
        done = strata(tmp_path, *run_words(LONG, folder, 0.0)[1:], preexec_fn=lambda most=limit: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        assert torn(folder) == []
        if done.returncode == 0:
            break
        assert done.returncode == 2 and "cannot be written: File too large" in done.stderr and "a bug" not in done.stderr, done.stderr
        refusals.append(done.stderr)
    assert len(refusals) > 3 and any("strata resume" in text and "goes on from step" in text for text in refusals)
    assert differences(alone, folder) == []


@pytest.fixture
def small_disc(tmp_path: Path) -> Iterator[Path]:
    """A disc of 4 MB of its own: room for a checkpoint and a few output times."""
    place = tmp_path / "disc"
    place.mkdir()
    if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "none", str(place)], check=False, capture_output=True).returncode != 0:
        pytest.skip("only root, where it may, can mount a small disc")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


def test_a_disc_that_is_full_ends_the_run_and_loses_nothing(small_disc: Path, alone: Path) -> None:
    folder = small_disc / "X"
    done = strata(small_disc, *run_words(LONG, folder, 0.0)[1:])
    assert done.returncode == 2 and "cannot be written: No space left on device" in done.stderr, done.stderr
    assert f"`strata resume {folder}` goes on" in done.stderr and torn(folder) == []
    written = len(list((folder / "result.h5.fields").glob("?????.h5")))
    subprocess.run(["mount", "-o", "remount,size=64m", str(small_disc)], check=True)
    done = strata(small_disc, "resume", str(folder), "--quiet")
    assert (done.returncode, done.stderr) == (0, "") and written > 0  # from the checkpoint, not from the start
    assert differences(alone, folder) == []


def make_read_only(disc: Path, process: subprocess.Popen[str]) -> None:
    """Make a disc read-only under a run, at a moment at which it has no file open to write: otherwise the disc is busy."""
    for _ in range(100):
        process.send_signal(signal.SIGSTOP)
        done = subprocess.run(["mount", "-o", "remount,ro", str(disc)], capture_output=True, text=True, check=False)
        process.send_signal(signal.SIGCONT)
        if done.returncode == 0:
            return
        assert "busy" in done.stderr, done.stderr
        time.sleep(0.01)
    raise AssertionError(f"{disc} is busy at all times")


def test_a_disc_that_becomes_read_only_ends_the_run_and_loses_nothing(small_disc: Path, alone: Path) -> None:
    subprocess.run(["mount", "-o", "remount,size=64m", str(small_disc)], check=True)
    folder = small_disc / "X"
    process = started(run_words(LONG, folder, 0.0), folder / "checkpoint.bin")
    make_read_only(small_disc, process)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 2 and "Read-only file system" in said and torn(folder) == []
    refused = strata(small_disc, "resume", str(folder))
    assert refused.returncode == 2 and "Read-only file system" in refused.stderr
    assert strata(small_disc, *run_words(LONG, small_disc / "new", 60.0)[1:]).returncode == 2
    subprocess.run(["mount", "-o", "remount,rw", str(small_disc)], check=True)
    assert strata(small_disc, "resume", str(folder)).returncode == 0
    assert differences(alone, folder) == []


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can run the solver as another user")
def test_a_folder_that_may_not_be_written_is_refused_before_the_run() -> None:
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        words = [shutil.copy(solver(), name), "run", shutil.copy(LONG.scene, name), "--out", f"{name}/X"]
        done = subprocess.run(words, user=65534, group=65534, extra_groups=[], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and "X: cannot be made: Permission denied" in done.stderr and not Path(name, "X").exists()


@pytest.mark.parametrize("way", ["moved", "removed"])
def test_a_folder_that_vanishes_ends_the_run(tmp_path: Path, alone: Path, way: str) -> None:
    folder = tmp_path / "X"
    process = started(run_words(LONG, folder, 0.0), folder / "checkpoint.bin")
    process.send_signal(signal.SIGSTOP)
    if way == "moved":
        folder.rename(tmp_path / "Y")
    else:
        shutil.rmtree(folder)
    said = stopped(process, signal.SIGCONT)
    assert process.returncode == 2 and "No such file or directory" in said and "once its folder is there" in said and not folder.exists(), said
    if way == "moved":
        assert torn(tmp_path / "Y") == []
        assert strata(tmp_path, "resume", str(tmp_path / "Y")).returncode == 0
        assert differences(alone, tmp_path / "Y") == []


@pytest.mark.parametrize("job, which, shares", [
    *((job, signal.SIGINT, (0.25,)) for job in KILLED.values()), (KILLED["quasi-static turning"], signal.SIGTERM, (0.25,)),
    *((job, signal.SIGTERM, (0.4, 0.6, 0.75)) for job in GROWING),
])  # fmt: skip
def test_a_run_that_is_interrupted_ends_at_once_and_goes_on_to_the_same_digits(tmp_path: Path, job: Job, which: signal.Signals, shares: tuple[float, ...]) -> None:
    """After some shares of its time. Mutation that fails with friction, in coarse cells too: the state is kept as it is after the run itself has started anew from it."""
    folder, whole = tmp_path / "X", tmp_path / "whole"
    begin = time.monotonic()
    assert ended(run_words(job, whole, 60.0), None) == (0, "")
    wall_s = time.monotonic() - begin
    for share in shares:
        for wait_s in (share * wall_s, wall_s / 16, 0.0):  # it may take a fraction now of what it took beside other tests
            shutil.rmtree(folder, ignore_errors=True)
            process = started(run_words(job, folder, 60.0), folder / "result.h5.fields/00000.h5")  # the interrupt alone writes a checkpoint
            time.sleep(wait_s)
            begin = time.monotonic()
            said = stopped(process, which)
            took_s = time.monotonic() - begin
            if process.returncode != 0:
                break  # it had not ended before
        assert process.returncode == 130 and "strata resume" in said, said
        assert took_s < max(2.0, wall_s / 2)  # 2 s; more where others keep the machine busy
        assert not (folder / "summary.json").exists() and torn(folder) == []
        assert strata(tmp_path, "resume", str(folder), "--quiet").returncode == 0
        assert differences(whole, folder) == []


def test_a_signal_before_the_first_step_ends_the_process(tmp_path: Path) -> None:
    """There is nothing to save yet, and a large block takes its time to be set up."""
    folder = tmp_path / "X"
    process = started([*run_words(KILLED["quasi-static paper"], folder, 60.0), "--set", "numerics.cell_m=0.25"], folder / "scene.toml")
    begin = time.monotonic()
    said = stopped(process, signal.SIGINT)
    assert process.returncode == 130 and "interrupted" in said and time.monotonic() - begin < 1.0, said


def test_runs_that_are_killed_end_as_those_that_are_not() -> None:
    """Ten kills at random moments; `python3 -m verification.faults` kills as often as one likes."""
    for name in ("explicit total", "explicit updated", "quasi-static turning", "quasi-static reynolds"):
        tally = campaign(name, 2 if name != "explicit total" else 4, 0.02, seed=7)
        assert tally.kills >= 2 and tally.identical == tally.trials > 0 and tally.problems == []


@pytest.mark.parametrize("name", ["explicit total", "explicit updated", "quasi-static paper"])
def test_memory_is_estimated_a_little_above_what_a_run_takes(tmp_path: Path, name: str) -> None:
    """At 1 m cells, checkpoints written: never below the peak, within 30 % above it with inertia and 80 % without (see memory_need).

    Mutations that fail: half and twice the estimate.
    """
    inertia = name.startswith("explicit")
    brief = ("stop.time_s=0.12", "fracture.crossing=J") if inertia else ()  # too short for equilibria to decide about growth
    own = KILLED[name]
    short = Job(own.scene, own.variant, own.out, (*own.settings, "numerics.cell_m=1", "fracture.increment_m=1", *brief))
    done = strata(tmp_path, *(word for word in run_words(short, tmp_path / "X", 0.0)[1:] if word != "--quiet"))
    assert done.returncode == 0, done.stderr
    estimate_MB = 1e3 * float(re.search(r"([\d.e+-]+) GB", done.stderr).group(1))  # type: ignore[union-attr]
    peak_MB = summary_of(tmp_path / "X")["peak_memory_MB"]
    assert 1.0 < estimate_MB / peak_MB < (1.3 if inertia else 1.8)


def test_two_hundred_kills_and_every_run_the_same() -> None:
    """What is kept of the kills: as many as are claimed, of every scene, and not one run that ended otherwise."""
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    assert record["kills"] >= 200 and record["identical"] == record["trials"] > 0 and record["from_checkpoint"] > 100
    assert [scene["name"] for scene in record["scenes"]] == list(KILLED)
    for scene in record["scenes"]:
        assert scene["kills"] >= 30 and scene["problems"] == []
        assert scene["identical"] == scene["trials"] > 10
        assert sum(scene[key] for key in ("from_checkpoint", "from_start", "before_folder", "after_end")) == scene["kills"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_an_error_output_that_takes_nothing_changes_no_exit_status(tmp_path: Path) -> None:
    """A message that cannot be written is lost, and that is all: a run ends as it would, and is whole."""
    with open("/dev/full", "w") as full:
        refused = subprocess.run([solver(), "check", "nowhere.toml"], stderr=full, check=False)
        done = subprocess.run(run_words(LONG, tmp_path / "X", 60.0), stderr=full, check=False)
    assert (refused.returncode, done.returncode) == (2, 0)
    assert torn(tmp_path / "X") == [] and summary_of(tmp_path / "X")["status"] == "completed"


BLOCK = SCENES / "block.toml"


def content(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run that has ended, and what it said."""
    folder = tmp_path_factory.mktemp("whole")
    done = strata(folder, "run", BLOCK, "--out", "X")
    assert (done.returncode, done.stdout) == (0, "")
    return folder / "X", done.stderr


def test_a_second_run_is_refused_unless_it_is_to_replace_the_first(tmp_path: Path, whole: tuple[Path, str]) -> None:
    shutil.copytree(whole[0], tmp_path / "X")
    other = ("run", BLOCK, "--variant", "explicit", "--out", "X")
    second = strata(tmp_path, *other)
    assert second.returncode == 2 and all(word in second.stderr for word in ("X: holds a run already", "strata resume X", "--replace", "--out"))
    assert content(tmp_path / "X") == content(whole[0])
    assert strata(tmp_path, *other, "--replace").returncode == 0
    assert summary_of(tmp_path / "X")["variant"] == "explicit"


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
    for arguments in (("run", BLOCK, "--out", "X", "--quiet"), ("resume", "X", "--quiet")):
        done = strata(tmp_path, *arguments)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_run_that_fails_says_so_in_its_first_line(tmp_path: Path) -> None:
    done = strata(tmp_path, "run", BLOCK, "--variant", "mechanism", "--out", "X")
    assert done.returncode == 3, done.stderr
    reason, lines = summary_of(tmp_path / "X")["reason"], done.stderr.splitlines()
    assert next(line for line in lines if line.startswith("failed at step ")).endswith(reason) and done.stderr.count(reason) == 1
    assert lines[-1].startswith("results in X: summary.json")


def interrupted_in(folder: Path) -> str:
    """Make folder/X a run that was interrupted after its first output; what it said."""
    arguments = [str(solver()), "run", str(BLOCK), "--variant", "explicit", "--out", "X", "--threads", "1"]
    process = started(arguments, folder / "X/result.h5.fields/00000.h5", folder)
    said = stopped(process, signal.SIGINT)
    assert process.returncode == 130, said
    return said


def test_a_run_that_is_interrupted_says_what_goes_on(tmp_path: Path) -> None:
    said = interrupted_in(tmp_path)
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
        interrupted_in(tmp_path)
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
    interrupted_in(tmp_path)
    with h5py.File(tmp_path / "X" / "result.h5.fields" / "00000.h5", "r+") as store:
        store.attrs["version"] = "0.0.1"
    done = strata(tmp_path, "resume", "X", "--threads", "1")
    assert done.returncode == 0 and "X: begun by strata 0.0.1, goes on with " in done.stderr


WRONG = BLOCK.read_text(encoding="utf-8").replace("height_m", "heigth_m").replace("10.0e9", "-10.0e9").replace('"quasistatic"', '"quasistatc"')
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
    text = shown(tmp_path, "run", str(BLOCK), *variant, "--out", "X")
    assert COLOUR.findall(text)[0] == how and re.search(f"^{how[1]} at step ", COLOUR.sub(r"\2", text), re.MULTILINE)
    assert {part for _, part in COLOUR.findall(text)} <= {how[1], "SUSPECT"}
    assert "\x1b" not in shown(tmp_path, "run", str(BLOCK), *variant, "--out", "Y", "--quiet")


@pytest.mark.parametrize(("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True), ({"TERM": "dumb"}, False)])
def test_who_wants_no_colours_has_none(environment: dict[str, str], coloured: bool, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(WRONG)
    assert bool(COLOUR.search(shown(tmp_path, "check", "s.toml", **environment))) is coloured
