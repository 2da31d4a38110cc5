"""Makes the runs of cases, several at a time, each in RUNS/FAMILY/CASE/LEVEL; what was run before is not run again."""

import threading
from dataclasses import dataclass
from pathlib import Path

from verification.harness import paths
from verification.harness.choose import claimed, folder_name
from verification.harness.run import Job, Outcome, load_outcome, run
from verification.harness.side_by_side import Task, Tell, say, side_by_side
from verification.ladder.case import Case, Level
from verification.ladder.catalogue import Families

RUNS = paths.RUNS / "ladder"
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
        return Job(self.case.scene, self.level.variant, self.folder, settings)

    def expected_s(self) -> float:
        """How long the run may take, s: as the last time, or 0.1 s at the coarsest level and 8 times more at each (points and steps)."""
        before = load_outcome(self.folder)
        return before.wall_s if before is not None else 0.1 * 8.0 ** self.case.levels.index(self.level)


@dataclass(frozen=True)
class Made:
    """A rung with how its run ended."""

    rung: Rung
    outcome: Outcome

    def words(self) -> str:
        """How the run ended."""
        if not self.outcome.ok:
            return f"FAILED: {self.outcome.reason}"
        return "done before" if self.outcome.skipped else f"{self.outcome.wall_s:.1f} s"


def rungs_of(chosen: Families, smoke: bool = False, runs: Path = RUNS) -> list[Rung]:
    """All rungs of the chosen cases (of each case its smoke levels alone if asked), coarse to fine."""
    return [
        Rung(family, case, level, runs / family / case.name / folder_name(level.label))
        for family, members in chosen.items()
        for case in members
        for level in case.levels[: case.smoke if smoke else None]
    ]


def make_one(rung: Rung, stop: threading.Event | None = None) -> Made:
    """Make one run unless it is there; another process that wants the same one waits for it."""
    with claimed(rung.folder):
        return Made(rung, run(rung.job(), stop=stop))


def make_all(rungs: list[Rung], jobs: int = 2, tell: Tell = say) -> list[Made]:
    """Make the runs of all rungs on `jobs` threads, those that take longest first; in the order given."""
    tasks = [Task(rung.name, lambda stop, rung=rung: make_one(rung, stop), Made.words, rung.expected_s()) for rung in rungs]
    return side_by_side(tasks, jobs, tell)
