"""What was found of a family as data: verification/stability/records/FAMILY.json, written by ci/atlas --accept, read by page and tests."""
from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

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
        if self.predicted is None or self.measured is None:
            return None
        return self.measured / self.predicted - 1.0


@dataclass(frozen=True)
class Record:
    """All that was found of a family, by which version of strata."""

    family: str
    version: str
    points: tuple[PointFound, ...]
    edge: EdgeFound | None = None

    def point(self, label: str) -> PointFound | None:
        """The point of a label."""
        return next((point for point in self.points if point.label == label), None)


def file_of(family: str, folder: Path = RECORDS) -> Path:
    """Where a family's record is."""
    return folder / f"{family}.json"


def read(family: str, folder: Path = RECORDS) -> Record | None:
    """A family's record; None where there is none. Raises ValueError for a file that cannot be understood."""
    path = file_of(family, folder)
    if not path.is_file():
        return None
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        edge = EdgeFound(**content["edge"]) if content["edge"] is not None else None
        return Record(content["family"], content["version"], tuple(_point(item) for item in content["points"]), edge)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: {type(error).__name__}: {error}") from error


def _point(item: dict[str, Any]) -> PointFound:
    """A point from plain data; what is not finite was written as null."""
    checked = item["checked"]
    if checked is not None:
        numbers = {name: float("nan") if checked[name] is None else checked[name] for name in ("value", "reference", "error")}
        checked = Checked(**{**checked, **numbers})
    return PointFound(**{**item, "checked": checked})


def _plain(point: PointFound) -> dict[str, Any]:
    """A point as plain data: numbers to seven digits, those that are not finite as null."""
    plain = asdict(point)
    if point.checked is not None:
        plain["checked"] = {name: _number(item) if isinstance(item, float) else item for name, item in plain["checked"].items()}
    return plain


def _number(value: float) -> float | None:
    """A number to seven digits; None for one that is not finite."""
    return float(f"{value:.7g}") if abs(value) < float("inf") else None


def write(record: Record, folder: Path = RECORDS) -> Path:
    """Write a family's record, a point a line."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ",\n".join("  " + json.dumps(_plain(point)) for point in record.points)
    edge = json.dumps(asdict(record.edge) if record.edge is not None else None)
    path = file_of(record.family, folder)
    head = f'{{\n "family": {json.dumps(record.family)},\n "version": {json.dumps(record.version)},\n "edge": {edge},\n'
    new = path.with_suffix(".new")
    new.write_text(f'{head} "points": [\n{lines}\n ]\n}}\n', encoding="utf-8")
    new.replace(path)
    return path
