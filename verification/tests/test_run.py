"""Runs are made once for the same scene and solver, and a failing one is told, not raised."""

import threading
import time
from pathlib import Path

import pytest

from verification.harness import run as harness
from verification.harness import store
from verification.harness.plan import make
from verification.harness.run import Job, Outcome, key_of, load_outcome, run
from verification.tests.cases import wait_for
from verification.tests.fake_run import program

SCENE = """
title = "a"
domain.width_m = 80
variants = {one.domain.width_m = 40, two.domain.width_m = 20}
claim = [{id = "1a"}]
"""

# Stands for the solver: counts its calls and does as the variant says.
SOLVER = """#!/bin/sh
echo "$*" >> "$(dirname "$0")/calls"
[ "$1" = resume ] && out=$2
while [ $# -gt 0 ]; do case "$1" in --out) out=$2;; --variant) variant=$2;; esac; shift; done
case "$variant" in
  two) echo 'the block is a mechanism' >&2; exit 3;;
  crash) kill -SEGV $$;;
  long) trap 'echo interrupted; exit 130' INT; touch "$out/scene.toml"; while :; do sleep 0.01; done;;
  deaf) trap '' INT; touch "$out/scene.toml"; while :; do sleep 0.01; done;;
esac
echo '{"status": "completed"}' > "$out/summary.json"
"""


@pytest.fixture()
def solver(tmp_path: Path) -> Path:
    return program(tmp_path / "solver" / "strata", SOLVER)


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def calls(solver: Path) -> int:
    """How often the solver ran."""
    path = solver.parent / "calls"
    return len(path.read_text().splitlines()) if path.exists() else 0


def test_a_run_is_made_once(tmp_path: Path, solver: Path, scene: Path) -> None:
    job = Job(scene, "one", tmp_path / "out")
    first, second = run(job, solver), run(job, solver)
    assert (first.ok, first.skipped, second.ok, second.skipped, calls(solver)) == (True, False, True, True, 1)
    assert load_outcome(job.out) == first
    run(job, solver, force=True)
    assert calls(solver) == 2


def test_what_decides_on_a_run_changes_its_key(tmp_path: Path, solver: Path, scene: Path) -> None:
    job = Job(scene, "one", tmp_path / "out")
    key = key_of(job, solver)
    assert key_of(Job(scene, "two", job.out), solver) != key
    assert key_of(Job(scene, "one", job.out, ("numerics.cell_m=2",)), solver) != key
    assert key_of(Job(scene, "one", job.out, threads=2), solver) == key
    scene.write_text(SCENE.replace('"1a"', '"1b"').replace("width_m = 20", "width_m = 10").replace('"a"', '"b"'))
    assert key_of(job, solver) == key, "title, claims and other variants do not decide on it"
    scene.write_text(SCENE.replace("width_m = 40", "width_m = 41"))
    assert key_of(job, solver) != key
    scene.write_text(SCENE)
    solver.write_text(SOLVER + "# another build\n")
    assert key_of(job, solver) != key


@pytest.mark.parametrize(("variant", "exit_status", "reason"), [("two", 3, "the block is a mechanism"), ("crash", -11, "killed by signal 11")])
def test_a_failure_is_kept_with_its_reason_and_tried_again_where_there_is_no_summary(
    tmp_path: Path, solver: Path, scene: Path, variant: str, exit_status: int, reason: str
) -> None:
    job = Job(scene, variant, tmp_path / "out")
    outcome = run(job, solver)
    assert (outcome.status, outcome.exit_status, outcome.reason) == ("failed", exit_status, reason) and load_outcome(job.out) == outcome
    run(job, solver)
    assert calls(solver) == 2


def test_a_run_that_completes_and_cannot_be_read_has_failed(tmp_path: Path, solver: Path, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever makes runs finds data in every completed one; how it ended itself stays in its folder."""
    monkeypatch.setenv("STRATA", str(solver))
    outcome, found = make(Job(scene, "one", tmp_path / "out"))
    assert (outcome.ok, outcome.word, found) == (False, "failed", None) and "it cannot be read: " in outcome.reason and "scene.toml" in outcome.reason
    assert load_outcome(tmp_path / "out").ok  # type: ignore[union-attr]


def interrupted(job: Job, solver: Path) -> Outcome:
    """A run that is told to stop when it has begun."""
    stop = threading.Event()
    threading.Thread(target=lambda: (wait_for(job.out / "scene.toml"), stop.set())).start()
    return run(job, solver, stop=stop)


def test_an_interrupted_run_ends_at_once_and_goes_on(tmp_path: Path, solver: Path, scene: Path) -> None:
    """It is resumed by the same solver only; its time is that of both parts."""
    job = Job(scene, "long", tmp_path / "out", threads=2)
    first = interrupted(job, solver)
    assert (first.ok, first.exit_status, first.reason) == (False, 130, "interrupted")
    second = run(job, solver)
    assert second.ok and second.wall_s > first.wall_s
    assert (solver.parent / "calls").read_text().splitlines()[1] == f"resume {job.out} --threads 2 --quiet"
    interrupted(job := Job(scene, "long", tmp_path / "other"), solver)
    solver.write_text(SOLVER.replace("long)", "short)"))
    assert run(job, solver).ok and "resume" not in (solver.parent / "calls").read_text().splitlines()[-1]


def test_a_driver_that_is_killed_leaves_what_can_go_on(tmp_path: Path, solver: Path, scene: Path) -> None:
    """While a run is made its outcome is that it was cut short. One that had failed just before its driver was killed is no completed one: the solver leaves
    a finished run as it is and ends with 0, but the summary says how it had ended."""
    job = Job(scene, "one", tmp_path / "out")
    solver.write_text('#!/bin/sh\n[ "$1" = run ] && cp "$4/outcome.json" "$4/../before.json"; exit 0\n')
    assert not run(job, solver).ok
    before = store.read(Outcome, tmp_path / "before.json")
    assert before is not None and not before.ok and before.exit_status in harness.CUT_SHORT
    store.write(before, job.out / "outcome.json")
    (job.out / "scene.toml").touch()
    (job.out / "summary.json").write_text('{"status": "failed", "reason": "the block"}')
    outcome = run(job, solver)
    assert (outcome.status, outcome.exit_status, outcome.reason) == ("failed", 3, "the block")


def test_a_run_that_hears_no_interrupt_is_killed(tmp_path: Path, solver: Path, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(harness, "GRACE_S", 0.3)
    begin = time.monotonic()
    outcome = interrupted(Job(scene, "deaf", tmp_path / "out"), solver)
    assert not outcome.ok and time.monotonic() - begin < 10.0


def test_a_folder_with_other_files_is_left_alone(tmp_path: Path, solver: Path, scene: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "thesis.tex").write_text("years of work")
    with pytest.raises(FileExistsError):
        run(Job(scene, "one", out), solver)
    assert (out / "thesis.tex").exists()
