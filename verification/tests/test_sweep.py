"""Many runs. Sweeps: runs by hand-written lists, the strata of a sample, what is refused where, failures as rows, and tables that no kill changes.

Mutations that were tried by hand and failed here or in solver/tests/test_scene_sweep.cpp: the first axis fastest, ratios even on a linear scale, ends left
out, keys of one axis as two, a stratum drawn twice, points of a stratum's middle only, an outcome kept before its row, a killed run taken for a done
one, a run done before taken for one that failed since, rows in the order of their ends.

The campaign: which runs there are, both mechanics, but for variants that only one can run; choices name what exists.
"""

import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import h5py
import pytest

from verification.harness import campaign as campaigns, store, sweep
from verification.harness.campaign import jobs_of, main as campaign_main
from verification.harness.claims import FILE, read_points
from verification.harness.load import load
from verification.harness.paths import EXPERIMENTS, ROOT
from verification.harness.run import CUT_SHORT, Job, Outcome, expected_s, load_outcome
from verification.harness.scenes import MECHANICS, STUDY_VARIANTS, content_of, mechanics_of, scene_of, scenes_of, variants_of
from verification.tests.cases import SCENES, strata, wait_for
from verification.tests.fake_run import climb, program, write_run

SCENE = SCENES / "sweep.toml"
BASE = SCENE.read_text(encoding="utf-8").partition("[sweep]")[0]


def scene_with(folder: Path, axes: str) -> Path:
    """The small scene with another sweep, its text behind the base."""
    path = folder / "scene.toml"
    path.write_text(BASE + axes, encoding="utf-8")
    return path


def runs(folder: Path, axes: str) -> list[tuple[str, dict[str, str]]]:
    """Names and keys of a sweep's runs."""
    return [(job.out.name, sweep.axes_of(job)) for job in sweep.jobs_of(scene_with(folder, axes), folder)]


def test_products_and_ranges(tmp_path: Path) -> None:
    """By hand: 2 x 3 runs in the order of the file, the last axis fastest; even ratios 1, sqrt(10), 10 and even steps 0.2, 0.5, 0.8, ends as given."""
    axes = '[sweep]\nrock.shale.toughness_Pa_sqrt_m = [2e6, 1e6]\n"in_situ.vertical_Pa" = {from = 1e6, to = 10e6, count = 3, scale = "log"}\n'
    assert runs(tmp_path, axes) == [
        (f"{k}_{s}", {"rock.shale.toughness_Pa_sqrt_m": f"{k}.0", "in_situ.vertical_Pa": f"{s}.0"})
        for k in (2000000, 1000000) for s in (1000000, 3162280, 10000000)
    ]  # fmt: skip
    found = runs(tmp_path, "[sweep]\ninterface.joint.coefficient = {from = 0.2, to = 0.8, count = 3}\n")
    assert [keys["interface.joint.coefficient"] for _, keys in found] == ["0.2", "0.5", "0.8"]


def test_axes_that_move_together(tmp_path: Path) -> None:
    """Keys of a [[sweep.together]] are one axis, a variant may be one of them; lists and tables are values, and are numbers in names."""
    axes = """[variants.stiff]
rock.shale.youngs_modulus_Pa = 20e9
[variants.soft]
rock.shale.youngs_modulus_Pa = 5e9
[[sweep.together]]
variant = ["stiff", "soft"]
fracture.path_m = [[[10, 0], [10, 4]], [[10, 0], [10, 6.5]]]
stop.inlet_Pa = {from = 3e6, to = 5e6, count = 2}
[sweep]
fluid.inlet = [{start_Pa = 2e6, rate_Pa_s = 1e5}]
"""
    found = sweep.jobs_of(scene_with(tmp_path, axes), tmp_path)
    assert [(job.out.name, job.variant) for job in found] == [("stiff_1", "stiff"), ("soft_1", "soft")]
    inlet = "fluid.inlet={ rate_Pa_s = 100000.0, start_Pa = 2000000.0 }"
    assert found[1].settings == ("fracture.path_m=[ [ 10, 0 ], [ 10, 6.5 ] ]", "stop.inlet_Pa=5000000.0", inlet)
    for job in found:
        assert strata(tmp_path, "resolve", job.scene, "--variant", job.variant, *(word for one in job.settings for word in ("--set", one))).returncode == 0


def test_a_latin_hypercube_has_a_run_in_each_stratum(tmp_path: Path) -> None:
    """Of 40 runs each fortieth of an axis, by ratios on a log scale, has one, each of two words twenty; another seed draws others, the same the same."""
    axes = """[sweep]
sample = {method = "latin_hypercube", count = 40, seed = %d}
rock.shale.toughness_Pa_sqrt_m = {from = 1e6, to = 3e6}
in_situ.vertical_Pa = {from = 1e5, to = 1e7, scale = "log"}
fracture.direction = ["straight", "max_hoop"]
"""
    found = [keys for _, keys in runs(tmp_path, axes % 7)]
    even = [(float(keys["rock.shale.toughness_Pa_sqrt_m"]) - 1e6) / 2e6 for keys in found]
    ratio = [math.log10(float(keys["in_situ.vertical_Pa"]) / 1e5) / 2.0 for keys in found]
    for places in (even, ratio):
        assert sorted(int(40.0 * place) for place in places) == list(range(40))
    assert [keys["fracture.direction"] for keys in found].count("straight") == 20
    assert [keys for _, keys in runs(tmp_path, axes % 7)] == found != [keys for _, keys in runs(tmp_path, axes % 8)]


def test_every_run_is_checked_where_its_value_stands(tmp_path: Path) -> None:
    """What is wrong with a run alone is told at its value, once, with the first run that meets it; nothing is run then. The base runs as it is."""
    scene = scene_with(tmp_path, "[sweep]\nnumerics.cell_m = [1, 3]\nrock.shal.poisson_ratio = [0.2, 0.3]\n")
    line = BASE.count("\n") + 2
    for command in ("check", "sweep"):
        said = strata(tmp_path, command, scene).stderr
        assert f"{scene}:{line}:23: numerics.cell_m = 3 does not divide the block of 20 m x 20 m" in said and said.count("does not divide") == 1
        assert f"{scene}:{line + 1}:28: there is no [rock.shal] in the scene, and no layer uses it. Did you mean shale? [run 1_0.2]" in said
    assert sweep.main([str(scene), f"--out={tmp_path / 'out'}"]) == 2 and not (tmp_path / "out").exists()
    assert strata(tmp_path, "run", scene, "--out", "X", "--quiet", "--set", "stop.tip_y_m=6").returncode == 0
    assert "[sweep" not in (tmp_path / "X" / "scene.toml").read_text()
    assert "no [sweep]" in strata(tmp_path, "sweep", scene_with(tmp_path, "")).stderr


def test_what_a_row_says(tmp_path: Path) -> None:
    """On a made-up climb: first events' pressures, two arrests (on the way and at the end) and one restart; of two tips place, K,
    J and G of the highest and of the lowest. Mutations that fail: the other tip's, or the highest one's twice."""
    write_run(tmp_path / "a" / "run", end_Pa=3e6, steps=climb(to_m=14.0, plateaus={10.0: 0.2e6}), mechanics="quasistatic")
    row = sweep.observed(load(tmp_path / "a" / "run"))
    events = {event.kind: event for event in reversed(load(tmp_path / "a" / "run").summary.events)}
    assert (row["start_Pa"], row["arrest_Pa"], row["restart_Pa"], row["stop_Pa"]) == tuple(events[kind].inlet_Pa for kind in ("start", "arrest", "restart", "stop"))
    assert (row["arrests"], row["restarts"], row["arrest_y_m"]) == (2, 1, 10.0) and row["restart_Pa"] > row["arrest_Pa"] and math.isnan(row["reach_interface_Pa"])
    run = load(tmp_path / "a" / "run")
    high = replace(run.summary.tips[0], G_N_m=9.0)
    low = replace(high, x_m=-2.0, y_m=-3.0, K_I_Pa_sqrt_m=7.0, K_II_Pa_sqrt_m=-1.0, J_N_m=5.0, G_N_m=4.0)
    both = sweep.observed(replace(run, summary=replace(run.summary, tips=(high, low))))
    assert row["highest_tip_y_m"] == row["lowest_tip_y_m"] == high.y_m
    for name in ("x_m", "y_m", "K_I_Pa_sqrt_m", "K_II_Pa_sqrt_m", "J_N_m", "G_N_m"):
        assert (both[f"lowest_tip_{name}"], both[f"highest_tip_{name}"]) == (getattr(low, name), getattr(high, name)), name


AXES = "[sweep]\nin_situ.vertical_Pa = [2e6, 4e6]\ninterface.joint.coefficient = [0.0, 0.6]\n"


def command(scene: Path, out: Path) -> list[str]:
    """A sweep as a process of its own."""
    return [sys.executable, "-s", "-m", "verification.harness.sweep", str(scene), f"--out={out}", "--jobs=2", "--lean"]


def tables(out: Path) -> list[bytes]:
    return [(out / name).read_bytes() for name in ("sweep.csv", "sweep.h5")]


@pytest.mark.smoke
def test_failures_are_rows_and_no_kill_changes_a_table(tmp_path: Path) -> None:
    """Without friction the upper block is a mechanism: two rows with that reason. A sweep whose driver and runs are killed again and again comes to the
    same tables; what is done is not done again, also where an axis grows; a table of twice the numbers is another."""
    scene, out, other = scene_with(tmp_path, AXES), tmp_path / "out", tmp_path / "other"
    done = subprocess.run(command(scene, out), capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.returncode == 3 and done.stdout.count("failed: ") == 2, done.stdout + done.stderr
    rows = list(csv.DictReader((out / "sweep.csv").read_text().splitlines()))
    assert [row["run"] for row in rows] == ["2000000_0", "2000000_0.6", "4000000_0", "4000000_0.6"]
    assert [row["status"] for row in rows] == ["failed", "completed"] * 2
    assert rows[1]["reason"] == json.loads((out / "runs" / "2000000_0.6" / "summary.json").read_text())["reason"] == "tip reached y = 14 m"
    assert rows[0]["reason"].startswith("the block has become a mechanism") and rows[0]["start_Pa"] == "" and float(rows[1]["start_Pa"]) > 2e6
    with h5py.File(out / "sweep.h5") as file:
        assert list(file["table/start_Pa"][()])[1] == float(rows[1]["start_Pa"]) and set(file["histories"]) == {"2000000_0.6", "4000000_0.6"}
        history, run = file["histories/2000000_0.6"], load(out / "runs" / "2000000_0.6")
        assert list(history.attrs["columns"]) == list(run.history) and history[-1, list(run.history).index("tip_y_m")] == run.history["tip_y_m"][-1]
    assert not (out / "runs" / "2000000_0.6" / "result.h5").exists()
    first = tables(out)
    for pause in (0.6, 0.9, 1.2):
        driver = subprocess.Popen(command(scene, other), stdout=subprocess.DEVNULL, cwd=ROOT)
        time.sleep(pause)
        driver.kill()
        driver.wait()
    subprocess.run(command(scene, other), capture_output=True, check=False, cwd=ROOT)
    assert tables(other) == first
    times = {path: path.stat().st_mtime_ns for path in (out / "runs").glob("*/summary.json")}
    more = scene_with(tmp_path, AXES.replace("[2e6, 4e6]", "[2e6, 4e6, 5e6]"))
    again = subprocess.run(command(more, out), capture_output=True, text=True, check=False, cwd=ROOT)
    assert "2 runs to make, 4 done before" in again.stdout and all(path.stat().st_mtime_ns == then for path, then in times.items())
    assert tables(out) != first


def test_a_killed_run_is_made_again(tmp_path: Path) -> None:
    """kill -9 of the solver alone: the same command makes the run again; what is kept of it says that it was cut short, should that be killed too."""
    scene = scene_with(tmp_path, "[sweep]\nnumerics.cell_m = [0.25]\n")
    driver = subprocess.Popen(command(scene, tmp_path / "out"), stdout=subprocess.PIPE, text=True, cwd=ROOT)
    run = tmp_path / "out" / "runs" / "0.25"
    begun = time.monotonic()
    while not (run / "scene.toml").exists():
        assert time.monotonic() - begun < 60.0 and driver.poll() is None
        time.sleep(0.01)
    kept = load_outcome(run)
    assert kept is not None and not kept.ok and kept.exit_status in CUT_SHORT
    pids = subprocess.run(["pgrep", "-P", str(driver.pid)], capture_output=True, text=True, check=False).stdout.split()
    os.kill(int(pids[0]), signal.SIGKILL)
    said, _ = driver.communicate()
    assert driver.returncode == 0 and "killed by signal 9" in said and "1 runs, 0 failed" in said


def test_what_cannot_be_observed_is_a_row(tmp_path: Path) -> None:
    """A run that was never made, and one that a function cannot make a row of, say so; a function that is not there is bad input. Another function's
    row replaces it without a new run."""
    job = Job(SCENE, "", tmp_path / "gone", ("numerics.cell_m=1",))
    assert sweep.row_of(job) == {"run": "gone", "numerics.cell_m": "1", "status": "missing", "reason": "not made"}
    scene, out = scene_with(tmp_path, "[sweep]\nnumerics.cell_m = [2.5]\nfracture.increment_m = [2.5]\n"), tmp_path / "out"
    assert sweep.main([str(scene), f"--out={out}", "--observe=json:dumps"]) == 3
    assert "not observed: TypeError" in (out / "sweep.csv").read_text()
    then = (out / "runs" / "2.5_2.5" / "history.csv").stat().st_mtime_ns
    assert sweep.main([str(scene), f"--out={out}"]) == 0 and (out / "runs" / "2.5_2.5" / "history.csv").stat().st_mtime_ns == then
    assert "not observed" not in (out / "sweep.csv").read_text()


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    return Path(shutil.copy(SCENES / "variants.toml", tmp_path / "exp.toml"))


def test_what_a_variant_can_run_in(scene: Path) -> None:
    one = {"flow": ("quasistatic",), "energy": ("quasistatic",), "undamped": ("explicit",)}
    assert {variant: mechanics_of(scene, variant) for variant in variants_of(scene)} == {"plain": MECHANICS, "graded": MECHANICS, **one}


def test_keys_are_those_that_a_run_has() -> None:
    """Defaults, a variant's and settings in place; what the solver refuses is an error with its words."""
    content = content_of(scene_of("exp1"), "uniform_soft", ("numerics.cell_m=2", "fracture.increment_m=3"))
    assert content["fluid"]["law"] == "uniform" and content["strata"]["interfaces"] == ["soft"] and content["numerics"]["courant"] == 0.5
    assert (content["numerics"]["cell_m"], content["fracture"]["increment_m"]) == (2.0, 3.0) and "variants" not in content
    with pytest.raises(ValueError, match="there is no variant nobody"):
        content_of(scene_of("exp1"), "nobody")


def test_the_campaign_runs_both_mechanics_but_what_one_cannot(tmp_path: Path) -> None:
    jobs = jobs_of(tmp_path, scenes_of(EXPERIMENTS))
    folders = {str(job.out.relative_to(tmp_path)) for job in jobs}
    assert len(folders) == len(jobs) and {folder.split("/")[0] for folder in folders} == set(MECHANICS)
    assert "quasistatic/exp1_single_interface/reynolds" in folders and "explicit/exp1_single_interface/reynolds" not in folders
    assert "explicit/exp1_single_interface/undamped" in folders and "quasistatic/exp1_single_interface/undamped" not in folders
    assert all(f"numerics.mechanics={job.out.relative_to(tmp_path).parts[0]}" in job.settings for job in jobs)
    some = jobs_of(tmp_path, [scene_of("exp3")], ("numerics.cell_m=2",), ("quasistatic",))
    assert {job.out.parts[-3:-1] for job in some} == {("quasistatic", "exp3_two_interfaces")}
    assert all("numerics.cell_m=2" in job.settings for job in some)


def test_the_list_of_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert campaign_main(["--list", "--runs", str(tmp_path), "--only", "exp3", "--mechanics", "explicit"]) == 0
    lines = capsys.readouterr().out.split()
    assert "explicit/exp3_two_interfaces/perfect" in lines and not any(line.startswith("quasistatic") for line in lines)


@pytest.fixture()
def campaign(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for a campaign of a scene of four variants with a program in the solver's place."""
    (tmp_path / "experiments").mkdir()
    text = (EXPERIMENTS / "exp1_single_interface.toml").read_text().partition("[variants.")[0]
    (tmp_path / "experiments" / "exp.toml").write_text(text + "".join(f"[variants.{name}]\n" for name in ("perfect", "friction", "weak")))
    write_run(tmp_path / "solver" / "made", climb())
    monkeypatch.setenv("STRATA", str(program(tmp_path / "solver" / "strata")))
    page = tmp_path / "page.py"
    page.write_text("import sys\nfrom pathlib import Path\nPath(sys.argv[-1]).mkdir(exist_ok=True)\n(Path(sys.argv[-1]) / 'index.html').touch()\n")
    monkeypatch.setattr(campaigns, "PAGE", page)
    return tmp_path


def calls(campaign: Path) -> list[str]:
    return re.findall("--variant ([a-z]+)", (campaign / "solver" / "calls").read_text())


def reproduce(campaign: Path) -> int:
    """The campaign with inertia, from the command line."""
    folders = [word for name in ("experiments", "runs", "out") for word in (f"--{name}", str(campaign / name))]
    return campaign_main([*folders, "--mechanics", "explicit", "--jobs", "2"])


def test_a_run_that_fails_is_told_and_the_others_go_on(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit status 3 with the reason, all others made, the page written; a second call makes nothing and says the same."""
    assert reproduce(campaign) == 3
    said = capsys.readouterr().out
    assert "3 runs to make, 0 done before" in said and "[3/3]" in said and "explicit/exp/weak: starts at 2.360 MPa, tip at 70.0 m at 3.000 MPa" in said
    assert said.count("failed: explicit/exp/friction: the block is a mechanism") == 1
    assert (campaign / "out" / "index.html").is_file() and (campaign / "runs" / "claims.json").is_file()
    assert sorted(calls(campaign)) == ["friction", "perfect", "weak"]
    assert reproduce(campaign) == 3
    said = capsys.readouterr().out
    assert "0 runs to make, 3 done before" in said and "failed: explicit/exp/friction" in said and len(calls(campaign)) == 3


def test_a_folder_that_is_no_run_s_fails_that_run_alone(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = campaign / "runs" / "explicit" / "exp" / "weak"
    folder.mkdir(parents=True)
    (folder / "thesis.tex").write_text("years of work")
    assert reproduce(campaign) == 3
    said = capsys.readouterr().out
    assert "failed: explicit/exp/weak" in said and "holds files but no run" in said and "[3/3]" in said
    assert (folder / "thesis.tex").exists()


def test_an_interrupt_ends_the_campaign_and_a_second_call_goes_on(campaign: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """By a signal to the process, as of a terminal or of `kill`: status 130, no process left, what is done is not run again."""
    scene = campaign / "experiments" / "exp.toml"
    scene.write_text(scene.read_text().replace("variants.friction", "variants.long"))
    long = campaign / "runs" / "explicit" / "exp" / "long"
    threading.Thread(target=lambda: (wait_for(long / "scene.toml"), os.kill(os.getpid(), signal.SIGTERM))).start()
    with pytest.raises(SystemExit) as how:
        reproduce(campaign)
    assert how.value.code == 130 and "interrupted" in capfd.readouterr().out
    assert load_outcome(long).exit_status == 130  # type: ignore[union-attr]
    assert not (campaign / "out" / "index.html").exists()
    ended = {name: load_outcome(long.parent / name) for name in ("perfect", "weak")}
    left, before = {name for name, outcome in ended.items() if outcome is None or not outcome.ok}, len(calls(campaign))
    scene.write_text(scene.read_text().replace("variants.long", "variants.other"))
    assert reproduce(campaign) == 0
    assert sorted(calls(campaign)[before:]) == sorted({*left, "other"})


def test_what_takes_longest_is_known_before_anything_was_run(tmp_path: Path) -> None:
    """By the scene's cells and mechanics; by the last time where there is one."""
    coarse, fine = (jobs_of(tmp_path, [scene_of("exp1")], (f"numerics.cell_m={cell}",), ("explicit",))[0] for cell in (2, 1))
    assert expected_s(fine) > 3.0 * expected_s(coarse) > 0.0
    fine.out.mkdir(parents=True)
    store.write(Outcome("exp1", "", "completed", 0, "", 12.5, "key"), fine.out / "outcome.json")
    assert expected_s(fine) == 12.5


def test_every_variant_beside_the_study_s_types_belongs_to_a_choice() -> None:
    every = [one for point in read_points(EXPERIMENTS) for one in point.choices]
    shown = {(stem, name) for one in every for stem, pairs in one.runs.items() for name in pairs.values()}
    assert {(scene.stem, name) for scene in scenes_of(EXPERIMENTS) for name in variants_of(scene) if name not in STUDY_VARIANTS} <= shown


@pytest.mark.parametrize("name, variant", [("exp", "nobody"), ("exp9", "plain")])
def test_a_choice_of_something_that_is_not_there_is_refused(scene: Path, name: str, variant: str) -> None:
    path = scene.parent / FILE
    path.parent.mkdir()
    text = "[[point]]\nid = 'a'\nopen = 'b'\ndefault = 'c'\n[[point.choice]]\nid = 'd'\nname = 'e'\n"
    path.write_text(text + f"runs.{name} = {{plain = '{variant}'}}\n")
    with pytest.raises(ValueError, match="there is no experiment exp9" if name == "exp9" else "nobody"):
        read_points(scene.parent)
