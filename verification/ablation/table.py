"""What comes of changing a scene, one thing at a time: it is run as it is and with each change alone, and what each moves is a table a variant of an
experiment, kept as a JSON file (of what is left out in verification/ablation/records/); what follows for the scene; and why scenes keep what 1 % does not
ask of them: experiments/choices/ablation.toml.

A pressure counts by its net part, P less the stress that closes the fracture: a background can be added to both at will. A height counts
by the base's own, a path by its length. A change whose run has no value where the base has one changes what happens.
"""

import math
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification.ablation.changes import BESIDE, NUMERICAL, Change
from verification.harness import quantities as harness, store
from verification.harness.command import aligned
from verification.harness.load import Run
from verification.harness.observables import path_length
from verification.harness.paths import EXPERIMENTS, ROOT
from verification.harness.quantities import NO_ARREST, Effect, Quantity, followed, turns
from verification.harness.refine import job_of
from verification.harness.run import Job, Made

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


Effects = tuple[dict[str, Effect], dict[str, float]]  # in their units, and as shares
Maker = Callable[[Sequence[Job]], list[Made]]


class NoBase(Exception):
    """The scene's own run has no result; the message says why."""


def scale_of(quantity: Quantity, base: Run) -> float:
    """What a quantity's effect is a share of, in its unit; raises ValueError where it is nothing."""
    value = quantity.measure(base).low
    closing = float(base.scene.get("in_situ", {}).get("horizontal_Pa", 0.0)) if quantity.unit == "Pa" else 0.0
    if not abs(value - closing) > 0.0:
        raise ValueError(f"{quantity.name} of {base.name} is {value}: nothing to be a share of")
    return abs(value - closing)


def effects_of(quantities: Sequence[Quantity], with_path: bool, base: Run, run: Run, pauses: bool = False, short: str = "") -> Effects:
    """Effects of a run, as it is read, against the base, and the same as shares where they are known; raises ValueError for one that is no number.

    An arrest of the base that is none in the run is lost, since what is at the place is no pause; `pauses`: the pause there counts.
    """
    found = {name: Effect(None, NO_ARREST) if NO_ARREST in effect.note and not pauses else effect
             for name, effect in harness.effects_of(quantities, with_path, base, run, short).items()}  # fmt: skip
    scales = {one.name: (lambda one=one: scale_of(one, base)) for one in quantities} | {"path_m": lambda: path_length(base.path)}
    shares = {name: abs(effect.value) / scales[name]() for name, effect in found.items() if effect.value is not None}
    if not all(map(math.isfinite, shares.values())):
        raise ValueError(f"{run.name}: shares {shares} are not finite")
    return found, shares


def left_out(scene: Path, variant: str, settings: Sequence[str], changes: Sequence[Change], root: Path) -> tuple[Job, list[Job]]:
    """The runs of a scene as it is and of the changes that apply."""

    def job(name: str, further: Sequence[str] = ()) -> Job:
        return Job(scene, variant, root / scene.stem / (variant or "base") / name, (*settings, *further))

    return job("base"), [job(one.id, one.settings) for one in changes if one.settings]


def varied(
    scene: Path, mechanics: str, variant: str, settings: Sequence[str], content: dict[str, Any], changes: Sequence[Change], root: Path
) -> tuple[Job, list[Job]]:
    """The runs of a budget: base and half the cells are the refinement study's, others the base's settings with their own in place."""
    cell = float(content["numerics"]["cell_m"])
    others = [setting for setting in settings if setting.partition("=")[0] != "numerics.cell_m"]
    base, half = (job_of(scene, mechanics, variant, size, others) for size in (cell, cell / 2.0))

    def job(one: Change) -> Job:
        pairs = dict(setting.partition("=")[::2] for setting in (*base.settings, *one.settings))
        return Job(scene, variant, root / scene.stem / mechanics / variant / one.id, tuple(f"{key}={value}" for key, value in pairs.items()))

    return base, [half if one.id == "mesh_half" else job(one) for one in changes if one.settings]


def table_of(content: dict[str, Any], extent: str, changes: Sequence[Change], base: Job, jobs: Sequence[Job], made_by: Maker) -> Table:
    """The table of a scene (its keys with a variant's in place) from the runs of it as it is and of the changes that apply. Raises NoBase where the
    scene's own run fails."""
    [(outcome, own)] = made_by([base])
    if own is None or not outcome.ok:
        raise NoBase(f"{base.scene.stem} {base.variant}: {outcome.word}: {outcome.reason}")
    made = iter(made_by(jobs))
    quantities, with_path = followed(content, own), turns(content)

    def tried(one: Change) -> Tried:
        """A change, with its run where it has one."""
        if not one.settings:
            return Tried(one.id, one.label, one.done, one.settings, "", one.why_not, {}, {}, 0.0, one.group)
        ended, run = next(made)
        short = "up to where the run failed" if one.group and not ended.ok else ""
        # Where the path may turn only the ways of both are compared, a straight one too.
        found = ({}, {}) if run is None else effects_of(quantities, with_path, own, one.view.of(run, own), bool(one.group), short)
        return Tried(one.id, one.label, one.done, one.settings, ended.word, ended.reason, *found, 0.0 if one.group else ended.cpu_s, one.group)

    names = [(one.name, one.label, one.unit) for one in quantities] + [("path_m", "path", "m")] * with_path
    values = {one.name: one.measure(own).low for one in quantities}
    return Table(base.scene.stem, base.variant, extent, own.summary.version, outcome.cpu_s, tuple(names), values, tuple(map(tried, changes)))
