"""The runner: a variant of a scene into a folder, unless that holds the same run by the same solver already; many side by side, those that take longest
first, with what they will cost and whether that may be spent; one that breaks does not stop the others."""

import argparse
import fcntl
import hashlib
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import tomllib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Generic, TypeVar

from verification.harness import store
from verification.harness.load import LoadError, Run, load
from verification.harness.paths import solver
from verification.harness.scenes import content_of

OUTCOME = "outcome.json"

# What the solver's exit status means (0 done, 3 numerics failed); only these two are the solver's word on the scene.
BAD_INPUT, INTERRUPTED = 2, 130
MEANING = {0: "completed", 1: "a bug in the solver", BAD_INPUT: "bad input", 3: "numerics failed", INTERRUPTED: "interrupted"}
FINAL = (0, 3)
CUT_SHORT = (INTERRUPTED, -signal.SIGKILL, -signal.SIGTERM)  # such a run goes on from its checkpoint
TOO_LONG = 124  # a run that was killed since it took longer than was asked for

# How often a run that may be interrupted is looked at, and how long it then has to write its checkpoint, s.
LOOK_S, GRACE_S = 0.1, 30.0


@dataclass(frozen=True)
class Job:
    """One run: a scene, its variant (empty: the base scene), further settings, where to put it and on how many threads."""

    scene: Path
    variant: str
    out: Path
    settings: tuple[str, ...] = ()
    threads: int = 1


@dataclass(frozen=True)
class Outcome:
    """How a run ended, with its wall time and, where no other was made at the same time, its CPU time, s. It is kept in the run's folder as outcome.json."""

    scene: str
    variant: str
    status: str
    exit_status: int
    reason: str
    wall_s: float
    key: str
    settings: tuple[str, ...] = ()
    skipped: bool = False
    cpu_s: float = 0.0

    @property
    def ok(self) -> bool:
        """Whether the run came to its end."""
        return self.status == "completed"

    @property
    def word(self) -> str:
        """How it ended: "completed", "failed", "refused" for bad input, or "too long"."""
        return {BAD_INPUT: "refused", TOO_LONG: "too long"}.get(self.exit_status, self.status)


@lru_cache(maxsize=None)
def _digest(binary: Path, _: tuple[int, int]) -> bytes:
    """The hash of a file; the second argument is its time of change and size."""
    return hashlib.sha256(binary.read_bytes()).digest()


def key_of(job: Job, binary: Path) -> str:
    """A hash of what decides on a run: solver, settings, and the scene but for its title, claims, sweep and other variants. Threads do not."""
    scene = tomllib.loads(job.scene.read_text(encoding="utf-8"))
    content = {key: value for key, value in scene.items() if key not in ("claim", "sweep", "title", "variants")}
    if job.variant:
        content["variant"] = scene.get("variants", {}).get(job.variant, f"no variant {job.variant}")
    digest = hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode())
    digest.update(json.dumps([job.variant, list(job.settings)]).encode())
    now = binary.stat()
    digest.update(_digest(binary, (now.st_mtime_ns, now.st_size)))
    return digest.hexdigest()


def command_of(job: Job, binary: Path) -> list[str]:
    """The command line of a job."""
    words = [str(binary), "run", str(job.scene), "--out", str(job.out), "--threads", str(job.threads), "--quiet"]
    words += ["--variant", job.variant] if job.variant else []
    return words + [word for setting in job.settings for word in ("--set", setting)]


def load_outcome(folder: Path) -> Outcome | None:
    """The outcome kept in a run's folder, or None where there is none that can be read."""
    try:
        return store.read(Outcome, folder / OUTCOME)
    except ValueError:
        return None


def done_before(job: Job, binary: Path | None = None) -> Outcome | None:
    """The outcome of the same run made before, if it was final and its summary is there."""
    before = load_outcome(job.out)
    if before is None or before.exit_status not in FINAL or not (job.out / "summary.json").is_file():
        return None
    return before if before.key == key_of(job, binary or solver()) else None


def clear(folder: Path) -> None:
    """Empty a run's folder; refuses a folder that holds something else than a run."""
    names = {item.name for item in folder.iterdir()} if folder.is_dir() else set()
    if names and not names & {OUTCOME, "scene.toml", "summary.json", "log.txt"}:
        raise FileExistsError(f"{folder} holds files but no run; name another folder")
    if folder.is_dir():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)


@contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Holds a run's folder for this process; another one that wants it waits."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with (folder.parent / f"{folder.name}.lock").open("w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def wait_for_solver(folder: Path) -> None:
    """Wait until no solver writes to a folder: one outlives a driver that was killed, and holds the folder's lock."""
    with suppress(FileNotFoundError):
        held = os.open(folder, os.O_RDONLY)
        try:
            fcntl.flock(held, fcntl.LOCK_EX)
        finally:
            os.close(held)


def summary_in(folder: Path) -> dict[str, Any]:
    """What a run's summary says; nothing where there is none that can be read."""
    with suppress(OSError, ValueError):
        return dict(json.loads((folder / "summary.json").read_text(encoding="utf-8")))
    return {}


def reason_of(folder: Path, exit_status: int, log: str) -> str:
    """Why a run failed: its summary's reason, or the end of what it said."""
    if reason := summary_in(folder).get("reason"):
        return str(reason)
    meaning = MEANING.get(exit_status, f"killed by signal {-exit_status}" if exit_status < 0 else "unknown exit status")
    return " / ".join(log.strip().splitlines()[-3:]) or meaning


def ended(words: list[str], limit_s: float | None, stop: threading.Event | None = None) -> tuple[int, str]:
    """Exit status and what was said; a command that takes longer than the limit is killed (TOO_LONG, with that as its word). Once `stop` is set it is
    interrupted as by Ctrl-C, and killed where that does not end it."""
    begun, asked = time.monotonic(), False
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        while True:
            try:
                said, _ = process.communicate(timeout=limit_s if stop is None else LOOK_S)
                return process.returncode, said
            except subprocess.TimeoutExpired:
                spent = time.monotonic() - begun
            if limit_s is not None and spent >= limit_s:
                process.kill()
                process.communicate()
                return TOO_LONG, f"not done after {limit_s:g} s"
            if stop is not None and stop.is_set() and not asked:
                process.send_signal(signal.SIGINT)
                limit_s, asked = spent + GRACE_S, True


Timed = tuple[float, float]  # wall and CPU time, s


def timed(action: Callable[[], Any]) -> tuple[Any, Timed]:
    """What an action gives, with the wall and CPU time of the processes that were waited for meanwhile, s."""

    def cpu_s() -> float:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    cpu, wall = cpu_s(), time.perf_counter()
    made = action()
    return made, (time.perf_counter() - wall, cpu_s() - cpu)


def run(job: Job, binary: Path | None = None, force: bool = False, limit_s: float | None = None, stop: threading.Event | None = None) -> Outcome:
    """Run a job unless its folder has it already; the outcome says how it ended and never raises for a failed run. A run that takes longer than
    limit_s is killed: it failed, with exit status TOO_LONG. One that `stop` interrupts, or that is killed, by itself or with what runs it, goes on
    where it was the next time."""
    binary = binary or solver()
    done, before = (None, None) if force else (done_before(job, binary), load_outcome(job.out))
    if done is not None:
        return replace(done, skipped=True)
    wait_for_solver(job.out)
    start, key, spent_s = time.monotonic(), key_of(job, binary), 0.0
    if before is not None and before.key == key and before.exit_status in CUT_SHORT and (job.out / "scene.toml").is_file():
        words = [str(binary), "resume", str(job.out), "--threads", str(job.threads), "--quiet"]
        start, spent_s = start - before.wall_s, before.cpu_s
    else:
        clear(job.out)
        words = command_of(job, binary)
        store.write(Outcome(job.scene.stem, job.variant, "failed", INTERRUPTED, "killed with what ran it", 0.0, key, job.settings), job.out / OUTCOME)
    (exit_status, said), (_, cpu_s) = timed(lambda: ended(words, limit_s, stop))
    wall_s = round(time.monotonic() - start, 6)
    (job.out / "log.txt").write_text(said, encoding="utf-8")
    ending = summary_in(job.out).get("status")
    if exit_status == 0 and ending == "failed":  # it had ended so before, and was resumed since what ran it was killed just then
        exit_status = 3
    complete = exit_status == 0 and ending is not None
    status, reason = ("completed", "") if complete else ("failed", reason_of(job.out, exit_status, said))
    outcome = Outcome(job.scene.stem, job.variant, status, exit_status, reason, wall_s, key, job.settings, cpu_s=round(cpu_s + spent_s, 6))
    store.write(outcome, job.out / OUTCOME)
    return outcome


T = TypeVar("T")
Tell = Callable[[str], None]

# Where nothing ends for so long, what is at work is told, s.
SILENCE_S = 60.0


@dataclass(frozen=True)
class Task(Generic[T]):
    """Something to do: its name, what does it, what to say of what it made, how long it may take (s), how many threads it wants. What does it is
    given an event, and is to end soon once that is set. Times count against each other: 1 for all where none is known."""

    name: str
    make: Callable[[threading.Event], T]
    words: Callable[[T], str]
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


def side_by_side(tasks: Sequence[Task[T]], jobs: int, tell: Tell = say) -> list[T]:
    """What the tasks made, in their order, done on `jobs` threads; a task that wants more threads than that gets all of them. An exception of a task
    is raised when all others are done. An interrupt ends those at work, leaves the rest and is a SystemExit."""
    queue = sorted(range(len(tasks)), key=lambda k: tasks[k].expected_s, reverse=True)
    at_work: dict[Future[T], int] = {}
    done: dict[int, Future[T]] = {}
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


# By experience: a run of a block of 80 m with cells of 1 m takes 10 to 80 s with inertia, where steps shorten with the cells, and 1 to 7 s
# without. Seconds a point of a uniform grid, with inertia those of cells of 1 m.
SECONDS_A_POINT = {"explicit": 3.0e-3, "quasistatic": 2.6e-4}

Made = tuple[Outcome, Run | None]  # how a run ended, and its data where it has any, as every completed one has


def about_s(content: dict[str, Any]) -> float:
    """How long a scene (its keys as they will be used) takes on one thread, s, by the points of a uniform grid and their steps."""
    numerics, domain = content["numerics"], content["domain"]
    cell, mechanics = float(numerics["cell_m"]), str(numerics["mechanics"])
    points = float(domain["width_m"]) * float(domain["height_m"]) / cell**2 * float(numerics["particles_per_cell"])
    return SECONDS_A_POINT[mechanics] * points / (cell if mechanics == "explicit" else 1.0)


def expected_s(job: Job) -> float:
    """How long a job will take on one thread, s: as long as the last time, or by what its scene says; nothing where that is refused."""
    before = load_outcome(job.out)
    if before is not None and before.ok:
        return before.wall_s
    try:
        return about_s(content_of(job.scene, job.variant, job.settings))
    except ValueError:
        return 0.0


def name_of(job: Job) -> str:
    """A job by the last three folders of its place."""
    return str(job.out.relative_to(job.out.parents[2]))


def affordable(jobs: Sequence[Job], options: argparse.Namespace) -> bool:
    """Print what the jobs that are still to be made will cost; whether they may be made, by options.limit (minutes) or options.yes."""
    costs = {job: expected_s(job) for job in jobs if done_before(job) is None}
    minutes = sum(costs.values()) / 60.0 / max(options.jobs, 1)
    if costs:
        print(f"{len(costs)} of {len(jobs)} runs to make, by estimate:", *(f"  {name_of(job)}: {seconds:.0f} s" for job, seconds in costs.items()), sep="\n")
        print(f"  together about {minutes:.1f} min with {options.jobs} at a time", flush=True)
    if minutes <= options.limit or options.yes:
        return True
    print(f"above the limit of {options.limit:g} min: give --yes, a larger --limit, fewer variants or coarser cells", file=sys.stderr)
    return False


def make(job: Job, stop: threading.Event | None = None, force: bool = False, limit_s: float | None = None) -> Made:
    """Run a job (see run) and read what it wrote: one that failed as far as it came, one that was refused not at all. A completed one that cannot be
    read has failed; a folder that cannot be used fails its run alone."""
    try:
        outcome = run(job, force=force, limit_s=limit_s, stop=stop)
        return outcome, None if outcome.exit_status == BAD_INPUT else load(job.out)
    except LoadError as error:
        return replace(outcome, status="failed", reason=f"completed, but it cannot be read: {error}") if outcome.ok else outcome, None
    except OSError as error:
        return Outcome(job.scene.stem, job.variant, "failed", BAD_INPUT, str(error), 0.0, ""), None


def made_words(made: Made) -> str:
    """How a run ended, in words."""
    outcome = made[0]
    how = "done before" if outcome.skipped else f"{outcome.wall_s:.0f} s"
    return f"{outcome.status} ({how}) {outcome.reason[:160]}".rstrip()


def make_all(jobs: Sequence[Job], at_a_time: int, words: Callable[[Made], str] = made_words, **how: Any) -> list[Made]:
    """Make all jobs on so many threads, with a line for each; `how` as make has it."""
    return side_by_side([Task(name_of(job), partial(make, job, **how), words, expected_s(job), job.threads) for job in jobs], at_a_time)
