"""What was found of a family as data: verification/stability/records/FAMILY.json, written by ci/atlas --accept, read by page and tests."""

from dataclasses import dataclass, replace
from pathlib import Path

from verification.harness import store
from verification.stability.family import Checked

RECORDS = Path(__file__).resolve().parent / "records"


@dataclass(frozen=True)
class PointFound:
    """How a point ended: outcome, what the check found of a completed run, why (of one that is not stable), and its CPU time (s)."""

    label: str
    value: float
    outcome: str
    checked: Checked | None = None
    reason: str = ""
    cpu_s: float = 0.0


@dataclass(frozen=True)
class EdgeFound:
    """The edge of a family: as predicted, as measured, and the last sound and first unsound value that were tried."""

    predicted: float | None
    measured: float | None
    sound: float | None = None
    unsound: float | None = None

    @property
    def difference(self) -> float | None:
        """Measured edge over predicted one less 1; None where one of them is not known."""
        return None if self.predicted is None or self.measured is None else self.measured / self.predicted - 1.0


@dataclass(frozen=True)
class Record:
    """All that was found of a family, by which version of strata."""

    family: str
    version: str
    edge: EdgeFound | None
    points: tuple[PointFound, ...]

    def point(self, label: str) -> PointFound | None:
        """The point of a label."""
        return next((point for point in self.points if point.label == label), None)


def read(family: str, folder: Path = RECORDS) -> Record | None:
    """A family's record; None where there is none. Raises ValueError for a file that cannot be understood."""
    return store.read(Record, folder / f"{family}.json")


def write(record: Record, folder: Path = RECORDS) -> Path:
    """Write a family's record, a point a line, what checks found to seven digits."""
    points = tuple(replace(point, checked=point.checked and point.checked.rounded()) for point in record.points)
    return store.write(replace(record, points=points), folder / f"{record.family}.json", ("edge", "points"))
