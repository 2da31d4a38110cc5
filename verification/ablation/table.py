"""What came of changing a scene, one thing at a time: a table a variant of an experiment, kept as a JSON file (of what is left out in
verification/ablation/records/); what follows for the scene; and why scenes keep what 1 % does not ask of them: experiments/choices/ablation.toml."""

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.ablation.changes import BESIDE, NUMERICAL
from verification.harness import store
from verification.harness.command import aligned
from verification.harness.paths import EXPERIMENTS, ROOT
from verification.harness.quantities import Effect

RECORDS = ROOT / "verification" / "ablation" / "records"
REASONS = EXPERIMENTS / "choices" / "ablation.toml"
Reasons = dict[str, dict[str, str]]  # by experiment ("all": every one) and ingredient

WANTED = 0.01  # the share that a scene is to be right to
NO_SAVING = 0.05  # CPU times of the same run differ by this share from one to the next; what saves less than that costs nothing

# Verdicts on an ingredient.
NEEDED, SPARED, CHANGES, NOTHING = "needed", "not needed", "needed: without it something else happens", "says nothing"


@dataclass(frozen=True)
class Tried:
    """A change that was tried: how that run ended, its effects (in units, and as shares), and its CPU time, s, where it was alone; of a factor, its group."""

    id: str
    label: str
    done: str
    settings: tuple[str, ...]
    status: str  # "completed", "failed", "refused"; "" where it does not apply
    reason: str
    effects: dict[str, Effect]
    shares: dict[str, float]
    cpu_s: float
    group: str = ""

    @property
    def applies(self) -> bool:
        """Whether the scene has it at all."""
        return bool(self.status)

    @property
    def largest(self) -> float | None:
        """The largest share, None where nothing could be compared."""
        return max(self.shares.values(), default=None)

    @property
    def lost(self) -> list[str]:
        """What of the base its run does not have."""
        return [name for name, effect in self.effects.items() if effect.value is None]

    @property
    def verdict(self) -> str:
        """What 1 % asks of the scene."""
        if self.status != "completed":
            return NOTHING
        if self.lost:
            return CHANGES
        return NOTHING if self.largest is None else NEEDED if self.largest >= WANTED else SPARED


@dataclass(frozen=True)
class Table:
    """A variant with everything that was changed about it, its own values, and its CPU time, s."""

    experiment: str
    variant: str
    extent: str  # how much was tried; "interfaces": these alone; of a budget its mechanics
    version: str
    cpu_s: float
    quantities: tuple[tuple[str, str, str], ...]  # name, label, unit
    base: dict[str, float]
    lines: tuple[Tried, ...]

    def spared(self, at_a_cost: bool) -> list[Tried]:
        """What 1 % does not ask for: what saves time where it is left out, which wants a reason, or what costs nothing."""
        return [one for one in self.lines if one.verdict == SPARED and (one.cpu_s < (1.0 - NO_SAVING) * self.cpu_s) == at_a_cost]

    def needs(self) -> list[Tried]:
        """What the scene needs for 1 %."""
        return [one for one in self.lines if one.verdict in (NEEDED, CHANGES)]

    def unexplained(self, why: Reasons) -> list[str]:
        """Ingredients that the scene has at a cost, and 1 % does not ask for, without a reason."""
        return [one.id for one in self.spared(True) if not reason_for(one, self.experiment, why)]

    def total(self, quantity: str, groups: Sequence[str]) -> tuple[float, float, list[str]]:
        """Factors of some groups together, each with the largest of its effects, whatever their signs: root of the sum of squares (they are
        independent), plain sum (all push one way), and those of which a run says nothing."""
        largest: dict[str, float] = {}
        out = []
        for one in (one for one in self.lines if one.group in groups):
            value = one.effects[quantity].value if quantity in one.effects else None
            if value is None:
                out.append(f"{one.label} ({one.done or one.reason})")
            else:
                largest[one.label] = max(abs(value), largest.get(one.label, 0.0))
        return math.hypot(*largest.values()), math.fsum(largest.values()), out


def amount(value: float, unit: str, sign: str = "") -> str:
    """A difference in kPa or its own unit."""
    return f"{value / 1e3:{sign}.2f}" if unit == "Pa" else f"{value:{sign}.3f}"


def effect_words(value: float | None, unit: str, base: float | None) -> str:
    """An effect with its share of the base, or a dash."""
    return "-" if value is None else amount(value, unit, "+") + (f" {100.0 * value / base:+.2f}%" if base else "")


def words(table: Table) -> str:
    """A table as text: effects and what follows, then of factors the totals."""
    units = [(name, unit) for name, _, unit in table.quantities]
    base = [(f"{value / 1e6:.5f} MPa" if unit == "Pa" else f"{value:.4g}") if (value := table.base.get(name)) is not None else "-" for name, unit in units]
    rows = [["", *(f"{label} ({'kPa' if unit == 'Pa' else unit})" for _, label, unit in table.quantities), "time", ""], ["as it is", *base, "", ""]]
    for one in table.lines:
        effects = [effect_words(one.effects[name].value if name in one.effects else None, unit, table.base.get(name)) for name, unit in units]
        lost = "; ".join(dict.fromkeys(effect.note for effect in one.effects.values() if effect.value is None))
        ended = lost if one.status == "completed" else f"{one.status}: {one.reason[:150]}"
        verdict = "" if one.group else one.verdict
        said = [*effects, f"{one.cpu_s / table.cpu_s:.2f}" if one.cpu_s else "", "; ".join(filter(None, (verdict, ended)))]
        rows.append([f"{one.label}: {one.done}", *said] if one.applies else [f"{one.label}: {one.reason}", *[""] * (len(units) + 2)])
    groups = {one.group for one in table.lines} - {"", BESIDE}
    for own, what in (({NUMERICAL}, "numerical factors"), (groups, "all factors")) if groups else ():
        totals = [(table.total(name, own), unit) for name, unit in units]
        rows.append([f"{what}, root of squares", *(amount(rss, unit) for (rss, _, _), unit in totals), "", ""])
        rows.append([f"{what}, plain sum", *(amount(plain, unit) for (_, plain, _), unit in totals), "", ""])
    return "\n".join([f"\n{table.experiment} {table.variant} ({table.extent})", *(f"  {line}" for line in aligned(rows, range(1, len(units) + 2)))])


def write(table: Table, folder: Path = RECORDS) -> Path:
    """Keep a table, a change a line; the file of an experiment's variant."""
    return store.write(table, folder / f"{table.experiment}.{table.variant}.json", ("lines",))


def read_all(folder: Path = RECORDS) -> list[Table]:
    """All kept tables by their names; raises ValueError for a file that is none."""
    return [found for path in sorted(folder.glob("*.json")) if (found := store.read(Table, path)) is not None]


def reasons(path: Path = REASONS) -> Reasons:
    """All reasons that are given."""
    return tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def reason_for(line: Tried, experiment: str, why: Reasons) -> str:
    """Why an experiment keeps an ingredient; empty where nothing is said."""
    name = "interface" if line.id.startswith("interface") else line.id
    return why.get(experiment, {}).get(name) or why.get("all", {}).get(name, "")


def named(lines: Sequence[Tried]) -> str:
    """Labels one after the other."""
    return ", ".join(line.label for line in lines)
