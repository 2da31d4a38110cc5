"""Does tasks side by side, those that take longest first, and tells how far it is; one that breaks does not stop the others."""

import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Generic, TypeVar

from verification.harness.run import INTERRUPTED

Made = TypeVar("Made")
Tell = Callable[[str], None]

# Where nothing ends for so long, what is at work is told, s.
SILENCE_S = 60.0


@dataclass(frozen=True)
class Task(Generic[Made]):
    """Something to do: its name, what does it, what to say of what it made, how long it may take (s), how many threads it wants. What does it is
    given an event, and is to end soon once that is set. Times count against each other: 1 for all where none is known."""

    name: str
    make: Callable[[threading.Event], Made]
    words: Callable[[Made], str]
    expected_s: float = 1.0
    threads: int = 1


say: Tell = partial(print, flush=True)


def duration(seconds: float) -> str:
    """A time span (s) as minutes and seconds."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d} min"


def time_left(waiting: Sequence[float], at_work: Sequence[tuple[float, float]], pace: float, jobs: int) -> float:
    """Time to the end of all (s): expected times of those that wait, expected and spent ones of those at work, what an expected second takes. All of
    it on `jobs` threads, but no less than the longest alone."""
    rest = [pace * expected for expected in waiting] + [max(pace * expected - spent, 0.0) for expected, spent in at_work]
    return max(sum(rest) / jobs, max(rest, default=0.0))


@contextmanager
def interruptible() -> Iterator[threading.Event]:
    """An event that is set when the block ends, also by Ctrl-C or a request to terminate; both are a KeyboardInterrupt here."""
    stop = threading.Event()
    here = threading.current_thread() is threading.main_thread()  # no other may ask for signals
    usual = signal.signal(signal.SIGTERM, signal.default_int_handler) if here else None
    try:
        yield stop
    finally:
        stop.set()
        if here:
            signal.signal(signal.SIGTERM, usual)


def side_by_side(tasks: Sequence[Task[Made]], jobs: int, tell: Tell = say) -> list[Made]:
    """What the tasks made, in their order, done on `jobs` threads; a task that wants more threads than that gets all of them. An exception of a task
    is raised when all others are done. An interrupt ends those at work, leaves the rest and is a SystemExit."""
    queue = sorted(range(len(tasks)), key=lambda k: tasks[k].expected_s, reverse=True)
    at_work: dict[Future[Made], int] = {}
    done: dict[int, Future[Made]] = {}
    threads = [min(task.threads, jobs) for task in tasks]
    begun, took, start = {}, {}, time.monotonic()
    with ThreadPoolExecutor(max_workers=jobs) as pool, interruptible() as stop:
        try:
            while queue or at_work:
                while queue and threads[queue[0]] + sum(threads[k] for k in at_work.values()) <= jobs:
                    k = queue.pop(0)
                    begun[k] = time.monotonic()
                    at_work[pool.submit(tasks[k].make, stop)] = k
                ended = wait(at_work, SILENCE_S, FIRST_COMPLETED).done
                now = time.monotonic()
                if not ended:
                    tell("at work: " + ", ".join(f"{tasks[k].name} ({duration(now - begun[k])})" for k in at_work.values()))
                for future in ended:
                    k = at_work.pop(future)
                    done[k], took[k], error = future, now - begun[k], future.exception()
                    said = tasks[k].words(future.result()) if error is None else f"FAILED: {error}"
                    pace = sum(took.values()) / (sum(tasks[j].expected_s for j in took) or 1.0)
                    going = [(tasks[j].expected_s, now - begun[j]) for j in at_work.values()]
                    left = duration(time_left([tasks[j].expected_s for j in queue], going, pace, jobs))
                    tell(f"[{len(done):{len(str(len(tasks)))}d}/{len(tasks)}] {duration(now - start)}, {left} left  {tasks[k].name}: {said}")
        except KeyboardInterrupt:
            tell("interrupted: what is done stays, the same command goes on from there")
            raise SystemExit(INTERRUPTED) from None
    return [done[k].result() for k in range(len(tasks))]
