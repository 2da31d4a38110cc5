"""The tables as they are kept: a JSON file a variant of an experiment, in verification/ablation/records/."""

from dataclasses import dataclass
from pathlib import Path

from verification.ablation.effects import Tried
from verification.harness import store
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


def write(table: Table, folder: Path = RECORDS) -> Path:
    """Keep a table; the file of an experiment's variant."""
    return store.write(table, folder / f"{table.experiment}.{table.variant}.json")


def read(path: Path) -> Table:
    """A kept table; raises ValueError for a file that is none."""
    found = store.read(Table, path)
    if found is None:
        raise ValueError(f"there is no {path}")
    return found


def read_all(folder: Path = RECORDS) -> list[Table]:
    """All kept tables by their names; raises ValueError."""
    return [read(path) for path in sorted(folder.glob("*.json"))]
