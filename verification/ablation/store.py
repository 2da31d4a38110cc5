"""The tables as they are kept, a JSON file a variant of an experiment in verification/ablation/records/, and why scenes keep what 1 % does not
ask of them, or go without what it does: experiments/choices/ablation.toml."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from verification.ablation.effects import Tried, missing, not_needed
from verification.harness import store
from verification.harness.paths import EXPERIMENTS, ROOT

RECORDS = ROOT / "verification" / "ablation" / "records"
REASONS = EXPERIMENTS / "choices" / "ablation.toml"
Reasons = dict[str, dict[str, str]]  # by experiment ("all": every one) and ingredient


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


def reasons(path: Path = REASONS) -> Reasons:
    """All reasons that are given."""
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def reason_for(line: Tried, experiment: str, why: Reasons) -> str:
    """Why an experiment keeps an ingredient, or goes without it; empty where nothing is said."""
    name = "interface" if line.id.startswith("interface") else line.id
    return why.get(experiment, {}).get(name) or why.get("all", {}).get(name, "")


def unexplained(one: Table, why: Reasons) -> list[str]:
    """Ingredients of a table that the scene has at a cost and 1 % does not ask for, or lacks although it does, without a reason."""
    asked = [*not_needed(one.lines, one.cpu_s), *missing(one.lines)]
    return [line.id for line in asked if not reason_for(line, one.experiment, why)]
