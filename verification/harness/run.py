"""Runs one variant of a scene into a folder, unless that folder already holds the same run by the same solver."""

import fcntl
import hashlib
import json
import os
import resource
import shutil
import signal
import subprocess
import threading
import time
import tomllib
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.harness.paths import solver

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
