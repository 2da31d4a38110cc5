"""The tables as they are kept: a JSON file an experiment, in verification/ablation/records/."""
from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from verification.ablation.effects import Tried
from verification.harness.budget import Effect
from verification.harness.paths import ROOT

RECORDS = ROOT / "verification" / "ablation" / "records"


@dataclass(frozen=True)
class Table:
    """A variant with everything that was left out of it, its own values, and its CPU time, s."""

    experiment: str
    variant: str
    extent: str  # how much was tried: everything, own (what the scene has), interfaces
    version: str
    cpu_s: float
    quantities: tuple[tuple[str, str, str], ...]  # name, label, unit
    base: dict[str, float]
    lines: tuple[Tried, ...]


class BadRecord(Exception):
    """A kept table cannot be read; the message says which and why."""


def write(table: Table, folder: Path = RECORDS) -> Path:
    """Keep a table; the file of an experiment's variant."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{table.experiment}.{table.variant}.json"
    path.write_text(json.dumps(asdict(table), indent=1) + "\n", encoding="utf-8")
    return path


def read(path: Path) -> Table:
    """A kept table; raises BadRecord."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        lines = tuple(_line(line) for line in content.pop("lines"))
        quantities = tuple((name, label, unit) for name, label, unit in content.pop("quantities"))
        return Table(**content, quantities=quantities, lines=lines)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadRecord(f"{path}: {type(error).__name__}: {error}") from error


def _line(content: dict[str, Any]) -> Tried:
    """A line from its JSON."""
    effects = {name: Effect(**effect) for name, effect in content.pop("effects").items()}
    settings = tuple(content.pop("settings"))
    return Tried(**content, effects=effects, settings=settings)


def read_all(folder: Path = RECORDS) -> list[Table]:
    """All kept tables by their names; raises BadRecord."""
    return [read(path) for path in sorted(folder.glob("*.json"))]
