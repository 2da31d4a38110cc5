"""Makes the runs of cases, several at a time, each in RUNS/FAMILY/CASE/LEVEL; what was run before is not run again."""
from __future__ import annotations

import fcntl
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from verification.harness.paths import ROOT
from verification.harness.run import Job, Outcome, load_outcome, run
from verification.ladder.case import Case, Level
from verification.ladder.catalogue import Families, folder_name

RUNS = ROOT / "runs" / "ladder"
MECHANICS_KEY = "numerics.mechanics"


@dataclass(frozen=True)
class Rung:
    """A level of a case of a family, and where its run is."""

    family: str
    case: Case
    level: Level
    folder: Path

    @property
    def name(self) -> str:
        """Family, case and level."""
        return f"{self.family}/{self.case.name} {self.level.label}"

    def job(self) -> Job:
        """The run to make; the case's mechanics are set unless the level sets them itself."""
        settings = self.level.settings
        if not any(setting.startswith(f"{MECHANICS_KEY}=") for setting in settings):
            settings = (f"{MECHANICS_KEY}={self.case.mechanics}", *settings)
        return Job(self.case.scene, self.level.variant, self.folder, settings, self.case.threads)


@dataclass(frozen=True)
class Made:
    """A rung with how its run ended."""

    rung: Rung
    outcome: Outcome


def rungs_of(chosen: Families, smoke: bool = False, runs: Path = RUNS) -> list[Rung]:
    """All rungs of the chosen cases (of each case its smoke levels alone if asked), coarse to fine."""
    return [
        Rung(family, case, level, runs / family / case.name / folder_name(level.label))
        for family, members in chosen.items()
        for case in members
        for level in case.levels[: case.smoke if smoke else None]
    ]


class Slots:
    """So many threads of the machine, given out to runs; a run that wants more than there are gets all of them."""

    def __init__(self, count: int) -> None:
        self._count = self._free = count
        self._changed = threading.Condition()

    @contextmanager
    def taken(self, wanted: int) -> Iterator[None]:
        """Hold so many slots while the block runs."""
        share = min(wanted, self._count)
        with self._changed:
            self._changed.wait_for(lambda: self._free >= share)
            self._free -= share
        try:
            yield
        finally:
            with self._changed:
                self._free += share
                self._changed.notify_all()


def make_one(rung: Rung, binary: Path | None = None) -> Made:
    """Make one run unless it is there; another process that wants the same one waits for it."""
    rung.folder.parent.mkdir(parents=True, exist_ok=True)
    with (rung.folder.parent / f"{rung.folder.name}.lock").open("w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        return Made(rung, run(rung.job(), binary))


def make_all(
    rungs: list[Rung], jobs: int = 2, binary: Path | None = None, tell: Callable[[str], None] = lambda line: None
) -> list[Made]:
    """Make the runs of all rungs on `jobs` threads, those that took longest last time first; in the order given."""
    slots, done = Slots(jobs), []

    def one(rung: Rung) -> Made:
        with slots.taken(rung.case.threads):
            made = make_one(rung, binary)
        done.append(made)
        how = "done before" if made.outcome.skipped else f"{made.outcome.wall_s:.1f} s"
        what = how if made.outcome.ok else f"FAILED: {made.outcome.reason}"
        tell(f"[{len(done):3d}/{len(rungs)}] {rung.name}: {what}")
        return made

    order = sorted(range(len(rungs)), key=lambda k: expected_s(rungs[k]), reverse=True)
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        pending = {k: pool.submit(one, rungs[k]) for k in order}
        return [pending[k].result() for k in range(len(rungs))]


def expected_s(rung: Rung) -> float:
    """How long a run took last time, s; without a last time infinitely long for the finest level, less for coarser ones."""
    before = load_outcome(rung.folder)
    if before is not None:
        return before.wall_s
    return 1e6 / (len(rung.case.levels) - rung.case.levels.index(rung.level))
