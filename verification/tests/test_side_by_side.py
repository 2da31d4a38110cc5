"""Tasks side by side: longest first, all of them whatever one does, no more threads than there are, ended by an interrupt."""

import os
import signal
import threading
import time

import pytest

from verification.harness.run import INTERRUPTED
from verification.harness.side_by_side import Task, duration, side_by_side, time_left


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
    monkeypatch.setattr("verification.harness.side_by_side.SILENCE_S", 0.05)
    side_by_side([Task("slow", lambda _: time.sleep(0.2), lambda _: "done")], 2, told.append)
    assert told[0] == "at work: slow (0:00 min)" and told[-1].endswith("slow: done")
