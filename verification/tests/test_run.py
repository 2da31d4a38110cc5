"""The runner. Runs are made once for the same scene and solver, and a failing one is told, not raised. Side by side: longest first, all of them whatever one
does, no more threads than there are, ended by an interrupt."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from verification.harness import run as harness, store
from verification.harness.run import INTERRUPTED, Job, Outcome, Task, duration, key_of, load_outcome, make, run, side_by_side, time_left
from verification.tests.cases import wait_for
from verification.tests.fake_run import SOLVER, program

SCENE = """
title = "a"
domain.width_m = 80
variants = {one.domain.width_m = 40, two.domain.width_m = 20}
claim = [{id = "1a"}]
"""


@pytest.fixture()
def solver(tmp_path: Path) -> Path:
    return program(tmp_path / "solver" / "strata")


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def calls(solver: Path) -> int:
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


quiet = [].append  # says nothing


def test_the_longest_begin_first_and_results_keep_their_order() -> None:
    begun: list[float] = []

    def task(seconds: float) -> Task[float]:
        return Task(f"{seconds:g} s", lambda _: begun.append(seconds) or seconds, str, seconds)

    assert side_by_side([task(seconds) for seconds in (2.0, 5.0, 1.0, 5.0)], 1, quiet) == [2.0, 5.0, 1.0, 5.0]
    assert begun == [5.0, 5.0, 2.0, 1.0]
    assert side_by_side([], 2, quiet) == []


def test_so_many_are_at_work_as_there_are_threads() -> None:
    """Two single ones together, one that wants two or more alone."""
    lock, at_work, most = threading.Lock(), [0], {1: 0, 2: 0, 8: 0}

    def busy(threads: int, _: threading.Event) -> int:
        with lock:
            at_work[0] += min(threads, 2)
            most[threads] = max(most[threads], at_work[0])
        time.sleep(0.02)
        with lock:
            at_work[0] -= min(threads, 2)
        return threads

    wanted = [1, 2, 1, 8, 1, 1, 2, 1, 1]
    tasks = [Task(f"{k}", lambda stop, n=n: busy(n, stop), str, threads=n) for k, n in enumerate(wanted)]
    assert side_by_side(tasks, 2, quiet) == wanted
    assert most == {1: 2, 2: 2, 8: 2}


def test_one_that_breaks_does_not_stop_the_others() -> None:
    told: list[str] = []
    done: list[int] = []

    def work(k: int) -> int:
        if k == 0:
            raise ValueError("no such folder")
        done.append(k)
        return k

    tasks = [Task(f"task {k}", lambda _, k=k: work(k), lambda k: f"made {k}", 10.0 - k) for k in range(4)]
    with pytest.raises(ValueError, match="no such folder"):
        side_by_side(tasks, 1, told.append)
    assert done == [1, 2, 3]
    assert told[0].startswith("[1/4] 0:00 min") and told[0].endswith("task 0: FAILED: no such folder")
    assert told[3].startswith("[4/4] 0:00 min, 0:00 min left") and told[3].endswith("task 3: made 3")


def test_what_is_left_is_by_the_pace_and_no_less_than_the_longest() -> None:
    assert time_left([4.0, 4.0], [], 0.5, 2) == pytest.approx(2.0)
    assert time_left([8.0], [(2.0, 1.0)], 1.0, 2) == pytest.approx(8.0), "the long one alone"
    assert time_left([], [(2.0, 0.5), (3.0, 9.0)], 2.0, 1) == pytest.approx(3.5), "one that is over its time counts for nothing"
    assert duration(125.9) == "2:05 min"


@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_those_at_work_and_leaves_the_rest(which: signal.Signals) -> None:
    told, begun, ended, usual = [], [], [], signal.getsignal(signal.SIGTERM)

    def work(k: int, stop: threading.Event) -> int:
        begun.append(k)
        if k == 1:
            time.sleep(0.1)  # until both are at work
            os.kill(os.getpid(), which)
        assert stop.wait(30.0), "nobody told it"
        ended.append(k)
        return k

    tasks = [Task(f"task {k}", lambda stop, k=k: work(k, stop), str) for k in range(5)]
    start = time.monotonic()
    with pytest.raises(SystemExit) as how:
        side_by_side(tasks, 2, told.append)
    assert how.value.code == INTERRUPTED == 130
    assert sorted(begun) == sorted(ended) == [0, 1] and time.monotonic() - start < 20.0
    assert told == ["interrupted: what is done stays, the same command goes on from there"]
    assert signal.getsignal(signal.SIGTERM) == usual


def test_what_is_at_work_is_told_where_nothing_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    monkeypatch.setattr("verification.harness.run.SILENCE_S", 0.05)
    side_by_side([Task("slow", lambda _: time.sleep(0.2), lambda _: "done")], 2, told.append)
    assert told[0] == "at work: slow (0:00 min)" and told[-1].endswith("slow: done")
