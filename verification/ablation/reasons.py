"""Why scenes keep what 1 % does not ask of them, or go without what it does: experiments/choices/ablation.toml."""

import tomllib
from pathlib import Path

from verification.ablation.effects import Tried, missing, not_needed
from verification.ablation.store import Table
from verification.harness.paths import EXPERIMENTS

REASONS = EXPERIMENTS / "choices" / "ablation.toml"

Reasons = dict[str, dict[str, str]]  # by experiment ("all": every one) and ingredient


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
